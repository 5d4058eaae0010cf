#include "render/lights/emitters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lights/emissive_surfaces.h"
#include "render/lights/spherical.h"
#include "render/render_scene.h"
#include "render/wave/points.h"
#include "scene/transports.h"

namespace openrt {
namespace {

bool sameEmission(const RenderScene& a, const RenderScene& b) {
  if (a.shaders == b.shaders) return true;
  if (!a.shaders->extends(*b.shaders)) return false;
  for (const Record& r : a.records) { // the parameter block of an unchanged shader stays the same
    const ShaderSlot &now = (*a.shaders)[r.shader], &then = (*b.shaders)[r.shader];
    if (((now.traits | then.traits) & RTS_EMISSIVE) && now.params != then.params) return false;
  }
  return true;
}

} // namespace

const SkySampler& Emitters::tabulateSky(const RenderScene& scene, const RenderScene* before) {
  const ShaderSlot& environment = scene.environment.shader;
  if (!sky_ && before && before->textures == scene.textures && before->emitters->sky_ &&
      before->environment.shader.params == environment.params &&
      before->environment.shader.shaderClass == environment.shaderClass)
    sky_ = before->emitters->sky_;
  if (!sky_) sky_ = std::make_shared<const SkySampler>(scene);
  return *sky_;
}

void Emitters::build(const RenderScene& scene, const RenderScene* before, bool samePlaces) {
  if (!tracesPaths(scene.frame.transport)) return;
  scene_ = &scene;
  tabulateSky(scene, before);
  const bool sameTextures = before && before->textures == scene.textures;
  if (sameTextures && samePlaces && before->emitters->shapes_ && sameEmission(scene, *before))
    shapes_ = before->emitters->shapes_;
  else
    shapes_ = std::make_shared<const EmissiveShapes>(scene);
  const Affine& m = scene.environment.toLocal;
  determinant_ = std::fabs(dot(m.row(0), cross(m.row(1), m.row(2))));
  const bool sky = sky_->usable() && determinant_ > 0 && std::isfinite(determinant_);
  skyIrradiance_ = sky ? float(std::clamp(sky_->irradiance(), 1e-30, 1e30)) : 0;
}

float Emitters::skyShare(const LightSampleContext& from) const {
  if (!hasShapes() || !hasSky()) return hasSky() ? 1 : 0;
  float each[LightNode::width], sum = 0;
  importances(shapes_->tree().root(), LightReceiver(from.position, from.normal, ReceiverSide::only),
              each);
  for (const float importance : each) sum += importance;
  return skyShareOf(skyIrradiance_, sum);
}

// Jacobian of directions: solid angle in render space over that in the environment's space. A
// linear map M scales solid angle by |det M| / |M d|^3.
float Emitters::skyJacobian(const Vec3f& local) const {
  const Vec3d towards = scene_->environment.fromLocal.direction(Vec3d(local));
  const double square = dot(towards, towards);
  return float(square * std::sqrt(square) * determinant_);
}

// Samples a direction to a point on the shape. Returns its pdf as if the shape were the only one;
// 0: no sample.
double Emitters::sampleShape(const EmissiveShapes::Shape& shape, const LightSampleContext& from,
                             double u, double v, Vec3d& direction, double& distance) const {
  if (shape.sphere) {
    const Record& r = scene_->records[shape.record];
    const SphericalEllipsoid seen(r.frames->fromRender, r.frames->toRender, from.position);
    if (!(shape.sides & 1) || !seen.sample(u, v, direction, distance)) return 0;
    return seen.pdf(direction);
  }
  if (shape.surface)
    return pdfOfPlace(sampledPlace(scene_->records[shape.record], u, v), shape.sides, from.position,
                      direction, distance);
  const SphericalTriangle seen(shape.corner, from.position);
  if (!(shape.sides & (seen.front() ? 1 : 2)) || !seen.sample(u, v, direction, distance)) return 0;
  return seen.pdf(direction);
}

// share: selection probability of the sky.
LightSample Emitters::chooseSky(double share, float u, float v) const {
  LightSample lightSample;
  Vec3f local;
  lightSample.distance = std::numeric_limits<float>::infinity();
  lightSample.pdf = float(share * sky_->sample(u, v, local));
  if (!(lightSample.pdf > 0)) return {};
  lightSample.pdf /= skyJacobian(local);
  const Vec3d towards = scene_->environment.fromLocal.direction(Vec3d(local));
  lightSample.direction = Vec3f(towards / length(towards));
  return lightSample;
}

// Samples a direction towards a shape that was selected with the given probability, among
// everything that emits.
LightSample Emitters::sampleChosen(const LightSampleContext& from, uint32_t number,
                                   double probability, float u, float v) const {
  const EmissiveShapes::Shape& shape = (*shapes_)[number];
  LightSample lightSample;
  lightSample.shape = number;
  Vec3d towards;
  double distance = 0;
  const double alone = sampleShape(shape, from, u, v, towards, distance);
  if (!(alone > 0)) return {};
  lightSample.pdf = float(probability * alone);
  lightSample.distance = float(distance);
  lightSample.direction = Vec3f(towards);
  return lightSample;
}

namespace {

// Returns the sample if it is valid and its light counts, else none.
LightSample checked(const LightSample& lightSample, const LightSampleContext& from) {
  const bool valid = lightSample.pdf > 0 && std::isfinite(lightSample.pdf) &&
                     (from.normal == Vec3f() || dot(lightSample.direction, from.normal) > 0);
  return valid ? lightSample : LightSample{};
}

LightSampleContext contextOf(const LightPoints& points, uint32_t i) {
  const Vec3f n = load(points.normal, i);
  return {offsetPoint(load(points.position, i), n, points.error[i]),
          points.twoSided && points.twoSided[i] ? Vec3f() : n};
}

void store(const LightSample& lightSample, const SampledLights& to, uint32_t i) {
  store(lightSample.direction, to.direction, i);
  to.distance[i] = lightSample.distance;
  to.end[i] = -1;
  to.pdf[i] = lightSample.pdf;
  to.shape[i] = lightSample.shape;
}

} // namespace

bool Emitters::sampleMost(const LightPoints& points, const float* fine, Arena& arena,
                          const SampledLights& out) const {
  if (!hasShapes()) {
    for (uint32_t i = 0; i < points.count; i++) {
      const bool wanted = points.wanted[i] > 0;
      out.left[i] = wanted ? SampledLights::sky : 0;
      out.pdf[i] = wanted ? 1 : 0;
    }
    return true;
  }
  const LightTree& tree = shapes_->tree();
  if (tree.hasOneNode())
    return sampleFromRoot(tree.root(), shapes_->arrays(), points, skyIrradiance_, out);
  ArenaScope scope(arena);
  const uint32_t size = padded(points.count);
  const ChosenLights chosen{arena.take<float>(size), arena.take<uint32_t>(size),
                            arena.take<float>(size)};
  chooseFromRoot(tree.root(), points, skyIrradiance_, chosen);
  std::fill_n(chosen.probability, size, 0.0f);
  for (uint32_t i = 0; i < points.count; i++) {
    const double share = chosen.skyShare[i];
    if (!(points.wanted[i] > 0) || points.pick[i] < chosen.skyShare[i]) continue;
    const LightSampleContext from = contextOf(points, i);
    const double all = double(points.pick[i]) + double(fine[i]) * 0x1p-24;
    const double rest = share < 1 ? std::clamp((all - share) / (1 - share), 0.0, 1 - 0x1p-53) : 0;
    const LightTree::Choice choice = tree.choose(from.position, from.normal, rest);
    chosen.shape[i] = choice.light;
    chosen.probability[i] = choice.probability;
  }
  return sampleShapes(shapes_->arrays(), points, chosen, out);
}

void Emitters::choose(const LightPoints& points, const float* fine, Arena& arena,
                      const SampledLights& out) const {
  if (!sampleMost(points, fine, arena, out)) return;
  for (uint32_t i = 0; i < points.count; i++) {
    if (!out.left[i]) continue;
    const LightSampleContext from = contextOf(points, i);
    const float probability = out.pdf[i], u = points.u[i], v = points.v[i];
    const LightSample lightSample = out.left[i] == SampledLights::sky
                                        ? chooseSky(probability, u, v)
                                        : sampleChosen(from, out.shape[i], probability, u, v);
    store(checked(lightSample, from), out, i);
  }
}

float Emitters::pdfOf(const LightSampleContext& from, uint32_t number,
                      const Vec3f& direction) const {
  const EmissiveShapes::Shape& shape = (*shapes_)[number];
  if (!hasShapes() || !shape.sides) return 0;
  const Vec3d towards(direction);
  double alone = 0;
  if (shape.sphere) {
    const Record& r = scene_->records[shape.record];
    const SphericalEllipsoid seen(r.frames->fromRender, r.frames->toRender, from.position);
    if (shape.sides & 1) alone = seen.pdf(towards);
  } else if (shape.surface) {
    alone = pdfAlong(scene_->records[shape.record], shape.sides, from.position, towards);
  } else {
    const SphericalTriangle seen(shape.corner, from.position);
    if (shape.sides & (seen.front() ? 1 : 2)) alone = seen.pdf(towards);
  }
  if (!(alone > 0)) return 0;
  return float((1 - double(skyShare(from))) *
               double(shapes_->tree().probability(from.position, from.normal, number)) * alone);
}

void Emitters::pdf(const FoundShapes& found, float* out) const {
  const bool oneNode = hasShapes() && shapes_->tree().hasOneNode();
  if (oneNode) pdfFromRoot(shapes_->tree().root(), shapes_->arrays(), found, skyIrradiance_, out);
  for (uint32_t i = 0; i < found.count; i++)
    if (!oneNode || out[i] < 0)
      out[i] = pdfOf({load(found.position, i), load(found.normal, i)}, found.shape[i],
                     load(found.direction, i));
}

float Emitters::skyPdf(const LightSampleContext& from, const Vec3f& local) const {
  return hasSky() ? skyShare(from) * sky_->pdf(local) / skyJacobian(local) : 0.0f;
}

bool Emitters::hasSun() const { return hasSky() && sky_->hasSun(); }

double Emitters::sampleSun(double pick, float u, float v, Vec3f& direction) const {
  Vec3f local;
  const double pdf =
      sky_->sampleSun(pick, double(u), double(v), local) / double(skyJacobian(local));
  const Vec3d towards = scene_->environment.fromLocal.direction(Vec3d(local));
  direction = Vec3f(towards / length(towards));
  return pdf > 0 && std::isfinite(pdf) && isFinite(direction) ? pdf : 0;
}

double Emitters::brightestSky() const { return hasSky() ? sky_->brightest() : 0; }
double Emitters::brightestShape() const { return hasShapes() ? shapes_->brightest() : 0; }

bool Emitters::startsLightPaths(uint32_t record, uint32_t primitive, const Vec3f& direction) const {
  const uint32_t number = shapes_ ? shapes_->find(record, primitive) : EmissiveShapes::none;
  if (number == EmissiveShapes::none) return false;
  const EmissiveShapes::Shape& s = (*shapes_)[number];
  if (s.curved() || !(s.power > 0)) return s.power > 0;
  const Vec3d n =
      cross(Vec3d(s.corner[1]) - Vec3d(s.corner[0]), Vec3d(s.corner[2]) - Vec3d(s.corner[0]));
  return s.sides & (dot(n, Vec3d(direction)) < 0 ? 1 : 2);
}

} // namespace openrt
