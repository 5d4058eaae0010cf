// validator.cpp: checks ids, references and roles of edits. validate_arrays.cpp checks the arrays.
#include "backend/record/validator.h"

#include <cmath>
#include <stdexcept>

#include "backend/record/validate_arrays.h"
#include "openrt/openrt.h"
#include "picture_size.h"
#include "scene/channels.h"
#include "scene/quality.h"
#include "shading/parameters.h"
#include "shading/registry.h"

namespace openrt {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }
void demand(bool condition, const char* what) {
  if (!condition) refuse(what);
}

void checkMatrix(const edit::Matrix* matrix) {
  demand(matrix != nullptr, "a matrix is missing");
  const auto& m = *matrix->m();
  for (int i = 0; i < 16; i++) demand(std::isfinite(m.Get(i)), "a matrix is not finite");
  demand(m.Get(3) == 0 && m.Get(7) == 0 && m.Get(11) == 0 && m.Get(15) == 1,
         "a matrix is not affine");
}

} // namespace

void CommitValidator::defineId(uint32_t id, Kind kind) {
  demand(id != 0, "an edit has no id");
  const auto [place, fresh] = liveIds_.emplace(id, kind);
  demand(fresh || place->second == kind, "an id names two kinds of things");
  demand(!deletedIds_.contains(id), "an id was deleted before");
}

void CommitValidator::deleteId(uint32_t id, Kind kind) {
  requireId(id, kind);
  liveIds_.erase(id);
  deletedIds_.insert(id);
}

void CommitValidator::requireId(uint32_t id, Kind kind) const {
  const auto found = liveIds_.find(id);
  if (found == liveIds_.end() || found->second != kind) refuse("unknown id " + std::to_string(id));
}

void CommitValidator::requireShader(uint32_t shader, RtsKind kind) const {
  requireId(shader, Kind::Shader);
  const RtsClass* table = classes_.at(shaderClasses_.at(shader));
  demand(!table || table->kind == kind, "a shader has a role that its kind does not allow");
}

void CommitValidator::check(const edit::TextureT& texture, const Commit& commit) {
  defineId(texture.id, Kind::Texture);
  const auto known = textures_.find(texture.id);
  checkTexture(texture, commit, known == textures_.end() ? nullptr : &known->second);
  textures_.insert_or_assign(texture.id, texture);
}

void CommitValidator::check(const edit::ShaderClassT& shaderClass) {
  demand(!liveIds_.contains(shaderClass.id), "a shader class is created twice");
  defineId(shaderClass.id, Kind::ShaderClass);
  classes_[shaderClass.id] =
      shaders_ ? &shaders_->find(shaderClass.name, shaderClass.library) : nullptr;
  classNames_[shaderClass.id] = shaderClass;
}

// Looks all classes up again after shader libraries were reloaded.
void CommitValidator::findClassesAgain() {
  if (!shaders_) return;
  for (auto& [id, table] : classes_)
    table = &shaders_->find(classNames_.at(id).name, classNames_.at(id).library);
}

void CommitValidator::check(const edit::ShaderT& shader) {
  demand(!liveIds_.contains(shader.id), "a shader is created twice");
  defineId(shader.id, Kind::Shader);
  requireId(shader.shaderClass, Kind::ShaderClass);
  shaderClasses_[shader.id] = shader.shaderClass;
}

void CommitValidator::check(const edit::ParameterT& parameter) const {
  requireId(parameter.shader, Kind::Shader);
  const RtsClass* table = classes_.at(shaderClasses_.at(parameter.shader));
  if (!table) return;
  demand(parameter.index < table->paramCount, "a parameter is not in its class");
  const RtsParam& param = table->params[parameter.index];
  const bool list = param.type == RTS_FLOATS;
  demand(list || parameter.floats.size() == parameterFloats(param.type),
         "a parameter has a wrong number of values");
  const std::string problem = param.type == RTS_INT
                                  ? valueProblem(param, parameter.integer)
                                  : valueProblem(param, std::span<const float>(parameter.floats));
  if (!problem.empty()) refuse(problem);
}

void CommitValidator::check(const edit::GeometryT& geometry, const Commit& commit) const {
  checkMatrix(geometry.matrix.get());
  demand(std::isfinite(geometry.width) && geometry.width > 0, "a width is not positive");
  if (geometry.shader != 0) requireShader(geometry.shader, RTS_SURFACE);
  checkGeometryArrays(geometry, commit);
  checkParameters(geometry, commit);
}

void CommitValidator::checkParameters(const edit::GeometryT& geometry, const Commit& commit) const {
  if (geometry.parameters.empty()) return;
  demand(geometry.shader != 0, "a geometry has parameters but no shader");
  const RtsClass* table = classes_.at(shaderClasses_.at(geometry.shader));
  std::unordered_set<uint32_t> seen;
  for (const auto& own : geometry.parameters) {
    demand(own && seen.insert(own->index).second,
           "a geometry has a parameter twice, or an empty one");
    const RtsParam* param = nullptr;
    if (table) {
      demand(own->index < table->paramCount, "a parameter is not in its class");
      const uint8_t frequency =
          table->frequency ? table->frequency[own->index] : uint8_t(RTS_PER_SHADER);
      demand(frequency == (own->perVertex ? RTS_PER_VERTEX : RTS_PER_TRIANGLE),
             "a parameter's frequency is not that of its class");
      param = &table->params[own->index];
    }
    checkParameterValues(geometry, *own, commit, param);
  }
}

void CommitValidator::check(const edit::ObjectT& object, const Commit& commit) {
  defineId(object.id, Kind::Object);
  demand(objects_[object.id].children == 0,
         "an object is replaced before its instances are deleted");
  for (const auto& geometry : object.geometries) {
    demand(geometry != nullptr, "an empty geometry");
    check(*geometry, commit);
  }
}

