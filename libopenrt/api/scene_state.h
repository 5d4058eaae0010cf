// scene_state.h: what the application has said about the scene: tables by id, and the edits that
// the next commit carries. The latest state of an id is what a commit sends, however often it
// changed. Application thread.
//
// Order of the edits in a commit, made so that a backend applies them one after the other:
//   1. DeleteLight, DeleteInstance            nothing but a light's scope refers to them
//   2. Texture
//   3. ReloadShaders, ShaderClass, Shader, Parameter
//   4. Object                                 (replaces; its former children were deleted in 1)
//   5. Instance                               new and changed ones, of the scene and of objects
//   6. Light, Camera, Environment, DefaultShader, Transport, FrameSettings
//   7. DeleteObject, DeleteShader, DeleteTexture
// An edit may keep naming a deleted thing: a shader of geometry is then the default one, a texture
// is texture 0, a light whose scope is gone shines on nothing. A commit carries the arrays that it
// names for the first time; an array lives in a backend as long as an object or a texture there
// names it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/errors.h"
#include "api/geometry/object_builder.h"
#include "openrt/openrts.h"
#include "scene/commit.h"
#include "scene/matrix.h"

namespace openrt {

struct ObjectState {
  std::vector<RTid> children;            // instances placed in it
  std::vector<RTid> users;               // instances of it
  std::vector<BuiltGeometry> geometries; // until they are committed
  bool dynamic = false;
  bool dirty = false, committed = false;
};

struct InstanceState {
  RTid parent = 0, object = 0, shader = 0;
  uint32_t name = 0;
  Matrix4d matrix;
  bool visible = true, dynamic = false;
  uint64_t userData = 0;
  size_t childSlot = 0, userSlot = 0; // places in the parent's and the object's lists
  bool inDefinition = false;          // its parent's definition is still open
  bool dirty = false, committed = false;
};

struct ShaderClassState {
  const RtsClass* table = nullptr;
  std::string name, library;
  bool dirty = false, committed = false;
};

struct ShaderState {
  RTid shaderClass = 0;
  std::map<uint32_t, edit::ParameterT> parameters; // set since the last commit, by index
  std::map<uint32_t, std::vector<float>>
      values; // ever set, of numbers: geometry may have values of its own
  bool dirty = false, committed = false;
};

struct TextureState {
  edit::TextureT description;
  ArrayPtr texels; // until they are committed
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

// One kind of thing: a table by id, which of them changed, and which committed ones were deleted.
template <class State> struct Table {
  std::unordered_map<RTid, State> entries;
  std::vector<RTid> dirty, deleted;

  State* find(RTid id) {
    const auto found = entries.find(id);
    return found == entries.end() ? nullptr : &found->second;
  }
  // Marks for the next commit; what fails changes nothing.
  void touch(RTid id, State& state) {
    if (state.dirty) return;
    dirty.push_back(id);
    state.dirty = true;
  }
  void erase(RTid id, const State& state) {
    if (state.committed) deleted.push_back(id);
    entries.erase(id);
  }
};

class SceneState {
 public:
  SceneState();

  // Lookups: RT_INVALID_ID with a text that names the kind.
  ObjectState& object(RTid id);
  InstanceState& instance(RTid id);
  ShaderClassState& shaderClass(RTid id);
  ShaderState& shader(RTid id);
  TextureState& texture(RTid id);
  LightState& light(RTid id);
  const RtsClass& classOf(const ShaderState& shader) {
    return *shaderClass(shader.shaderClass).table;
  }
  // RT_INVALID_OPERATION if the shader is of another kind; 0 passes where none is allowed.
  void requireKind(RTid shader, RtsKind kind);

  RTid newId();
  RTid newObject();
  RTid newInstance(const InstanceState& state);
  RTid newShaderClass(const RtsClass& table, std::string_view name, std::string_view library);
  RTid newShader(RTid shaderClass);
  RTid newTexture();
  RTid newLight(RTid shader, const Matrix4d& matrix);

  // Ends the definition of an object: its geometry and children take the place of the former ones.
  void defineObject(RTid id, std::vector<BuiltGeometry> geometries,
                    const std::vector<RTid>& children);
  // Whether the object inner is, or contains, the object outer.
  bool contains(RTid inner, RTid outer);

  void deleteInstance(RTid id, std::vector<RTid>* openChildren);
  void deleteObject(RTid id, std::vector<RTid>* openChildren);
  void deleteShader(RTid id);
  void deleteTexture(RTid id);
  void deleteLight(RTid id);

  void setRole(RoleState& role, RTid shader, const Matrix4d& matrix) {
    role = {shader, matrix, true};
  }
  void setParameter(RTid shader, edit::ParameterT parameter);
  // Libraries were loaded anew: looks every class up again and tells the backends with the next
  // commit.
  void shadersReloaded(const std::function<const RtsClass*(const std::string& name,
                                                           const std::string& library)>& find);

  // All edits since the last one; they count as committed when it returns. (commit.cpp)
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
  uint32_t shaderGeneration = 0; // how often libraries were loaded anew
  bool generationDirty = false;

 private:
  friend class CommitMaker;
  RTid nextId_ = 1;
  ArrayId nextArray_ = 1;
};

} // namespace openrt
