// validator.h: checks that a commit could have been made by the front end: the contract of
// scene_state.h and edits.fbs, edit by edit, against all commits before. Used between a recording
// and a backend, and in tests behind the front end. One thread.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "openrt/openrts.h"
#include "scene/commit.h"

namespace openrt {

class ShaderRegistry;

class CommitValidator {
 public:
  // shaders: finds shader classes; without it kinds and parameters are not checked.
  explicit CommitValidator(const ShaderRegistry* shaders) : shaders_(shaders) {}

  // Throws std::runtime_error at the first edit that breaks a rule. The validator must not be used
  // afterwards.
  void check(const Commit& commit);

 private:
  enum class Kind : uint8_t { Texture, ShaderClass, Shader, Object, Instance, Light };
  struct ObjectUse {
    uint64_t children = 0, users = 0;
  };
  struct Placement {
    uint32_t parent = 0, object = 0;
  };

  void checkEdit(const edit::AnyUnion& any, const Commit& commit);
  void defineId(uint32_t id, Kind kind);
  void deleteId(uint32_t id, Kind kind);
  void requireId(uint32_t id, Kind kind) const;
  void requireShader(uint32_t shader, RtsKind kind) const;

  void check(const edit::TextureT& texture, const Commit& commit);
  void check(const edit::ShaderClassT& shaderClass);
  void findClassesAgain();
  void check(const edit::ShaderT& shader);
  void check(const edit::ParameterT& parameter) const;
  void check(const edit::GeometryT& geometry, const Commit& commit) const;
  void checkParameters(const edit::GeometryT& geometry, const Commit& commit) const;
  void check(const edit::ObjectT& object, const Commit& commit);
  void check(const edit::InstanceT& instance);
  void check(const edit::LightT& light);
  void check(const edit::FrameSettingsT& frame);
  void deleteObject(uint32_t id);
  void deleteInstance(uint32_t id);
  void checkNesting() const;

  const ShaderRegistry* shaders_;
  std::unordered_map<uint32_t, Kind> liveIds_;
  std::unordered_set<uint32_t> deletedIds_; // deleted ids, which are never reused
  std::unordered_map<uint32_t, edit::TextureT> textures_;
  std::unordered_map<uint32_t, const RtsClass*> classes_; // null: unknown class
  std::unordered_map<uint32_t, edit::ShaderClassT> classNames_;
  std::unordered_map<uint32_t, uint32_t> shaderClasses_;
  std::unordered_map<uint32_t, ObjectUse> objects_;
  std::unordered_map<uint32_t, Placement> instances_;
  bool nestingChanged_ = false, hasFrame_ = false;
};

} // namespace openrt
