// commit.cpp: turns the changed state of the scene into the edits of one commit, in the order given
// in scene_state.h. make() allocates all memory before markCommitted() marks the edits as sent, so
// a commit that fails leaves the scene unchanged. Runs on the application's thread.
#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <unordered_map>
#include <utility>

#include <xxhash.h>

#include "api/geometry/deforming.h"
#include "api/scene_state.h"
#include "scene/scene.h"

namespace openrt {
namespace {

std::unique_ptr<edit::Matrix> toEdit(const Matrix4d& matrix) {
  return std::make_unique<edit::Matrix>(flatbuffers::span<const double, 16>(matrix.m));
}

} // namespace

class CommitBuilder {
 public:
  explicit CommitBuilder(SceneState& scene) : scene_(scene), commit_(std::make_shared<Commit>()) {}

  std::shared_ptr<const Commit> make(bool render) {
    commit_->edits.render = render;
    commit_->edits.edits.reserve(scene_.objects.dirty.size() + scene_.instances.dirty.size());
    addDeletions<edit::DeleteLightT>(scene_.lights);
    addDeletions<edit::DeleteInstanceT>(scene_.instances);
    addTextures();
    addShaders();
    addObjects();
    addInstances();
    addLights();
    addRoles();
    addDeletions<edit::DeleteObjectT>(scene_.objects);
    addDeletions<edit::DeleteShaderT>(scene_.shaders);
    addDeletions<edit::DeleteTextureT>(scene_.textures);
    markCommitted();
    return commit_;
  }

 private:
  template <class T> void add(T edit) {
    auto entry = std::make_unique<edit::EditT>();
    entry->any.Set(std::move(edit));
    commit_->edits.edits.push_back(std::move(entry));
  }

  template <class Deletion, class State> void addDeletions(const Table<State>& table) {
    for (RTid id : table.deleted) {
      Deletion deletion;
      deletion.id = id;
      add(std::move(deletion));
    }
  }

  // Calls f for every changed entry of a table that still exists.
  template <class State, class F> void forEachDirty(Table<State>& table, const F& f) {
    for (RTid id : table.dirty)
      if (State* state = table.find(id)) f(id, *state);
  }

  // Adds an array to the commit, once for all arrays with the same bytes: for example a coordinate
  // list that several geometries share, or the corners of equal boxes.
  ArrayId addArray(const ArrayPtr& array) {
    if (!array) return 0;
    auto& [recent, recentId] = recentPlace(array);
    if (recent == array.get()) return recentId;
    recent = array.get();
    return recentId = addNewArray(array);
  }

  // Adds an array that an earlier commit has given a number. It keeps the number.
  void addKnownArray(const ArrayPtr& array, ArrayId id) {
    commit_->arrays.emplace(id, array);
    recentPlace(array) = {array.get(), id};
  }

  std::pair<const Array*, ArrayId>& recentPlace(const ArrayPtr& array) {
    return recent_[std::hash<const Array*>()(array.get()) / 64 % recent_.size()];
  }

  ArrayId addNewArray(const ArrayPtr& array) {
    const uint64_t hash = XXH3_64bits(array->data(), array->size());
    const auto [first, last] = known_.equal_range(hash);
    for (auto it = first; it != last; ++it) {
      const Array& known = *commit_->arrays.at(it->second);
      if (known.size() == array->size() &&
          std::memcmp(known.data(), array->data(), array->size()) == 0)
        return it->second;
    }
    commit_->arrays.emplace(scene_.nextArray_, array);
    known_.emplace(hash, scene_.nextArray_);
    return scene_.nextArray_++;
  }

  void addTextures() {
    forEachDirty(scene_.textures, [&](RTid, TextureState& state) {
      if (state.texels) state.description.texels = addArray(state.texels);
      add(edit::TextureT(state.description));
    });
  }

  void addShaders() {
    if (scene_.generationDirty) {
      edit::ReloadShadersT e;
      e.generation = scene_.shaderGeneration;
      add(e);
    }
    forEachDirty(scene_.classes, [&](RTid id, ShaderClassState& state) {
      edit::ShaderClassT e;
      e.id = id;
      e.name = state.name;
      e.library = state.library;
      add(std::move(e));
    });
    forEachDirty(scene_.shaders, [&](RTid id, ShaderState& state) {
      if (!state.committed) {
        edit::ShaderT e;
        e.id = id;
        e.shaderClass = state.shaderClass;
        add(e);
      }
      for (const ParameterValue& value : state.parameters) add(editOf(id, value));
    });
  }

  std::unique_ptr<edit::GeometryT> toEditGeometry(const BuiltGeometry& built) {
    auto e = std::make_unique<edit::GeometryT>();
    e->primitive = built.primitive;
    // The shader may have been deleted since it was latched.
    e->shader = scene_.shaders.find(built.state.shader) ? built.state.shader : 0;
    e->name = built.state.name;
    e->matrix = toEdit(built.state.matrix);
    e->cull = built.state.cull;
    e->clockwise = built.state.clockwise;
    e->width = built.state.width;
    e->texGen = built.state.texGen;
    e->stippleFactor = built.state.stipple.factor;
    e->stipplePattern = built.state.stipple.pattern;
    e->points = addArray(built.points);
    e->indices = addArray(built.indices);
    e->normals = addArray(built.normals);
    e->texCoords = addArray(built.texCoords);
    e->colors = addArray(built.colors);
    e->fogCoords = addArray(built.fogCoords);
    e->surface = built.surface;
    for (size_t i = 0; e->shader != 0 && i < built.parameters.size(); i++) {
      auto parameter = std::make_unique<edit::GeometryParameterT>();
      parameter->index = built.parameters[i].index;
      parameter->perVertex = built.parameters[i].perVertex;
      parameter->values = addArray(built.parameters[i].values);
      e->parameters.push_back(std::move(parameter));
    }
    return e;
  }

