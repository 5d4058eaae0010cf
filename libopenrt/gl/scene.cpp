// scene.cpp: Gives OpenRT what a frame has changed: objects and instances, materials, and renders
// it. lights.cpp sets lights, environment and camera.
#include "gl/scene.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "gl/mesh.h"
#include "gl/parameters.h"
#include "openrt/gl.h"

namespace rtgl {
namespace {

constexpr uint64_t framesKept = 8; // frames without a geometry before its object is deleted

enum Kind { openGlKind, physicalKind };

int lightOfEnvironment() {
  const char* text = std::getenv("OPENRT_GL_LIGHT");
  const std::string_view name = text ? text : "";
  return name == "linear" ? RTGL_LINEAR : name == "shadows" ? RTGL_SHADOWS : RTGL_OPENGL;
}

size_t hashOfParts(const std::vector<Part>& parts) {
  size_t hash = parts.size();
  for (const Part& part : parts) hash = hash * 1000003 + part.hash();
  return hash;
}

// Adds the primitives of a part to the object that is being defined.
void define(const Part& part, bool linear) {
  Mesh mesh = meshOf(part);
  if (mesh.vertices.empty()) return;
  if (linear && part.colored)
    for (Vertex& vertex : mesh.vertices)
      for (size_t c = 0; c < 3; c++) vertex.color[c] = decoded(vertex.color[c]);
  constexpr size_t stride = sizeof(Vertex);
  const Vertex* v = mesh.vertices.data();
  rtVertexPointer(3, RT_FLOAT, stride, v->position.data());
  rtNormalPointer(RT_FLOAT, stride, part.lit ? v->normal.data() : nullptr);
  rtTexCoordPointer(2, RT_FLOAT, stride, part.textured ? v->texCoord.data() : nullptr);
  rtColorPointer(4, RT_FLOAT, stride, part.colored ? v->color.data() : nullptr);
  (part.cull ? rtEnable : rtDisable)(RT_CULL_FACE);
  rtLineWidth(part.lineWidth);
  rtPointSize(part.pointSize);
  const auto draw = [&](RTenum mode, const std::vector<uint32_t>& indices) {
    if (!indices.empty())
      rtDrawElements(mode, indices.size(), indices.data(), mesh.vertices.size());
  };
  draw(RT_TRIANGLES, mesh.triangles);
  draw(RT_LINES, mesh.lines);
  draw(RT_POINTS, mesh.points);
  rtVertexPointer(3, RT_FLOAT, 0, nullptr); // the arrays end with this call
  rtNormalPointer(RT_FLOAT, 0, nullptr);
  rtTexCoordPointer(2, RT_FLOAT, 0, nullptr);
  rtColorPointer(4, RT_FLOAT, 0, nullptr);
}

} // namespace

bool Scene::linear() const {
  return (lightMode < 0 ? lightOfEnvironment() : lightMode) == RTGL_LINEAR;
}

RTid Scene::classOf(const char* name, const char* library) {
  RTid& id = classes_[name];
  if (!id) id = rtNewShaderClass(name, library);
  return id;
}

// Finds a paint for each draw: one with the same material, else one that the frame does not use,
// whose parameters are set, else a new one.
void Scene::useMaterials(const Frame& frame, const LightSet& lights) {
  std::unordered_multimap<size_t, size_t> known;
  for (size_t i = 0; i < paints_.size(); i++) known.emplace(paints_[i].material.hash(), i);
  const size_t none = SIZE_MAX;
  paintOf_.assign(frame.draws.size(), none);
  for (size_t i = 0; i < frame.draws.size(); i++) {
    const Material& material = frame.draws[i].material;
    const auto [first, last] = known.equal_range(material.hash());
    for (auto k = first; k != last && paintOf_[i] == none; ++k)
      if (paints_[k->second].material == material) paintOf_[i] = k->second;
    if (paintOf_[i] != none) paints_[paintOf_[i]].lastFrame = frame_;
  }
  size_t unused = 0;
  std::unordered_map<size_t, std::vector<size_t>> fresh; // paints that got a material just now
  for (size_t i = 0; i < frame.draws.size(); i++) {
    if (paintOf_[i] != none) continue;
    const Material& material = frame.draws[i].material;
    std::vector<size_t>& same = fresh[material.hash()];
    for (size_t k : same)
      if (paints_[k].material == material) paintOf_[i] = k;
    if (paintOf_[i] != none) continue;
    while (unused < paints_.size() && paints_[unused].lastFrame == frame_) unused++;
    if (unused == paints_.size()) paints_.emplace_back();
    paints_[unused].lastFrame = frame_;
    paintOf_[i] = unused;
    same.push_back(unused);
    setMaterial(paints_[unused], material, lights);
  }
  for (Paint& paint : paints_) // materials depend on ambient light and on specular colours
    if (paint.lastFrame == frame_ &&
        (paint.ambient != lights.ambient || paint.specularShare != lights.specularShare))
      setMaterial(paint, paint.material, lights);
}

void Scene::setMaterial(Paint& paint, const Material& material, const LightSet& lights) {
  const int kind = linear() && material.lit && !material.replace ? physicalKind : openGlKind;
  if (!paint.shader || paint.kind != kind) {
    if (paint.shader) rtDeleteShader(paint.shader);
    for (auto& [hash, shape] : shapes_)
      for (Instance& instance : shape.instances)
        if (instance.shader == paint.shader) instance.shader = 0; // its override has ended
    paint.shader =
        rtNewShader(kind == openGlKind ? classOf("X3DMaterial") : classOf("Physical", "physical"));
  }
  paint.kind = kind;
  paint.material = material;
  paint.ambient = lights.ambient;
  paint.specularShare = lights.specularShare;
  rtBindShader(paint.shader);
  if (kind == openGlKind)
    setOpenGlMaterial(material, lights);
  else
    setLinearMaterial(material);
  rtBindShader(0);
}

// Sets the parameters so that the lighting equation of VRML97 gives that of OpenGL 1.1 (section
// 2.13.1). The ambient terms of all lights are part of what the surface emits; only where vertices
// have ambient colours, they are reflected (ambientIntensity).
void Scene::setOpenGlMaterial(const Material& m, const LightSet& lights) {
  const bool own = !m.lit && m.colored && !m.replace; // shows the colours of its vertices
  for (size_t side = 0; side < 2; side++) {
    const Material::Side& s = m.sides[side];
    std::array<float, 3> diffuse, emissive, specular;
    for (size_t c = 0; c < 3; c++) {
      const float ambient = m.tracksAmbient ? 0 : s.ambient[c] * lights.ambient[c];
      diffuse[c] = m.replace ? 0 : s.diffuse[c];
      emissive[c] = m.replace ? 1 : s.emission[c] + ambient;
      if (linear()) emissive[c] = decoded(emissive[c]);
      specular[c] = m.replace ? 0 : s.specular[c] * lights.specularShare[c];
    }
    const bool back = side == 1;
    set(back ? "backDiffuseColor" : "diffuseColor", diffuse);
    set(back ? "backEmissiveColor" : "emissiveColor", emissive);
    set(back ? "backSpecularColor" : "specularColor", specular);
    set(back ? "backAmbientIntensity" : "ambientIntensity", m.tracksAmbient ? 1.0f : 0.0f);
    set(back ? "backShininess" : "shininess", s.shininess / 128);
    set(back ? "backTransparency" : "transparency", 1 - s.alpha);
    setTexture(back ? "backEmissiveTexture" : "emissiveTexture", m.texture);
    setTexture(back ? "backSpecularTexture" : "specularTexture", m.texture);
  }
  set("lit", own ? 0 : 1);
  set("twoSided", m.twoSide);
  set("vertexAlpha", m.vertexAlpha);
  set("alphaMode", m.blend ? 2 : m.alphaTest ? 1 : 0);
  set("alphaCutoff", std::max(m.alphaReference, 1.0f / 512));
  setTexture("texture", m.texture);
  const float modulate[4] = {0, 0, 0, 0};
  rtParameterfv(rtParameterHandle("layers"), 4, modulate);
  setTextureTransform(m.textureTransform);
}

void Scene::setLinearMaterial(const Material& m) {
  const Material::Side& s = m.sides[0];
  std::array<float, 3> base, emission;
  for (size_t c = 0; c < 3; c++) {
    base[c] = m.colored ? 1 : decoded(std::clamp(s.diffuse[c], 0.0f, 1.0f));
    emission[c] = decoded(std::max(s.emission[c], 0.0f));
  }
  // The GGX distribution that is about as wide as a highlight of Blinn and Phong has
  // alpha^2 = 2 / (exponent + 2) (B. Walter et al., "Microfacet Models for Refraction through Rough
  // Surfaces", EGSR 2007). The roughness is the root of alpha. High exponents mean a polish.
  const bool shiny = std::max({s.specular[0], s.specular[1], s.specular[2]}) > 0.02f;
  const float roughness = s.shininess >= 100 ? 0.0f : std::pow(2 / (s.shininess + 2), 0.25f);
  set("baseColor", base);
  set("emissiveColor", emission);
  set("metallic", 0.0f);
  set("roughness", shiny ? std::min(roughness, 1.0f) : 1.0f);
  set("transparency", 1 - s.alpha);
  set("alphaMode", m.blend ? 2 : m.alphaTest ? 1 : 0);
  set("alphaCutoff", std::clamp(m.alphaReference, 1.0f / 512, 1.0f));
  set("vertexAlpha", m.vertexAlpha);
  setTexture("texture", m.texture);
  setTextureTransform(m.textureTransform);
}

Scene::Shape& Scene::shapeOf(const Draw& draw) {
  const size_t hash = hashOfParts(draw.parts);
  const auto [first, last] = shapes_.equal_range(hash);
  for (auto k = first; k != last; ++k)
    if (k->second.parts == draw.parts) return k->second;
  const RTid object = rtBeginObject(0);
  for (const Part& part : draw.parts) define(part, linear());
  rtEndObject();
  return shapes_.emplace(hash, Shape{object, draw.parts, {}, 0, 0})->second;
}

void Scene::place(Shape& shape, const Draw& draw, RTid shader) {
  if (shape.used == shape.instances.size()) {
    rtPushMatrix();
    rtLoadMatrixd(draw.matrix.data());
    const RTid id = rtInstantiateObject(shape.object);
    rtPopMatrix();
    rtInstanceHint(id, RT_DYNAMIC);
    shape.instances.push_back({id, 0, draw.matrix, true});
  }
  Instance& instance = shape.instances[shape.used++];
  if (instance.matrix != draw.matrix) rtInstanceMatrix(instance.id, draw.matrix.data());
  if (instance.shader != shader) rtInstanceShader(instance.id, shader);
  if (!instance.visible) rtInstanceVisible(instance.id, 1);
  instance = {instance.id, shader, draw.matrix, true};
}

void Scene::useShapes(const Frame& frame) {
  for (size_t i = 0; i < frame.draws.size(); i++) {
    Shape& shape = shapeOf(frame.draws[i]);
    shape.lastFrame = frame_;
    place(shape, frame.draws[i], paints_[paintOf_[i]].shader);
  }
  for (auto k = shapes_.begin(); k != shapes_.end();) {
    Shape& shape = k->second;
    for (size_t i = shape.used; i < shape.instances.size(); i++)
      if (std::exchange(shape.instances[i].visible, false))
        rtInstanceVisible(shape.instances[i].id, 0);
    shape.used = 0;
    if (frame_ - shape.lastFrame <= framesKept) {
      ++k;
      continue;
    }
    rtDeleteObject(shape.object);
    k = shapes_.erase(k);
  }
}

// Forgets everything whose colours depend on how light is computed.
void Scene::forget() {
  for (const auto& [hash, shape] : shapes_) rtDeleteObject(shape.object);
  shapes_.clear();
  for (const Paint& paint : paints_) rtDeleteShader(paint.shader);
  paints_.clear();
  for (Lamp& lamp : lamps_) lamp.light = Light();
}

bool Scene::show(const Frame& frame) {
  if (frame.width <= 0 || frame.height <= 0) return false;
  const int wanted = lightMode < 0 ? lightOfEnvironment() : lightMode;
  if (std::exchange(shownLight_, wanted) != wanted) forget();
  frame_++;
  const LightSet lights = frame.lights.value_or(LightSet());
  useMaterials(frame, lights);
  useShapes(frame);
  useLights(lights);
  useEnvironment(frame, lights);
  useCamera(frame);
  rtFrameBuffer(frame.width, frame.height, RT_RGBA);
  rtQuality(RT_SHADOWS, wanted != RTGL_OPENGL);
  film_.restart(frame.width, frame.height, linear(), frame.overlay);
  return render(samples);
}

int Scene::refine() { return film_.samples > 0 && render(samples) ? film_.samples : 0; }

bool Scene::render(int count) {
  rtQuality(RT_SAMPLES_PER_PIXEL, count);
  rtQuality(RT_SEED, film_.samples);
  rtQuality(RT_JITTER, film_.samples > 0);
  rtRender();
  std::vector<float> rgba(size_t(4) * static_cast<size_t>(film_.width) *
                          static_cast<size_t>(film_.height));
  rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
  RTstats stats{};
  stats.size = sizeof(stats);
  rtGetStats(&stats);
  if (stats.frame == renderedFrame_) return false; // rtGetError tells the reason
  renderedFrame_ = stats.frame;
  film_.add(rgba, count);
  return true;
}

} // namespace rtgl
