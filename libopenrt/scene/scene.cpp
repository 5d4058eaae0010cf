// scene.cpp: applies edits to the tables of the scene, one small function a kind of edit.
#include "scene/scene.h"

namespace openrt {
namespace {

Matrix4d toMatrix(const edit::Matrix* matrix) {
  Matrix4d result;
  if (matrix)
    for (int i = 0; i < 16; i++) result.m[i] = matrix->m()->Get(i);
  return result;
}

} // namespace

size_t Geometry::primitives() const {
  const size_t count = indices ? indices->count<uint32_t>() : 0;
  switch (primitive) {
  case edit::Primitive::Triangles: return count / 3;
  case edit::Primitive::Lines: return count / 2;
  case edit::Primitive::Points: return count;
  case edit::Primitive::Sphere: return 1;
  }
  return 0;
}

ArrayPtr Scene::array(ArrayId id) const {
  if (id == 0) return nullptr;
  if (auto found = arriving_.find(id); found != arriving_.end()) return found->second;
  auto known = arrays_.find(id);
  return known == arrays_.end() ? nullptr : known->second.lock();
}

SceneChanges Scene::apply(const Commit& commit) {
  std::erase_if(arrays_, [](const auto& entry) { return entry.second.expired(); });
  for (const auto& [id, data] : commit.arrays) {
    arriving_[id] = data;
    arrays_[id] = data;
  }
  SceneChanges changes;
  for (const auto& edit : commit.edits.edits)
    if (edit) applyEdit(edit->any, changes);
  if (changes.instances || changes.geometry) sortChildren();
  arriving_.clear();
  return changes;
}

void Scene::applyEdit(const edit::AnyUnion& any, SceneChanges& changes) {
  using edit::Any;
  switch (any.type) {
  case Any::NONE: break;
  case Any::Texture: {
    const auto& t = *any.AsTexture();
    textures[t.id] = {t, array(t.texels)};
    changes.textures = true;
    break;
  }
  case Any::DeleteTexture:
    textures.erase(any.AsDeleteTexture()->id);
    changes.textures = true;
    break;
  case Any::ShaderClass: {
    const auto& c = *any.AsShaderClass();
    classes[c.id] = {c.name, c.library};
    changes.shaders = true;
    break;
  }
  case Any::Shader:
    shaders[any.AsShader()->id] = {any.AsShader()->shaderClass, {}};
    changes.shaders = true;
    break;
  case Any::Parameter: {
    const auto& p = *any.AsParameter();
    if (auto found = shaders.find(p.shader); found != shaders.end()) found->second.parameters[p.index] = p;
    changes.shaders = true;
    break;
  }
  case Any::DeleteShader:
    shaders.erase(any.AsDeleteShader()->id);
    changes.shaders = true;
    break;
  case Any::Object:
    replaceObject(*any.AsObject());
    changes.geometry = true;
    break;
  case Any::DeleteObject:
    deleteObject(any.AsDeleteObject()->id);
    changes.geometry = changes.instances = true;
    break;
  case Any::Instance: {
    const auto& i = *any.AsInstance();
    instances[i.id] = {i.parent, i.object, i.shader, toMatrix(i.matrix.get()), i.visible, i.userData, i.name, i.dynamic};
    changes.instances = true;
    break;
  }
  case Any::DeleteInstance:
    instances.erase(any.AsDeleteInstance()->id);
    changes.instances = true;
    break;
  case Any::Light: {
    const auto& l = *any.AsLight();
    lights[l.id] = {l.shader, l.scope, toMatrix(l.matrix.get())};
    changes.lights = true;
    break;
  }
  case Any::DeleteLight:
    lights.erase(any.AsDeleteLight()->id);
    changes.lights = true;
    break;
  case Any::Camera:
    camera = {any.AsCamera()->shader, toMatrix(any.AsCamera()->matrix.get())};
    changes.camera = true;
    break;
  case Any::Environment:
    environment = {any.AsEnvironment()->shader, toMatrix(any.AsEnvironment()->matrix.get())};
    changes.lights = true;
    break;
  case Any::DefaultShader:
    defaultShader = any.AsDefaultShader()->shader;
    changes.shaders = true;
    break;
  case Any::FrameSettings:
    frame = *any.AsFrameSettings();
    changes.frame = true;
    break;
  }
}

void Scene::dropChildren(uint32_t object) {
  std::erase_if(instances, [object](const auto& entry) { return entry.second.parent == object; });
}

void Scene::replaceObject(const edit::ObjectT& object) {
  Object& target = objects[object.id];
  target.dynamic = object.dynamic;
  target.geometries.clear();
  target.geometries.reserve(object.geometries.size());
  for (const auto& g : object.geometries) {
    if (!g) continue;
    target.geometries.push_back({g->primitive, g->shader, g->name, toMatrix(g->matrix.get()), g->cull, g->clockwise, g->width,
                                 array(g->points), array(g->indices), array(g->normals), array(g->texCoords), array(g->colors)});
  }
  if (auto found = children_.find(object.id); found != children_.end() && !found->second.empty()) dropChildren(object.id);
}

void Scene::deleteObject(uint32_t id) {
  objects.erase(id);
  std::erase_if(instances, [id](const auto& entry) { return entry.second.parent == id || entry.second.object == id; });
}

void Scene::sortChildren() {
  children_.clear();
  for (const auto& [id, instance] : instances) children_[instance.parent].push_back(id); // ids ascend: map order
}

const std::vector<uint32_t>& Scene::childrenOf(uint32_t object) const {
  static const std::vector<uint32_t> none;
  auto found = children_.find(object);
  return found == children_.end() ? none : found->second;
}

} // namespace openrt
