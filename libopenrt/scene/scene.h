// scene.h: the committed scene as tables by id: what commits (scene/commit.h) add up to. A backend
// owns one and applies commits between frames; the renderer reads it while nobody writes. Maps are
// ordered, so every walk has one order.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/commit.h"
#include "scene/matrix.h"

namespace openrt {

// Values of a shader parameter of a geometry's own, as many floats as its type has for every vertex
// or primitive.
struct GeometryParameter {
  uint32_t index = 0; // in the class's table
  bool perVertex = false;
  ArrayPtr values;
};

struct Geometry {
  edit::Primitive primitive = edit::Primitive::Triangles;
  uint32_t shader = 0, name = 0;
  Matrix4d matrix;
  bool cull = false, clockwise = false;
  float width = 1; // pixels; sphere: radius
  ArrayPtr points, indices, normals, texCoords, colors;
  std::vector<GeometryParameter> parameters;

  size_t primitives() const; // triangles, segments, points; 1 for a sphere
};

struct Object {
  uint64_t version = 0; // another number each time any object is defined
  bool dynamic = false;
  std::vector<Geometry> geometries;
};

struct Instance {
  uint32_t parent = 0, object = 0, shader = 0;
  Matrix4d matrix;
  bool visible = true;
  uint64_t userData = 0;
  uint32_t name = 0;
  bool dynamic = false;
};

struct Light {
  uint32_t shader = 0, scope = 0;
  Matrix4d matrix;
};

struct Role { // camera, environment
  uint32_t shader = 0;
  Matrix4d matrix;
};

struct ShaderValues {
  uint32_t shaderClass = 0;
  std::map<uint32_t, edit::ParameterT>
      parameters; // by index in the class's table; those that were set
};

struct TextureImage {
  edit::TextureT description;
  ArrayPtr texels;
};

struct ShaderClassName {
  std::string name, library;
};

// What a commit touched: decides what a backend makes anew.
struct SceneChanges {
  bool structure = false; // instances made, deleted, or changed in more than their place; objects
                          // made or deleted
  bool shaders = false;   // made, deleted, or another default; not their parameters
  bool textures = false, lights = false, camera = false, frame = false;
  std::vector<uint32_t> parameters; // shaders of which some were set
  std::vector<uint32_t>
      moved; // dynamic instances whose matrix or visibility changed, and nothing else
  std::vector<uint32_t>
      redefined; // dynamic objects that were defined before, without instances in them
  bool any() const {
    return structure || shaders || textures || lights || camera || frame || !parameters.empty() ||
           !moved.empty() || !redefined.empty();
  }
  void add(const SceneChanges& more);
};

class Scene {
 public:
  // Applies a commit; edits that name unknown ids are ignored (the front end and the reader of
  // recordings check them).
  SceneChanges apply(const Commit& commit);

  std::map<uint32_t, TextureImage> textures;
  std::map<uint32_t, ShaderClassName> classes;
  std::map<uint32_t, ShaderValues> shaders;
  std::map<uint32_t, Object> objects;
  std::map<uint32_t, Instance> instances;
  std::map<uint32_t, Light> lights;
  Role camera, environment;
  uint32_t defaultShader = 0, transport = 0;
  edit::FrameSettingsT frame;

  // The arrays that are alive, by the numbers that commits gave them.
  std::map<ArrayId, ArrayPtr> arrays() const;
  // Ids of the instances placed in an object (0: in the scene), in order.
  const std::vector<uint32_t>& childrenOf(uint32_t object) const;

 private:
  ArrayPtr array(ArrayId id) const;
  void applyEdit(const edit::AnyUnion& any, SceneChanges& changes);
  void replaceObject(const edit::ObjectT& object, SceneChanges& changes);
  void placeInstance(const edit::InstanceT& edit, SceneChanges& changes);
  void deleteInstance(uint32_t id);
  void deleteObject(uint32_t id);
  void dropChildren(uint32_t object);
  void sortChildren();
  std::map<ArrayId, std::weak_ptr<const Array>>
      arrays_;             // alive as long as something of the scene uses them
  size_t arraysSwept_ = 0; // how many there were after the last sweep
  uint64_t version_ = 0;
  std::map<ArrayId, ArrayPtr> arriving_; // of the commit being applied
  std::map<uint32_t, std::vector<uint32_t>> children_;
  std::vector<uint32_t> unsorted_; // objects whose lists of children are out of date
};

} // namespace openrt
