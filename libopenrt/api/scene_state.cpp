// scene_state.cpp: creates, finds and deletes the entries of the scene. Every function allocates
// the memory it needs before it changes anything, so a failure changes nothing.
#include "api/scene_state.h"

#include <limits>
#include <unordered_map>

#include "scene/quality.h"

namespace openrt {
namespace {

template <class State> State& lookup(Table<State>& table, RTid id, const char* kind) {
  State* state = table.find(id);
  if (!state) fail(RT_INVALID_ID, std::to_string(id) + " is not " + kind);
  return *state;
}

// Reserves room so that the next push_back cannot throw, with amortised growth.
void reserveMore(std::vector<RTid>& ids, size_t more = 1) {
  if (ids.capacity() - ids.size() < more)
    ids.reserve(std::max(ids.size() + more, 2 * ids.capacity()));
}

template <class State> State& insert(Table<State>& table, RTid id) {
  reserveMore(table.dirty);
  return table.entries[id];
}

} // namespace

SceneState::SceneState() {
  for (const QualitySetting& setting : qualitySettings())
    if (setting.set) setting.set(frame, setting.info.defaultValue);
}

ObjectState& SceneState::object(RTid id) { return lookup(objects, id, "an object"); }
InstanceState& SceneState::instance(RTid id) { return lookup(instances, id, "an instance"); }
ShaderClassState& SceneState::shaderClass(RTid id) { return lookup(classes, id, "a shader class"); }
ShaderState& SceneState::shader(RTid id) { return lookup(shaders, id, "a shader"); }
TextureState& SceneState::texture(RTid id) { return lookup(textures, id, "a texture"); }
LightState& SceneState::light(RTid id) { return lookup(lights, id, "a light"); }

void SceneState::requireKind(RTid id, RtsKind kind) {
  static const char* const names[] = {"", "surface", "light", "camera", "environment", "transport"};
  if (id == 0) return;
  const RtsClass& table = classOf(shader(id));
  if (table.kind != kind)
    fail(RT_INVALID_OPERATION, std::string("the shader's class ") + table.name + " is a " +
                                   names[table.kind] + " class, not a " + names[kind] + " class");
}

RTid SceneState::newId() {
  if (nextId_ == std::numeric_limits<RTid>::max())
    fail(RT_OUT_OF_MEMORY, "all 2^32 ids are used up");
  return nextId_++;
}

RTid SceneState::newObject() {
  const RTid id = newId();
  objects.markDirty(id, insert(objects, id));
  return id;
}

// Adds the instance to the object's users. The caller adds it to the parent's children.
RTid SceneState::newInstance(const InstanceState& fresh) {
  ObjectState& target = object(fresh.object);
  reserveMore(target.users);
  const RTid id = newId();
  InstanceState& state = insert(instances, id);
  state = fresh;
  state.userSlot = target.users.size();
  target.users.push_back(id);
  instances.markDirty(id, state);
  return id;
}

RTid SceneState::newShaderClass(const RtsClass& table, std::string_view name,
                                std::string_view library) {
  for (const auto& [id, state] : classes.entries)
    if (state.name == name && state.library == library) return id;
  ShaderClassState fresh{&table, std::string(name), std::string(library)};
  const RTid id = newId();
  ShaderClassState& state = insert(classes, id);
  state = std::move(fresh);
  classes.markDirty(id, state);
  return id;
}

RTid SceneState::newShader(RTid classId) {
  shaderClass(classId);
  const RTid id = newId();
  ShaderState& state = insert(shaders, id);
  state.shaderClass = classId;
  shaders.markDirty(id, state);
  return id;
}

RTid SceneState::newTexture() {
  const RTid id = newId();
  insert(textures, id).description.id = id;
  return id;
}

RTid SceneState::newLight(RTid shaderId, const Matrix4d& matrix) {
  const RTid id = newId();
  LightState& state = insert(lights, id);
  state.shader = shaderId;
  state.matrix = matrix;
  lights.markDirty(id, state);
  return id;
}

void SceneState::defineObject(RTid id, std::vector<BuiltGeometry> geometries,
                              const std::vector<RTid>& children) {
  ObjectState& state = object(id);
  std::vector<RTid> fresh = children;
  reserveMore(instances.deleted, state.children.size());
  objects.markDirty(id, state);
  if (state.committed) state.dynamic = true; // redefined once, it is likely to be redefined again
  while (!state.children.empty()) deleteInstance(state.children.back(), nullptr);
  state.geometries = std::move(geometries);
  state.children = std::move(fresh);
  for (RTid child : state.children) instances.find(child)->inDefinition = false;
}

ArrayPtr SceneState::restingIndices(RTid object) const {
  const auto found = resting_.find(object);
  return found == resting_.end() ? nullptr : found->second.indices;
}

bool SceneState::contains(RTid inner, RTid outer) {
  if (inner == outer) return true;
  if (object(outer).users.empty() || object(inner).children.empty()) return false;
  std::vector<RTid> open{inner};
  std::unordered_map<RTid, bool> seen{{inner, true}};
  while (!open.empty()) {
    const RTid id = open.back();
    open.pop_back();
    for (RTid child : object(id).children) {
      const RTid below = instance(child).object;
      if (below == outer) return true;
      if (seen.emplace(below, true).second) open.push_back(below);
    }
  }
  return false;
}

// openChildren: the children of the open definition; they are not yet in its object's list.
void SceneState::deleteInstance(RTid id, std::vector<RTid>* openChildren) {
  InstanceState& state = instance(id);
  reserveMore(instances.deleted);
  const auto leave = [this](std::vector<RTid>& list, size_t slot, size_t InstanceState::*place) {
    list[slot] = list.back();
    instances.find(list[slot])->*place = slot;
    list.pop_back();
  };
  leave(object(state.object).users, state.userSlot, &InstanceState::userSlot);
  if (state.inDefinition)
    leave(*openChildren, state.childSlot, &InstanceState::childSlot);
  else if (state.parent != 0)
    leave(object(state.parent).children, state.childSlot, &InstanceState::childSlot);
  instances.erase(id, state);
}

void SceneState::deleteObject(RTid id, std::vector<RTid>* openChildren) {
  ObjectState& state = object(id);
  reserveMore(objects.deleted);
  reserveMore(instances.deleted, state.children.size() + state.users.size());
  while (!state.children.empty()) deleteInstance(state.children.back(), openChildren);
  while (!state.users.empty()) deleteInstance(state.users.back(), openChildren);
  objects.erase(id, state);
}

void SceneState::deleteShader(RTid id) {
  ShaderState& state = shader(id);
  std::vector<RTid> itsLights, itsInstances;
  for (const auto& [lightId, light] : lights.entries)
    if (light.shader == id) itsLights.push_back(lightId);
  for (const auto& [instanceId, instance] : instances.entries)
    if (instance.shader == id || instance.fog == id) itsInstances.push_back(instanceId);
  reserveMore(lights.deleted, itsLights.size());
  reserveMore(instances.dirty, itsInstances.size());
  reserveMore(shaders.deleted);
  for (RTid lightId : itsLights) lights.erase(lightId, lights.entries[lightId]);
  for (RTid instanceId : itsInstances) {
    InstanceState& instance = instances.entries[instanceId];
    for (RTid* shader : {&instance.shader, &instance.fog})
      if (*shader == id) *shader = 0;
    instances.markDirty(instanceId, instance);
  }
  for (RoleState* role : {&camera, &environment, &defaultShader, &transport})
    if (role->shader == id) *role = {0, Matrix4d(), true};
  shaders.erase(id, state);
}

void SceneState::deleteTexture(RTid id) { textures.erase(id, texture(id)); }
void SceneState::deleteLight(RTid id) { lights.erase(id, light(id)); }

void SceneState::shadersReloaded(
    const std::function<const RtsClass*(const std::string&, const std::string&)>& find) {
  std::vector<std::pair<ShaderClassState*, const RtsClass*>> tables;
  for (auto& [id, state] : classes.entries)
    tables.emplace_back(&state, find(state.name, state.library));
  for (const auto& [state, table] : tables) state->table = table;
  shaderGeneration++;
  generationDirty = true;
}

void SceneState::setParameter(RTid id, const ParameterValue& value) {
  ShaderState& state = shader(id);
  shaders.markDirty(id, state);
  constexpr size_t largestType = 16; // a matrix
  // Values are kept only for surface shaders, because only geometry can vary a parameter.
  const size_t floats = value.floats.size();
  if (floats > 0 && floats <= largestType && classOf(state).kind == RTS_SURFACE)
    state.values.set(value);
  state.parameters.set(value);
}

} // namespace openrt