void CommitValidator::check(const edit::InstanceT& instance) {
  const bool fresh = !liveIds_.contains(instance.id);
  defineId(instance.id, Kind::Instance);
  requireId(instance.object, Kind::Object);
  if (instance.parent != 0) requireId(instance.parent, Kind::Object);
  if (instance.shader != 0) requireShader(instance.shader, RTS_SURFACE);
  if (instance.fog != 0) requireShader(instance.fog, RTS_ENVIRONMENT);
  checkMatrix(instance.matrix.get());
  Placement& placement = instances_[instance.id];
  if (!fresh) {
    demand(placement.parent == instance.parent && placement.object == instance.object,
           "an instance changes its object");
    return;
  }
  placement = {instance.parent, instance.object};
  objects_[instance.object].users++;
  if (instance.parent == 0) return;
  objects_[instance.parent].children++;
  nestingChanged_ = true;
}

void CommitValidator::check(const edit::LightT& light) {
  defineId(light.id, Kind::Light);
  requireShader(light.shader, RTS_LIGHT);
  checkMatrix(light.matrix.get());
}

void CommitValidator::check(const edit::FrameSettingsT& frame) {
  demand(isPictureSize(frame.width, frame.height), "a frame has an impossible size");
  demand(frame.channels != 0 && (frame.channels & ~allChannels) == 0,
         "a frame has unknown channels");
  demand(frame.scissorX < largestSide && frame.scissorY < largestSide &&
             frame.scissorWidth <= largestSide && frame.scissorHeight <= largestSide &&
             (frame.scissorWidth == 0) == (frame.scissorHeight == 0),
         "a frame has an impossible scissor");
  if (const char* setting = invalidQuality(frame))
    demand(false, (std::string("a frame has an impossible ") + setting).c_str());
  hasFrame_ = true;
}

void CommitValidator::deleteObject(uint32_t id) {
  deleteId(id, Kind::Object);
  demand(objects_[id].children == 0 && objects_[id].users == 0,
         "an object is deleted before its instances");
  objects_.erase(id);
}

void CommitValidator::deleteInstance(uint32_t id) {
  deleteId(id, Kind::Instance);
  const Placement placement = instances_.at(id);
  objects_[placement.object].users--;
  if (placement.parent != 0) objects_[placement.parent].children--;
  instances_.erase(id);
}

void CommitValidator::checkEdit(const edit::AnyUnion& any, const Commit& commit) {
  using edit::Any;
  demand(any.value != nullptr, "an empty edit");
  const auto role = [&](const auto& edit, RtsKind kind) {
    if (edit.shader != 0) requireShader(edit.shader, kind);
    checkMatrix(edit.matrix.get());
  };
  switch (any.type) {
  case Any::Texture: return check(*any.AsTexture(), commit);
  case Any::DeleteTexture: return deleteId(any.AsDeleteTexture()->id, Kind::Texture);
  case Any::ShaderClass: return check(*any.AsShaderClass());
  case Any::Shader: return check(*any.AsShader());
  case Any::Parameter: return check(*any.AsParameter());
  case Any::DeleteShader: return deleteId(any.AsDeleteShader()->id, Kind::Shader);
  case Any::Object: return check(*any.AsObject(), commit);
  case Any::DeleteObject: return deleteObject(any.AsDeleteObject()->id);
  case Any::Instance: return check(*any.AsInstance());
  case Any::DeleteInstance: return deleteInstance(any.AsDeleteInstance()->id);
  case Any::Light: return check(*any.AsLight());
  case Any::DeleteLight: return deleteId(any.AsDeleteLight()->id, Kind::Light);
  case Any::Camera: return role(*any.AsCamera(), RTS_CAMERA);
  case Any::Environment: return role(*any.AsEnvironment(), RTS_ENVIRONMENT);
  case Any::DefaultShader:
    if (any.AsDefaultShader()->shader != 0)
      requireShader(any.AsDefaultShader()->shader, RTS_SURFACE);
    return;
  case Any::FrameSettings: return check(*any.AsFrameSettings());
  case Any::Transport:
    if (any.AsTransport()->shader != 0) requireShader(any.AsTransport()->shader, RTS_TRANSPORT);
    return;
  case Any::ReloadShaders: return findClassesAgain();
  case Any::NONE: break;
  }
  refuse("an unknown kind of edit");
}

// Checks that no object contains itself: removes objects that no remaining object contains, until
// none is left.
void CommitValidator::checkNesting() const {
  std::unordered_map<uint32_t, uint64_t> containers;
  std::unordered_map<uint32_t, std::vector<uint32_t>> contents;
  for (const auto& [id, placement] : instances_) {
    if (placement.parent == 0) continue;
    contents[placement.parent].push_back(placement.object);
    containers[placement.object]++;
    containers[placement.parent];
  }
  std::vector<uint32_t> free;
  for (const auto& [id, count] : containers)
    if (count == 0) free.push_back(id);
  size_t removed = 0;
  for (; removed < free.size(); removed++)
    for (uint32_t inner : contents[free[removed]])
      if (--containers[inner] == 0) free.push_back(inner);
  demand(removed == containers.size(), "an object contains itself");
}

void CommitValidator::check(const Commit& commit) {
  for (const auto& entry : commit.edits.edits) {
    demand(entry != nullptr, "an empty edit");
    checkEdit(entry->any, commit);
  }
  if (nestingChanged_) checkNesting();
  nestingChanged_ = false;
  demand(hasFrame_ || !commit.edits.render, "a frame begins before its size is known");
}

} // namespace openrt
