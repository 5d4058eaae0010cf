// scene.h: the committed scene as tables by id, the sum of all commits (scene/commit.h). A backend
// owns one and applies commits between frames; the renderer reads it while no commit is applied.
// The tables are ordered, so every traversal has the same order.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/analytic.h"
#include "scene/commit.h"
#include "scene/id_table.h"
#include "scene/matrix.h"
#include "scene/parameter_values.h"
#include "scene/stipple.h"

namespace openrt {

class SceneHistory;

// A shader parameter with its own value for every vertex or primitive of a geometry. Each value has
// as many floats as its type.
struct GeometryParameter {
  uint32_t index = 0; // index in the class's table
  bool perVertex = false;
  ArrayPtr values;
};

struct Geometry {
  edit::Primitive primitive = edit::Primitive::Triangles;
  uint32_t shader = 0, name = 0;
  Matrix4d matrix;
  bool cull = false, clockwise = false;
  float width = 1; // pixels; radius of a sphere
  ArrayPtr points, indices, normals, texCoords, colors;
  std::vector<GeometryParameter> parameters;
  std::shared_ptr<const AnalyticSurface> surface; // null: no quadric or asphere
  // For a mesh that deforms: the points that its tree is built of, before it is refitted to
  // `points`. Null: `points`.
  ArrayPtr rest;
  edit::TexGen texGen = edit::TexGen::Off;
  ArrayPtr fogCoords;
  Stipple stipple; // dashes, where it is lines

  size_t primitives() const; // triangles, segments or points; 1 for spheres and analytic surfaces
};

// The geometries of an object that has been defined again or deleted. Records of it may still be
// in use, and point into these.
using FormerGeometries = std::shared_ptr<const std::vector<Geometry>>;

struct Object {
  uint64_t version = 0; // a new number whenever an object is defined
  bool dynamic = false;
  std::vector<Geometry> geometries;
};

// Returns the matrix of an edit; without one the identity.
Matrix4d toMatrix(const edit::Matrix* matrix);

// Returns whether primitives of this kind have a width in pixels.
inline bool isThin(edit::Primitive primitive) {
  return primitive == edit::Primitive::Lines || primitive == edit::Primitive::Points;
}

// Returns whether the geometry is dashed lines.
inline bool isStippled(const Geometry& g) {
  return g.primitive == edit::Primitive::Lines && g.stipple.pattern != Stipple::solid;
}

// A dynamic object that is one mesh with so many triangles or more has a tree of its own, which is
// refitted when the mesh deforms. isRefitted() tells whether an object is one.
inline constexpr size_t refittedTriangles = 50'000;
bool isRefitted(const Object& object);

struct Instance {
  uint32_t parent = 0, object = 0, shader = 0;
  Matrix4d matrix;
  bool visible = true;
  uint64_t userData = 0;
  uint32_t name = 0;
  bool dynamic = false;
  uint32_t fog = 0; // an environment shader; 0: the fog around the instance
};

struct Light {
  uint32_t shader = 0, scope = 0;
  Matrix4d matrix;
};

struct Role { // camera or environment
  uint32_t shader = 0;
  Matrix4d matrix;
};

struct ShaderValues {
  uint32_t shaderClass = 0;
  ParameterValues parameters; // those that were set
};

struct TextureImage {
  edit::TextureT description;
  ArrayPtr texels;
};

struct ShaderClassName {
  std::string name, library;
};

// The kinds of changes in a commit. They decide what a backend rebuilds.
struct SceneChanges {
  // Instances created, deleted or changed in more than their placement; objects created or deleted.
  bool structure = false;
  // Shaders were created or deleted, or the default changed; parameters do not count.
  bool shaders = false;
  bool textures = false, lights = false, camera = false, frame = false;
  std::vector<uint32_t> parameters; // shaders with changed parameters
  // Dynamic instances of which only the matrix or visibility changed.
  std::vector<uint32_t> moved;
  // Dynamic objects without child instances that were defined again.
  std::vector<uint32_t> redefined;
  bool any() const {
    return structure || shaders || textures || lights || camera || frame || !parameters.empty() ||
           !moved.empty() || !redefined.empty();
  }
  void add(const SceneChanges& more);
};

class Scene {
 public:
  // Applies a commit. Edits that name unknown ids are ignored; the front end and the reader of
  // recordings check them before. history: gets what the commit changes; may be null. former: gets
  // the geometries of objects that are defined again or deleted; may be null.
  SceneChanges apply(const Commit& commit, SceneHistory* history = nullptr,
                     std::vector<FormerGeometries>* former = nullptr);

  std::map<uint32_t, TextureImage> textures;
  std::map<uint32_t, ShaderClassName> classes;
  IdTable<ShaderValues> shaders;
  std::map<uint32_t, Object> objects;
  IdTable<Instance> instances;
  std::map<uint32_t, Light> lights;
  Role camera, environment;
  uint32_t defaultShader = 0, transport = 0;
  edit::FrameSettingsT frame;

  // Returns the arrays in use, by the numbers that commits gave them.
  std::map<ArrayId, ArrayPtr> arrays() const;
  // Returns the ids of the instances placed in an object (0: in the scene), in order.
  const std::vector<uint32_t>& childrenOf(uint32_t object) const;

 private:
  ArrayPtr array(ArrayId id) const;
  void noteArrays(const Commit& commit);
  void applyEdit(const edit::AnyUnion& any, SceneChanges& changes);
  void replaceObject(const edit::ObjectT& object, SceneChanges& changes);
  FormerGeometries takeGeometries(Object& object);
  void placeInstance(const edit::InstanceT& edit, SceneChanges& changes);
  void deleteInstance(uint32_t id);
  void deleteObject(uint32_t id);
  void dropChildren(uint32_t object);
  void sortChildren();
  void eraseInstance(uint32_t id);
  // By number, ascending. Weak: an array lives as long as the scene uses it.
  std::vector<std::pair<ArrayId, std::weak_ptr<const Array>>> arrays_;
  size_t arraysSwept_ = 0; // size of arrays_ after the last sweep
  uint64_t version_ = 0;
  const Commit* commit_ = nullptr;  // the commit being applied
  SceneHistory* history_ = nullptr; // set while a commit is applied that is to be watched
  std::vector<FormerGeometries>* former_ = nullptr; // set while a commit is applied
  std::map<uint32_t, std::vector<uint32_t>> children_;
  std::vector<uint32_t> unsorted_; // objects whose child lists are out of date
};

} // namespace openrt
