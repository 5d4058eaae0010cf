// scene.cpp: applies edits to the tables of the scene, one small function per kind of edit.
#include "scene/scene.h"

#include <algorithm>

#include "scene/history.h"

namespace openrt {
namespace {

bool isBefore(const std::pair<ArrayId, std::weak_ptr<const Array>>& entry, ArrayId id) {
  return entry.first < id;
}

} // namespace

Matrix4d toMatrix(const edit::Matrix* matrix) {
  Matrix4d result;
  if (matrix)
    for (int i = 0; i < 16; i++) result.m[i] = matrix->m()->Get(i);
  return result;
}

void SceneChanges::add(const SceneChanges& more) {
  structure |= more.structure;
  shaders |= more.shaders;
  textures |= more.textures;
  lights |= more.lights;
  camera |= more.camera;
  frame |= more.frame;
  parameters.insert(parameters.end(), more.parameters.begin(), more.parameters.end());
  moved.insert(moved.end(), more.moved.begin(), more.moved.end());
  redefined.insert(redefined.end(), more.redefined.begin(), more.redefined.end());
}

size_t Geometry::primitives() const {
  const size_t count = indices ? indices->count<uint32_t>() : 0;
  switch (primitive) {
  case edit::Primitive::Triangles: return count / 3;
  case edit::Primitive::Lines: return count / 2;
  case edit::Primitive::Points: return count;
  case edit::Primitive::Sphere:
  case edit::Primitive::Quadric:
  case edit::Primitive::Asphere: return 1;
  }
  return 0;
}

bool isRefitted(const Object& object) {
  return object.dynamic && object.geometries.size() == 1 &&
         object.geometries[0].primitive == edit::Primitive::Triangles &&
         object.geometries[0].primitives() >= refittedTriangles;
}

ArrayPtr Scene::array(ArrayId id) const {
  if (id == 0) return nullptr;
  if (const auto found = commit_->arrays.find(id); found != commit_->arrays.end())
    return found->second;
  const auto known = std::lower_bound(arrays_.begin(), arrays_.end(), id, isBefore);
  return known == arrays_.end() || known->first != id ? nullptr : known->second.lock();
}

std::map<ArrayId, ArrayPtr> Scene::arrays() const {
  std::map<ArrayId, ArrayPtr> alive;
  for (const auto& [id, data] : arrays_)
    if (ArrayPtr array = data.lock()) alive.emplace(id, std::move(array));
  return alive;
}

// Adds the arrays of a commit. Their numbers are larger than those before, except in a commit that
// sends arrays again.
void Scene::noteArrays(const Commit& commit) {
  // Only now and then, so that a commit costs what it changes.
  if (arrays_.size() > 2 * arraysSwept_ + 64) {
    std::erase_if(arrays_, [](const auto& entry) { return entry.second.expired(); });
    arraysSwept_ = arrays_.size();
  }
  const auto byNumber = [](const auto& a, const auto& b) { return a.first < b.first; };
  const auto known = ptrdiff_t(arrays_.size());
  for (const auto& [id, data] : commit.arrays) {
    const auto found = std::lower_bound(arrays_.begin(), arrays_.begin() + known, id, isBefore);
    if (found != arrays_.begin() + known && found->first == id)
      found->second = data;
    else
      arrays_.emplace_back(id, data);
  }
  std::sort(arrays_.begin() + known, arrays_.end(), byNumber);
  if (!std::is_sorted(arrays_.begin() + std::max<ptrdiff_t>(known - 1, 0), arrays_.end(), byNumber))
    std::inplace_merge(arrays_.begin(), arrays_.begin() + known, arrays_.end(), byNumber);
}

SceneChanges Scene::apply(const Commit& commit, SceneHistory* history,
                          std::vector<FormerGeometries>* former) {
  if (history) history->begin(commit);
  former_ = former;
  history_ = history && history->records() ? history : nullptr;
  noteArrays(commit);
  commit_ = &commit;
  SceneChanges changes;
  for (const auto& edit : commit.edits.edits)
    if (edit) applyEdit(edit->any, changes);
  sortChildren();
  commit_ = nullptr;
  history_ = nullptr;
  former_ = nullptr;
  if (history) history->finish(*this, commit);
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
    if (auto found = shaders.find(p.shader); found != shaders.end())
      found->second.parameters.set(valueOf(p));
    if (changes.parameters.empty() || changes.parameters.back() != p.shader)
      changes.parameters.push_back(p.shader);
    break;
  }
  case Any::DeleteShader:
    shaders.erase(any.AsDeleteShader()->id);
    changes.shaders = true;
    break;
  case Any::Object: replaceObject(*any.AsObject(), changes); break;
  case Any::DeleteObject:
    deleteObject(any.AsDeleteObject()->id);
    changes.structure = true;
    break;
  case Any::Instance: placeInstance(*any.AsInstance(), changes); break;
  case Any::DeleteInstance:
    deleteInstance(any.AsDeleteInstance()->id);
    changes.structure = true;
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
  case Any::Transport:
    transport = any.AsTransport()->shader;
    changes.frame = true;
    break;
  case Any::ReloadShaders: changes.shaders = true; break;
  case Any::FrameSettings:
    frame = *any.AsFrameSettings();
    changes.frame = true;
    break;
  }
}