  void addObjects() {
    forEachDirty(scene_.objects, [&](RTid id, ObjectState& state) {
      edit::ObjectT e;
      e.id = id;
      e.dynamic = state.dynamic;
      const bool refitted = isRefitted(state);
      const bool keptTree = refitted && keepsTree(id, state.geometries[0]);
      for (const BuiltGeometry& built : state.geometries)
        e.geometries.push_back(toEditGeometry(built));
      if (refitted) noteTree(id, state.geometries[0], keptTree, *e.geometries[0]);
      add(std::move(e));
    });
  }

  // Returns whether backends refit the tree of an object (Geometry::rest).
  static bool isRefitted(const ObjectState& state) {
    if (!state.dynamic || state.geometries.size() != 1) return false;
    const BuiltGeometry& built = state.geometries[0];
    return built.primitive == edit::Primitive::Triangles &&
           built.indices->count<uint32_t>() / 3 >= refittedTriangles;
  }

  // Returns whether the tree of an object serves its new points. Indices that have not changed stay
  // the same array.
  bool keepsTree(RTid id, BuiltGeometry& built) {
    const auto found = scene_.resting_.find(id);
    if (found == scene_.resting_.end()) return false;
    const RestingMesh& rest = found->second;
    if (rest.points->size() != built.points->size() || !sameBytes(rest.indices, built.indices))
      return false;
    built.indices = rest.indices;
    addKnownArray(rest.indices, rest.indicesId);
    return !hasDeformedMuch(*rest.points, *built.points);
  }

  // Writes what the tree of an object is built of, and remembers it if it is new.
  void noteTree(RTid id, const BuiltGeometry& built, bool keptTree, edit::GeometryT& e) {
    RestingMesh& rest = scene_.resting_[id];
    if (!keptTree) {
      rest = {built.points, built.indices, e.points, e.indices};
    } else if (e.points != rest.pointsId) {
      e.rest = rest.pointsId;
      commit_->arrays.emplace(rest.pointsId, rest.points);
    }
  }

  void addInstances() {
    forEachDirty(scene_.instances, [&](RTid id, InstanceState& state) {
      edit::InstanceT e;
      e.id = id;
      e.parent = state.parent;
      e.object = state.object;
      e.shader = state.shader;
      e.fog = state.fog;
      e.matrix = toEdit(state.matrix);
      e.visible = state.visible;
      e.userData = state.userData;
      e.name = state.name;
      e.dynamic = state.dynamic;
      add(std::move(e));
    });
  }

  void addLights() {
    forEachDirty(scene_.lights, [&](RTid id, LightState& state) {
      edit::LightT e;
      e.id = id;
      e.shader = state.shader;
      e.scope = state.scope;
      e.matrix = toEdit(state.matrix);
      add(std::move(e));
    });
  }

  template <class T> void addRole(const RoleState& role) {
    if (!role.dirty) return;
    T e;
    e.shader = role.shader;
    e.matrix = toEdit(role.matrix);
    add(std::move(e));
  }

  void addRoles() {
    addRole<edit::CameraT>(scene_.camera);
    addRole<edit::EnvironmentT>(scene_.environment);
    if (scene_.defaultShader.dirty) {
      edit::DefaultShaderT e;
      e.shader = scene_.defaultShader.shader;
      add(e);
    }
    if (scene_.transport.dirty) {
      edit::TransportT e;
      e.shader = scene_.transport.shader;
      add(e);
    }
    if (scene_.frameDirty) add(edit::FrameSettingsT(scene_.frame));
  }

  template <class State, class F>
  void markTableCommitted(Table<State>& table, const F& release) noexcept {
    forEachDirty(table, [&](RTid, State& state) {
      release(state);
      state.dirty = false;
      state.committed = true;
    });
    table.dirty.clear();
    table.deleted.clear();
  }

  void markCommitted() noexcept {
    for (const RTid id : scene_.objects.deleted) scene_.resting_.erase(id);
    for (const RTid id : scene_.objects.dirty)
      if (const ObjectState* state = scene_.objects.find(id); state && !isRefitted(*state))
        scene_.resting_.erase(id);
    markTableCommitted(scene_.objects,
                       [](ObjectState& s) { std::vector<BuiltGeometry>().swap(s.geometries); });
    markTableCommitted(scene_.instances, [](InstanceState&) {});
    markTableCommitted(scene_.classes, [](ShaderClassState&) {});
    markTableCommitted(scene_.shaders, [](ShaderState& s) { s.parameters.clear(); });
    markTableCommitted(scene_.textures, [](TextureState& s) { s.texels.reset(); });
    markTableCommitted(scene_.lights, [](LightState&) {});
    scene_.generationDirty = false;
    scene_.camera.dirty = scene_.environment.dirty = scene_.defaultShader.dirty =
        scene_.transport.dirty = scene_.frameDirty = false;
  }

  SceneState& scene_;
  std::shared_ptr<Commit> commit_;
  std::unordered_multimap<uint64_t, ArrayId> known_; // arrays of this commit, by hash
  // Arrays that were added lately, by address; geometries may share them already.
  std::array<std::pair<const Array*, ArrayId>, 256> recent_{};
};

std::shared_ptr<const Commit> SceneState::takeCommit(bool render) {
  return CommitBuilder(*this).make(render);
}

} // namespace openrt
