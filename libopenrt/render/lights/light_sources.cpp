#include "render/lights/light_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/surface/points.h"
#include "render/surface/scatter.h"

namespace openrt {
namespace {

// Samples a direction in a cone about an axis uniformly by solid angle.
void sampleCone(const float axis[3], double cosine, float u, float v, float out[3]) {
  const double z = 1 - (1 - cosine) * u, round = std::sqrt(std::max(0.0, 1 - z * z)),
               phi = 2 * M_PI * v;
  float s[3], t[3];
  basisOf(axis, s, t);
  for (int k = 0; k < 3; k++)
    out[k] = float(round * std::cos(phi) * s[k] + round * std::sin(phi) * t[k] + z * axis[k]);
}

// Transforms a light's extent into render space. Returns false if the light has no usable extent.
bool extentOf(const RenderScene& scene, const LightSlot& light, RtsExtent& out) {
  const RtsClass& c = *light.shader.shaderClass;
  RtsExtent local{};
  if (!c.extent || !c.extent(&scene.host, light.shader.params, &local)) return false;
  out = local;
  const auto& m = light.fromLocal.r;
  double length = 0;
  for (int k = 0; k < 3; k++) {
    out.position[k] = m[k][0] * local.position[0] + m[k][1] * local.position[1] +
                      m[k][2] * local.position[2] + m[k][3];
    out.direction[k] =
        m[k][0] * local.direction[0] + m[k][1] * local.direction[1] + m[k][2] * local.direction[2];
    length += double(out.direction[k]) * out.direction[k];
  }
  if (!(length > 0) && local.parallel) return false;
  for (float& x : out.direction) x = length > 0 ? float(x / std::sqrt(length)) : 0.0f;
  return local.power > 0 && std::isfinite(local.power);
}

// Returns whether the same records are specular in two scenes that have the same records.
bool sameSpecularSurfaces(const RenderScene& a, const RenderScene& b) {
  // extends() says that the traits are the same
  return a.shaders == b.shaders || a.shaders->extends(*b.shaders);
}

} // namespace

void LightSources::boundSpecularSurfaces(const RenderScene& scene) {
  double low[3], high[3];
  std::fill_n(low, 3, std::numeric_limits<double>::infinity());
  std::fill_n(high, 3, -std::numeric_limits<double>::infinity());
  const auto add = [&](const float p[3]) {
    for (int k = 0; k < 3; k++) {
      low[k] = std::min(low[k], double(p[k]));
      high[k] = std::max(high[k], double(p[k]));
    }
  };
  for (const Record& r : scene.records) {
    if (!((*scene.shaders)[r.shader].traits & RTS_SPECULAR)) continue;
    if (r.primitive == edit::Primitive::Sphere) {
      for (const float sign : {-1.0f, 1.0f}) {
        float p[3];
        for (int k = 0; k < 3; k++) {
          const auto& m = r.toRender.r[k];
          p[k] = m[3] + sign * std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        }
        add(p);
      }
    } else if (r.primitive == edit::Primitive::Triangles && r.vertices) {
      for (uint32_t t = 0; t < r.primitives; t++) {
        float corner[3][3];
        cornersOf(r, t, corner);
        for (const auto& p : corner) add(p);
      }
    }
  }
  double square = 0;
  for (int k = 0; k < 3; k++) {
    if (!(low[k] <= high[k])) return;
    centre_[k] = float((low[k] + high[k]) / 2);
    square += (high[k] - low[k]) * (high[k] - low[k]) / 4;
  }
  radius_ = float(std::sqrt(square) * (1 + 1e-5));
}

void LightSources::measureSceneExtent(const RenderScene& scene) {
  float sceneLow[3], sceneHigh[3];
  scene.kernel->bounds(sceneLow, sceneHigh);
  double diagonal = 0;
  for (int k = 0; k < 3; k++) diagonal += std::pow(double(sceneHigh[k]) - sceneLow[k], 2);
  far_ = float(std::sqrt(diagonal)) + radius_;
}

LightSources::LightSources(const RenderScene& scene, const RenderScene* before) {
  if (before && before->lightSources && sameSpecularSurfaces(scene, *before)) {
    std::copy_n(before->lightSources->centre_, 3, centre_);
    radius_ = before->lightSources->radius_;
  } else
    boundSpecularSurfaces(scene);
  if (!(radius_ > 0)) return;
  measureSceneExtent(scene);
  if (!std::isfinite(far_)) return;
  double total = 0;
  const auto add = [&](const Source& source, double power) {
    if (!(power > 0)) return;
    sources_.push_back(source);
    cumulative_.push_back(total += power);
  };
  const EmissiveShapes* shapes = scene.emitters.shapes();
  for (uint32_t i = 0; shapes && i < shapes->size(); i++)
    add({none, i, {}}, (*shapes)[i].power * M_PI);
  for (uint32_t i = 0; i < scene.lights.size(); i++) {
    // Without shadows a light shines straight through glass, so its light paths would count twice.
    if (!scene.frame.shadows || (scene.lights[i].shader.traits & RTS_NO_SHADOW)) continue;
    Source source{i, none, {}};
    if (extentOf(scene, scene.lights[i], source.extent))
      add(source, source.extent.power * (source.extent.parallel ? M_PI * radius_ * radius_ : 1.0));
  }
}

// Returns the cosine of the half angle of the cone about the specular surfaces as seen from a
// point; -1 from inside their bounding sphere.
double LightSources::coneToSpecular(const float from[3], float axis[3]) const {
  double square = 0;
  for (int k = 0; k < 3; k++) square += std::pow(double(centre_[k]) - from[k], 2);
  const double distance = std::sqrt(square);
  for (int k = 0; k < 3; k++)
    axis[k] = distance > 0 ? float((centre_[k] - from[k]) / distance) : k == 2 ? 1.0f : 0.0f;
  const double sine = radius_ / distance;
  return sine < 1 ? std::sqrt(1 - sine * sine) : -1;
}

LightSources::LightRay LightSources::sampleRay(const RenderScene& scene, double pick,
                                               const float place[2],
                                               const float direction[2]) const {
  const double at = pick * cumulative_.back();
  const size_t i = size_t(
      std::min(std::upper_bound(cumulative_.begin(), cumulative_.end(), at) - cumulative_.begin(),
               ptrdiff_t(cumulative_.size()) - 1));
  const Source& source = sources_[i];
  const double probability = (cumulative_[i] - (i ? cumulative_[i - 1] : 0)) / cumulative_.back();
  LightRay start;
  start.light = source.light;
  start.shape = source.shape;
  float axis[3];
  if (source.light != none) {
    const RtsExtent& e = source.extent;
    start.parallel = e.parallel != 0;
    start.endless = !std::isfinite(e.radius);
    if (!start.parallel) {
      const double cosine = coneToSpecular(e.position, axis);
      std::copy_n(e.position, 3, start.origin);
      sampleCone(axis, cosine, direction[0], direction[1], start.direction);
      start.weight = 2 * M_PI * (1 - cosine) / probability;
      return start;
    }
    float s[3], t[3];
    basisOf(e.direction, s, t);
    const float r = radius_ * std::sqrt(place[0]), phi = float(2 * M_PI) * place[1];
    for (int k = 0; k < 3; k++) {
      start.origin[k] =
          centre_[k] + r * (std::cos(phi) * s[k] + std::sin(phi) * t[k]) - far_ * e.direction[k];
      start.direction[k] = e.direction[k];
    }
    start.weight = M_PI * radius_ * radius_ / probability;
    return start;
  }
  const EmissiveShapes& shapes = *scene.emitters.shapes();
  start.place = shapes.place(scene, source.shape, place[0], place[1]);
  std::copy_n(start.place.position, 3, start.origin);
  double cosine = coneToSpecular(start.origin, axis), solidAngle = 2 * M_PI * (1 - cosine);
  sampleCone(axis, cosine, direction[0], direction[1], start.direction);
  const float towards = dot3(start.place.normal, start.direction);
  if (!(shapes[source.shape].sides & (towards > 0 ? 1 : 2)) || towards == 0) return start;
  start.weight = start.place.area * std::fabs(towards) * solidAngle / probability;
  // Offsets the origin off the surface, to the side that the direction leads to. The position is a
  // sum of about three products, each rounded.
  float n[3], origin[3], bound = 0;
  for (int k = 0; k < 3; k++) {
    n[k] = towards > 0 ? start.place.normal[k] : -start.place.normal[k];
    bound += std::fabs(n[k]) * std::fabs(start.origin[k]);
  }
  offsetPoint(start.origin, n, bound * 8 * 0x1p-24f, origin);
  std::copy_n(origin, 3, start.origin);
  return start;
}

} // namespace openrt