void Scene::placeInstance(const edit::InstanceT& edit, SceneChanges& changes) {
  Instance next{edit.parent,  edit.object,   edit.shader, toMatrix(edit.matrix.get()),
                edit.visible, edit.userData, edit.name,   edit.dynamic,
                edit.fog};
  const auto [found, fresh] = instances.try_emplace(edit.id, next);
  if (fresh) {
    std::vector<uint32_t>& siblings = children_[edit.parent];
    if (!siblings.empty() && siblings.back() >= edit.id) unsorted_.push_back(edit.parent);
    siblings.push_back(edit.id);
    changes.structure = true;
    if (history_) history_->addInstance(edit.id);
    return;
  }
  Instance& known = found->second;
  if (history_) history_->changeInstance(edit.id, known);
  const bool placeOnly = known.dynamic && next.dynamic && known.parent == next.parent &&
                         known.object == next.object && known.shader == next.shader &&
                         known.userData == next.userData && known.name == next.name &&
                         known.fog == next.fog;
  if (placeOnly)
    changes.moved.push_back(edit.id);
  else
    changes.structure = true;
  if (known.parent != next.parent) { // the front end never does this
    children_[next.parent].push_back(edit.id);
    unsorted_.insert(unsorted_.end(), {known.parent, next.parent});
  }
  known = next;
}

void Scene::deleteInstance(uint32_t id) {
  const auto found = instances.find(id);
  if (found == instances.end()) return;
  unsorted_.push_back(found->second.parent);
  eraseInstance(id);
}

void Scene::eraseInstance(uint32_t id) {
  if (history_) history_->changeInstance(id, instances.at(id));
  instances.erase(id);
}

void Scene::dropChildren(uint32_t object) {
  const auto list = children_.find(object);
  if (list == children_.end()) return;
  for (uint32_t id : list->second)
    if (const auto found = instances.find(id);
        found != instances.end() && found->second.parent == object)
      eraseInstance(id);
  children_.erase(list);
}

// Takes the geometries of an object that is about to change, for those who want them. Returns null
// if nobody does.
FormerGeometries Scene::takeGeometries(Object& object) {
  if (!history_ && !former_) return nullptr;
  auto taken = std::make_shared<const std::vector<Geometry>>(std::move(object.geometries));
  if (former_ && !taken->empty()) former_->push_back(taken);
  return taken;
}

void Scene::replaceObject(const edit::ObjectT& object, SceneChanges& changes) {
  const auto children = children_.find(object.id);
  const bool leaf = children == children_.end() || children->second.empty();
  const auto [found, fresh] = objects.try_emplace(object.id);
  Object& target = found->second;
  if (history_ && fresh) history_->addObject(object.id);
  if (const FormerGeometries taken = fresh ? nullptr : takeGeometries(target); taken && history_)
    history_->changeObject(object.id, taken);
  if (!fresh && leaf && target.dynamic && object.dynamic)
    changes.redefined.push_back(object.id);
  else
    changes.structure = true;
  target.version = ++version_;
  target.dynamic = object.dynamic;
  target.geometries.clear();
  target.geometries.reserve(object.geometries.size());
  for (const auto& g : object.geometries) {
    if (!g) continue;
    target.geometries.push_back({g->primitive,
                                 g->shader,
                                 g->name,
                                 toMatrix(g->matrix.get()),
                                 g->cull,
                                 g->clockwise,
                                 g->width,
                                 array(g->points),
                                 array(g->indices),
                                 array(g->normals),
                                 array(g->texCoords),
                                 array(g->colors),
                                 {},
                                 AnalyticSurface::make(g->primitive, g->surface),
                                 array(g->rest),
                                 g->texGen,
                                 array(g->fogCoords),
                                 {g->stippleFactor, g->stipplePattern}});
    for (const auto& p : g->parameters)
      if (p)
        target.geometries.back().parameters.push_back({p->index, p->perVertex, array(p->values)});
  }
  dropChildren(object.id);
}

// Its instances were deleted before; any that is left draws nothing.
void Scene::deleteObject(uint32_t id) {
  const auto found = objects.find(id);
  if (found != objects.end()) {
    if (former_) takeGeometries(found->second);
    objects.erase(found);
  }
  dropChildren(id);
}

// Updates the child lists that changed: sorted by id, without duplicates and without deleted
// instances.
void Scene::sortChildren() {
  std::sort(unsorted_.begin(), unsorted_.end());
  unsorted_.erase(std::unique(unsorted_.begin(), unsorted_.end()), unsorted_.end());
  for (uint32_t parent : unsorted_) {
    const auto list = children_.find(parent);
    if (list == children_.end()) continue;
    std::erase_if(list->second, [&](uint32_t id) {
      const auto found = instances.find(id);
      return found == instances.end() || found->second.parent != parent;
    });
    std::sort(list->second.begin(), list->second.end());
    list->second.erase(std::unique(list->second.begin(), list->second.end()), list->second.end());
  }
  unsorted_.clear();
}

const std::vector<uint32_t>& Scene::childrenOf(uint32_t object) const {
  static const std::vector<uint32_t> none;
  auto found = children_.find(object);
  return found == children_.end() ? none : found->second;
}

} // namespace openrt
