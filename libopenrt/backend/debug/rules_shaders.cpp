// rules_shaders.cpp: rules about shaders, their parameters and textures, and lights. Application
// thread.
#include <algorithm>
#include <cstring>
#include <limits>
#include <set>

#include "backend/debug/rules.h"
#include "scene/flatten.h"
#include "shading/parameters.h"

namespace openrt::debug {
namespace {

void collectUsedShaders(const Scene& scene, std::set<uint32_t>& used) {
  used.insert(
      {scene.camera.shader, scene.environment.shader, scene.defaultShader, scene.transport});
  for (const auto& [id, light] : scene.lights) used.insert(light.shader);
  for (const auto& [id, instance] : scene.instances) used.insert({instance.shader, instance.fog});
  for (const auto& [id, object] : scene.objects)
    for (const Geometry& g : object.geometries) used.insert(g.shader);
}

void unusedShaders(const RuleContext& f, const Report& report) {
  std::set<uint32_t>& used = f.memory.shaders;
  collectUsedShaders(f.scene, used);
  for (const auto& [id, values] : f.scene.shaders) {
    const RtsClass* table = f.classOf(id);
    if (!table || used.contains(id)) continue;
    if (table->kind == RTS_SURFACE)
      report(
          id,
          nameOfShader(f, id) +
              " is used by no geometry: call rtBindShader before rtBegin, the arrays or rtSphere "
              "(which take the bound shader), or call rtInstanceShader or rtDefaultShader");
    if (table->kind == RTS_LIGHT)
      report(id, nameOfShader(f, id) + " gives no light: turn it on with rtUseLight");
    if (table->kind == RTS_ENVIRONMENT)
      report(id, nameOfShader(f, id) + " is not used: call rtUseEnvironment or rtInstanceFog");
  }
}

void missingTextures(const RuleContext& f, const Report& report) {
  for (const auto& [id, values] : f.scene.shaders)
    for (const ParameterValue& parameter : values.parameters)
      if (parameter.texture != 0 && !f.scene.textures.contains(parameter.texture))
        report(id, nameOfShader(f, id) + " has " + nameOf("texture", parameter.texture) +
                       ", which has no image and counts as white: bind it and call rtTexImage2D");
}

void removedParameters(const RuleContext& f, const Report& report) {
  for (const auto& [id, values] : f.scene.shaders) {
    const RtsClass* table = f.classOf(id);
    for (const ParameterValue& parameter : values.parameters)
      if (table && parameter.index < table->paramCount && !*table->params[parameter.index].name)
        report(id,
               nameOfShader(f, id) + " has a value for parameter " +
                   std::to_string(parameter.index) +
                   ", which its library lost when it was reloaded: call rtParameterHandle again");
  }
}

// Reports textures on geometry without texture coordinates, which show one texel everywhere.
void unmappedTextures(const RuleContext& f, const Report& report) {
  for (const auto& [id, object] : f.scene.objects)
    for (const Geometry& g : object.geometries) {
      if (g.primitive == edit::Primitive::Sphere || g.surface || g.texCoords || g.shader == 0 ||
          g.texGen != edit::TexGen::Off)
        continue;
      const auto values = f.scene.shaders.find(g.shader);
      if (values == f.scene.shaders.end()) continue;
      for (const ParameterValue& parameter : values->second.parameters)
        if (parameter.texture != 0 && f.scene.textures.contains(parameter.texture))
          report(id,
                 nameOfShader(f, g.shader) + " has a texture, but geometry of " +
                     nameOf("object", id) +
                     " has no texture coordinates: set them with rtTexCoord or rtTexCoordPointer");
    }
}

// Reports per-vertex or per-triangle values that an override with another class makes useless.
void overriddenParameters(const RuleContext& f, const Report& report) {
  for (const auto& [id, instance] : f.scene.instances) {
    if (instance.shader == 0) continue;
    const auto object = f.scene.objects.find(instance.object);
    if (object == f.scene.objects.end()) continue;
    for (const Geometry& g : object->second.geometries)
      if (!g.parameters.empty() && f.classOf(g.shader) != f.classOf(instance.shader))
        report(id, nameOf("instance", id) + " draws " + nameOf("object", instance.object) +
                       " with " + nameOfShader(f, instance.shader) +
                       ", whose class differs from its own: the parameter values of its triangles "
                       "or vertices are ignored");
  }
}

struct Bounds {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void add(const Vec3d& p) {
    low = min(low, p);
    high = max(high, p);
  }
  bool empty() const { return !(low.x <= high.x); }
  double distance(const Vec3d& p) const { return length(max(max(low - p, p - high), Vec3d())); }
};

Bounds boundsOf(const Object& object) {
  Bounds b;
  for (const Geometry& g : object.geometries) {
    if (g.primitive == edit::Primitive::Sphere) {
      for (int corner = 0; corner < 8; corner++)
        b.add(g.matrix.point({corner & 1 ? g.width : -g.width, corner & 2 ? g.width : -g.width,
                              corner & 4 ? g.width : -g.width}));
    } else if (g.surface) {
      const Vec3d low = g.surface->low(), high = g.surface->high();
      for (int corner = 0; corner < 8; corner++)
        b.add(g.matrix.point({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                              corner & 4 ? high.z : low.z}));
    } else if (g.points) {
      const float* p = g.points->as<float>();
      for (size_t i = 0; i + 2 < g.points->count<float>(); i += 3)
        b.add(g.matrix.point({p[i], p[i + 1], p[i + 2]}));
    }
  }
  return b;
}

Bounds boundsOf(const Scene& scene) {
  Bounds world;
  const Flattened flat = flatten(scene);
  std::map<uint32_t, Bounds> objects;
  for (const Cluster& cluster : flat.clusters) {
    if (!cluster.visible) continue;
    for (const Item& item : flat.parts[cluster.part].items) {
      const auto [known, fresh] = objects.try_emplace(item.object);
      if (fresh) known->second = boundsOf(scene.objects.at(item.object));
      const Bounds& b = known->second;
      const Matrix4d toWorld = cluster.world * item.matrix;
      for (int corner = 0; corner < 8 && !b.empty(); corner++)
        world.add(toWorld.point({corner & 1 ? b.high.x : b.low.x, corner & 2 ? b.high.y : b.low.y,
                                 corner & 4 ? b.high.z : b.low.z}));
    }
  }
  return world;
}

// Returns the values of a parameter by name: those that were set, or the defaults. Returns false if
// the class does not have the parameter.
bool valueOf(const RuleContext& f, uint32_t shader, const char* name, RtsType type, float out[3]) {
  const RtsClass* table = f.classOf(shader);
  for (uint32_t i = 0; table && i < table->paramCount; i++) {
    const RtsParam& param = table->params[i];
    if (std::strcmp(param.name, name) != 0 || param.type != type) continue;
    const auto set = f.scene.shaders.at(shader).parameters.find(i);
    for (size_t k = 0; k < parameterFloats(type); k++)
      out[k] = set && k < set->floats.size() ? set->floats[k] : param.defaultValue[k];
    return true;
  }
  return false;
}

void uselessLights(const RuleContext& f, const Report& report) {
  Bounds world;
  bool known = false;
  for (const auto& [id, light] : f.scene.lights) {
    const std::string name = nameOf("light", id) + " of " + nameOfShader(f, light.shader);
    if (light.scope != 0 && !f.scene.instances.contains(light.scope))
      report(id, name + " shines on nothing: the instance of its rtLightScope was deleted; delete "
                        "the light or give it another scope");
    if (!light.matrix.usable())
      report(id, name + " has a singular matrix and gives no light: check rtLightMatrix");
    float intensity[3] = {1, 1, 1}, radius[3] = {}, place[3] = {};
    if (valueOf(f, light.shader, "intensity", RTS_FLOAT, intensity) && intensity[0] == 0)
      report(id,
             name + " has the intensity 0: remove it with rtRemoveLight, or give it another one");
    if (!valueOf(f, light.shader, "radius", RTS_FLOAT, radius) ||
        !valueOf(f, light.shader, "location", RTS_VEC3, place))
      continue;
    if (!known) {
      world = boundsOf(f.scene);
      known = true;
    }
    if (world.empty()) continue;
    const double scale = std::max({length(light.matrix.column(0)), length(light.matrix.column(1)),
                                   length(light.matrix.column(2))});
    const double distance = world.distance(light.matrix.point({place[0], place[1], place[2]}));
    if (distance > scale * radius[0])
      report(id, name + " reaches nothing: its radius is " + std::to_string(scale * radius[0]) +
                     ", the nearest geometry is " + std::to_string(distance) +
                     " away; raise its radius or move it");
  }
}

constexpr Rule table[] = {
    {"unused-shader", unusedShaders},
    {"texture-without-image", missingTextures},
    {"parameter-gone", removedParameters},
    {"no-texture-coordinates", unmappedTextures},
    {"parameters-ignored", overriddenParameters},
    {"useless-light", uselessLights},
};

} // namespace

std::span<const Rule> shaderRules() { return table; }

} // namespace openrt::debug
