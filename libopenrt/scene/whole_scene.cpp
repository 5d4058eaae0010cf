// whole_scene.cpp: writes the tables of a scene as edits, in an order in which everything is
// defined before it is used.
#include "scene/whole_scene.h"

#include <unordered_map>

namespace openrt {
namespace {

std::unique_ptr<edit::Matrix> makeEdit(const Matrix4d& matrix) {
  return std::make_unique<edit::Matrix>(flatbuffers::span<const double, 16>(matrix.m));
}

class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene), commit_(std::make_shared<Commit>()) {
    for (const auto& [id, array] : scene.arrays()) numbers_[array.get()].push_back(id);
  }

  std::shared_ptr<const Commit> write() {
    addTextures();
    addShaders();
    addObjects();
    addInstances();
    addRoles();
    commit_->edits.render = scene_.frame.width > 0;
    return commit_;
  }

 private:
  template <class T> void add(T edit) {
    auto entry = std::make_unique<edit::EditT>();
    entry->any.Set(std::move(edit));
    commit_->edits.edits.push_back(std::move(entry));
  }

  // Returns the number of an array. The same array may have several numbers; all are added, because
  // later commits may use any of them.
  ArrayId number(const ArrayPtr& array) {
    if (!array) return 0;
    const auto& numbers = numbers_.at(array.get());
    for (ArrayId id : numbers) commit_->arrays.emplace(id, array);
    return numbers.front();
  }

  uint32_t shader(uint32_t id) const { return scene_.shaders.contains(id) ? id : 0; }

  void addTextures() {
    for (const auto& [id, image] : scene_.textures) {
      edit::TextureT e = image.description;
      e.id = id;
      if (!image.texels || !numbers_.contains(image.texels.get()))
        e.texels = 0;
      else if (number(image.texels); !commit_->arrays.contains(e.texels))
        e.texels = number(image.texels);
      add(std::move(e));
    }
  }

  void addShaders() {
    for (const auto& [id, name] : scene_.classes) {
      edit::ShaderClassT e;
      e.id = id;
      e.name = name.name;
      e.library = name.library;
      add(std::move(e));
    }
    for (const auto& [id, values] : scene_.shaders) {
      edit::ShaderT e;
      e.id = id;
      e.shaderClass = values.shaderClass;
      add(std::move(e));
      for (const ParameterValue& value : values.parameters) add(editOf(id, value));
    }
  }

  std::unique_ptr<edit::GeometryT> makeEdit(const Geometry& g) {
    auto e = std::make_unique<edit::GeometryT>();
    e->primitive = g.primitive;
    e->shader = shader(g.shader);
    e->name = g.name;
    e->matrix = openrt::makeEdit(g.matrix);
    e->cull = g.cull;
    e->clockwise = g.clockwise;
    e->width = g.width;
    e->points = number(g.points);
    e->indices = number(g.indices);
    e->normals = number(g.normals);
    e->texCoords = number(g.texCoords);
    e->colors = number(g.colors);
    e->rest = number(g.rest);
    e->texGen = g.texGen;
    e->fogCoords = number(g.fogCoords);
    e->stippleFactor = g.stipple.factor;
    e->stipplePattern = g.stipple.pattern;
    if (g.surface) e->surface = g.surface->numbers();
    for (const GeometryParameter& own : g.parameters) {
      if (e->shader == 0) break; // parameters belong to the shader's class
      auto p = std::make_unique<edit::GeometryParameterT>();
      p->index = own.index;
      p->perVertex = own.perVertex;
      p->values = number(own.values);
      e->parameters.push_back(std::move(p));
    }
    return e;
  }

  void addObjects() {
    for (const auto& [id, object] : scene_.objects) {
      edit::ObjectT e;
      e.id = id;
      e.dynamic = object.dynamic;
      for (const Geometry& geometry : object.geometries) e.geometries.push_back(makeEdit(geometry));
      add(std::move(e));
    }
  }

  void addInstances() {
    for (const auto& [id, instance] : scene_.instances) {
      if (!scene_.objects.contains(instance.object) ||
          (instance.parent && !scene_.objects.contains(instance.parent)))
        continue;
      edit::InstanceT e;
      e.id = id;
      e.parent = instance.parent;
      e.object = instance.object;
      e.shader = shader(instance.shader);
      e.fog = shader(instance.fog);
      e.matrix = openrt::makeEdit(instance.matrix);
      e.visible = instance.visible;
      e.userData = instance.userData;
      e.name = instance.name;
      e.dynamic = instance.dynamic;
      add(std::move(e));
    }
  }

  void addRoles() {
    for (const auto& [id, light] : scene_.lights) {
      if (!shader(light.shader)) continue;
      edit::LightT e;
      e.id = id;
      e.shader = light.shader;
      e.scope = light.scope;
      e.matrix = openrt::makeEdit(light.matrix);
      add(std::move(e));
    }
    const auto role = [this]<class T>(T e, const Role& from) {
      e.shader = shader(from.shader);
      e.matrix = openrt::makeEdit(from.matrix);
      add(std::move(e));
    };
    role(edit::CameraT(), scene_.camera);
    role(edit::EnvironmentT(), scene_.environment);
    edit::DefaultShaderT standard;
    standard.shader = shader(scene_.defaultShader);
    add(standard);
    edit::TransportT transport;
    transport.shader = shader(scene_.transport);
    add(transport);
    if (scene_.frame.width > 0) add(edit::FrameSettingsT(scene_.frame));
  }

  const Scene& scene_;
  std::shared_ptr<Commit> commit_;
  std::unordered_map<const Array*, std::vector<ArrayId>> numbers_;
};

} // namespace

std::shared_ptr<const Commit> wholeScene(const Scene& scene) { return Writer(scene).write(); }

} // namespace openrt
