// scene_state.h: the application's view of the scene: a table for each kind of id, and the edits of
// the next commit. A commit sends only the latest state of an id, however often it changed. Used on
// the application's thread.
//
// A backend applies the edits of a commit in this order:
//   1. DeleteLight, DeleteInstance            only the scope of a light refers to them
//   2. Texture
//   3. ReloadShaders, ShaderClass, Shader, Parameter
//   4. Object                                 replaces it; its former children were deleted in 1
//   5. Instance                               new and changed ones, of the scene and of objects
//   6. Light, Camera, Environment, DefaultShader, Transport, FrameSettings
//   7. DeleteObject, DeleteShader, DeleteTexture
// An edit may refer to deleted ids. A deleted shader of a geometry is then the default shader, a
// deleted texture is texture 0, and a light whose scope is deleted lights nothing. A commit
// contains the arrays that it refers to for the first time. A backend keeps an array as long as one
// of its objects or textures refers to it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/errors.h"
#include "api/geometry/object_builder.h"
#include "openrt/openrts.h"
#include "scene/commit.h"
#include "scene/id_table.h"
#include "scene/matrix.h"
#include "scene/parameter_values.h"

namespace openrt {

struct ObjectState {
  std::vector<RTid> children;            // instances inside this object
  std::vector<RTid> users;               // instances of this object
  std::vector<BuiltGeometry> geometries; // kept until they are committed
  bool dynamic = false;
  bool dirty = false, committed = false;
};

struct InstanceState {
  RTid parent = 0, object = 0, shader = 0, fog = 0;
  uint32_t name = 0;
  Matrix4d matrix;
  bool visible = true, dynamic = false;
  uint64_t userData = 0;
  size_t childSlot = 0, userSlot = 0; // indices in the parent's children and the object's users
  bool inDefinition = false;          // the definition of its parent is still open
  bool dirty = false, committed = false;
};

struct ShaderClassState {
  const RtsClass* table = nullptr;
  std::string name, library;
  bool dirty = false, committed = false;
};

struct ShaderState {
  RTid shaderClass = 0;
  ParameterValues parameters; // set since the last commit
  // All numbers ever set: the initial values where geometry varies a parameter.
  ParameterValues values;
  bool dirty = false, committed = false;
};

struct TextureState {
  edit::TextureT description;
  ArrayPtr texels; // kept until they are committed
  bool dirty = false, committed = false;
};

struct LightState {
  RTid shader = 0, scope = 0;
  Matrix4d matrix;
  bool dirty = false, committed = false;
};

struct RoleState {
  RTid shader = 0;
  Matrix4d matrix;
  bool dirty = false;
};

// The entries of one kind by id, with the ids that changed and the committed ids that were deleted.
template <class State> struct Table {
  IdTable<State> entries;
  std::vector<RTid> dirty, deleted;

  State* find(RTid id) {
    const auto found = entries.find(id);
    return found == entries.end() ? nullptr : &found->second;
  }
  // Marks an entry for the next commit. If it throws, nothing is changed.
  void markDirty(RTid id, State& state) {
    if (state.dirty) return;
    dirty.push_back(id);
    state.dirty = true;
  }
  void erase(RTid id, const State& state) {
    if (state.committed) deleted.push_back(id);
    entries.erase(id);
  }
};

// The mesh that the tree of a deforming object is built of (api/geometry/deforming.h).
struct RestingMesh {
  ArrayPtr points, indices;
  ArrayId pointsId = 0, indicesId = 0;
};

class SceneState {
 public:
  SceneState();

  // Look-ups. They throw RT_INVALID_ID with a text that names the kind.
  ObjectState& object(RTid id);
  InstanceState& instance(RTid id);
  ShaderClassState& shaderClass(RTid id);
  ShaderState& shader(RTid id);
  TextureState& texture(RTid id);
  LightState& light(RTid id);
  const RtsClass& classOf(const ShaderState& shader) {
    return *shaderClass(shader.shaderClass).table;
  }
  // Throws RT_INVALID_OPERATION if the shader is of another kind. Accepts shader 0 (none).
  void requireKind(RTid shader, RtsKind kind);

  RTid newId();
  RTid newObject();
  RTid newInstance(const InstanceState& state);
  RTid newShaderClass(const RtsClass& table, std::string_view name, std::string_view library);
  RTid newShader(RTid shaderClass);
  RTid newTexture();
  RTid newLight(RTid shader, const Matrix4d& matrix);

  // Ends the definition of an object: replaces its geometry and its children.
  void defineObject(RTid id, std::vector<BuiltGeometry> geometries,
                    const std::vector<RTid>& children);
  // Returns the indices of the mesh that the tree of a deforming object is built of; null if the
  // object has no such tree.
  ArrayPtr restingIndices(RTid object) const;
  // Returns whether the object `inner` is, or contains, the object `outer`.
  bool contains(RTid inner, RTid outer);

  void deleteInstance(RTid id, std::vector<RTid>* openChildren);
  void deleteObject(RTid id, std::vector<RTid>* openChildren);
  void deleteShader(RTid id);
  void deleteTexture(RTid id);
  void deleteLight(RTid id);

  void setRole(RoleState& role, RTid shader, const Matrix4d& matrix) {
    role = {shader, matrix, true};
  }
  void setParameter(RTid shader, const ParameterValue& value);
  // Looks up every class again after libraries were reloaded. The next commit tells the backend.
  void shadersReloaded(const std::function<const RtsClass*(const std::string& name,
                                                           const std::string& library)>& find);

  // Returns all edits since the last commit and marks them as committed (commit.cpp).
  std::shared_ptr<const Commit> takeCommit(bool render);

  Table<ObjectState> objects;
  Table<InstanceState> instances;
  Table<ShaderClassState> classes;
  Table<ShaderState> shaders;
  Table<TextureState> textures;
  Table<LightState> lights;
  RoleState camera, environment, defaultShader, transport;
  edit::FrameSettingsT frame;
  bool frameDirty = false;
  uint32_t shaderGeneration = 0; // number of times that libraries were reloaded
  bool generationDirty = false;

 private:
  friend class CommitBuilder;
  std::unordered_map<RTid, RestingMesh> resting_; // by deforming object
  RTid nextId_ = 1;
  ArrayId nextArray_ = 1;
};

} // namespace openrt
