#include "render/lights/light_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lights/emitters.h"
#include "render/orthonormal_basis.h"
#include "render/wave/points.h"
#include "scene/analytic.h"

namespace openrt {
namespace {

// A light is far outside of the scene beyond this multiple of the distance that contains it.
constexpr double farLight = 100;

// Samples a direction in a cone about an axis uniformly by solid angle.
Vec3f sampleCone(const Vec3f& axis, double cosine, float u, float v) {
  const double z = 1 - (1 - cosine) * u, round = std::sqrt(std::max(0.0, 1 - z * z)),
               phi = 2 * M_PI * v;
  Vec3f s, t;
  basisOf(axis, s, t);
  return Vec3f(round * std::cos(phi) * Vec3d(s) + round * std::sin(phi) * Vec3d(t) +
               z * Vec3d(axis));
}

// Transforms a light's extent into render space. Returns false if the light has no usable extent.
bool extentOf(const RenderScene& scene, const LightSlot& light, RtsExtent& out) {
  const RtsClass& c = *light.shader.shaderClass;
  RtsExtent local{};
  if (!c.extent || !c.extent(&scene.host, light.shader.params, &local)) return false;
  out = local;
  const Vec3d direction(light.fromLocal.direction(vectorOf(local.direction)));
  if (!(length(direction) > 0) && local.parallel) return false;
  store(light.fromLocal.point(vectorOf(local.position)), out.position);
  store(Vec3f(normalize(direction)), out.direction);
  return local.power > 0 && std::isfinite(local.power);
}

// Returns whether the same records are specular in two scenes that have the same records.
bool sameSpecularSurfaces(const RenderScene& a, const RenderScene& b) {
  // extends() says that the traits are the same
  return a.shaders == b.shaders || a.shaders->extends(*b.shaders);
}

} // namespace

// Lines and points are no targets of glossy paths, because boundTargets() does not bound them.
bool LightSources::isTarget(const RenderScene& scene, const Record& record, Kind kind) {
  const uint32_t traits = (*scene.shaders)[record.shader].traits;
  if (kind != Kind::glossy) return traits & RTS_SPECULAR;
  return (traits & RTS_GLOSSY) && !isThin(record.primitive);
}

void LightSources::boundTargets(const RenderScene& scene) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Vec3d low{infinite, infinite, infinite}, high = -low;
  const auto add = [&](const Vec3f& p) {
    low = min(low, Vec3d(p));
    high = max(high, Vec3d(p));
  };
  for (const Record& r : scene.records) {
    if (!isTarget(scene, r, kind_)) continue;
    if (r.primitive == edit::Primitive::Sphere) {
      const Affine& m = r.frames->toRender;
      const Vec3f half{length(m.row(0)), length(m.row(1)), length(m.row(2))};
      add(m.translation() - half);
      add(m.translation() + half);
    } else if (r.surface) {
      for (size_t corner = 0; corner < 8; corner++) {
        Vec3d p;
        for (size_t k = 0; k < 3; k++)
          p[k] = corner >> k & 1 ? r.surface->high()[k] : r.surface->low()[k];
        add(r.frames->toRender.point(Vec3f(p)));
      }
    } else if (r.primitive == edit::Primitive::Triangles && r.vertices) {
      for (uint32_t t = 0; t < r.primitives; t++)
        for (const Vec3f& p : r.cornersOf(t)) add(p);
    }
  }
  if (!(low.x <= high.x) || !(low.y <= high.y) || !(low.z <= high.z)) return;
  center_ = Vec3f((low + high) / 2);
  radius_ = float(length(high - low) / 2 * (1 + 1e-5));
}

void LightSources::measureSceneExtent(const RenderScene& scene) {
  float low[3], high[3];
  scene.kernel->bounds(low, high);
  far_ = float(length(Vec3d(vectorOf(high)) - Vec3d(vectorOf(low)))) + radius_;
}

LightSources::LightSources(const RenderScene& scene, const RenderScene* before, Kind kind)
    : kind_(kind) {
  if (kind != Kind::glossy && before && before->lightSources &&
      sameSpecularSurfaces(scene, *before)) {
    center_ = before->lightSources->center_;
    radius_ = before->lightSources->radius_;
  } else
    boundTargets(scene);
  if (!(radius_ > 0)) return;
  measureSceneExtent(scene);
  if (!std::isfinite(far_)) return;
  if (kind == Kind::glossy) {
    addGlossySources(scene);
    return;
  }
  double total = 0;
  const auto add = [&](const Source& source, double power) {
    if (!(power > 0)) return;
    sources_.push_back(source);
    cumulative_.push_back(total += power);
  };
  const EmissiveShapes* shapes = scene.emitters->shapes();
  for (uint32_t i = 0; shapes && i < shapes->size(); i++)
    add({none, i, {}}, (*shapes)[i].power * M_PI);
  if (scene.emitters->hasSun())
    add({none, none, {}}, scene.emitters->sky()->sunIrradiance() * M_PI * radius_ * radius_);
  if (kind == Kind::emitters) return;
  for (uint32_t i = 0; i < scene.lights.size(); i++) {
    // Without shadows a light shines straight through glass, so its light paths would count twice.
    if (!scene.frame.shadows || (scene.lights[i].shader.traits & RTS_NO_SHADOW)) continue;
    Source source{i, none, {}};
    if (extentOf(scene, scene.lights[i], source.extent))
      add(source, source.extent.power * (source.extent.parallel ? M_PI * radius_ * radius_ : 1.0));
  }
}

// Adds the emissive shapes that surely are where light samples find them.
void LightSources::addGlossySources(const RenderScene& scene) {
  const EmissiveShapes* shapes = scene.emitters->shapes();
  if (!shapes) return;
  placePdf_.assign(shapes->size(), 0);
  oneSided_.assign(shapes->size(), false);
  double total = 0;
  for (uint32_t i = 0; i < shapes->size(); i++) {
    const EmissiveShapes::Shape& shape = (*shapes)[i];
    if (!(shape.power > 0) || shape.uncertain) continue;
    const double area = shapes->place(scene, i, .5f, .5f).area;
    if (!(area > 0) || !std::isfinite(area)) continue;
    sources_.push_back({none, i, {}});
    cumulative_.push_back(total += double(shape.power));
    placePdf_[i] = double(shape.power) / area;
    oneSided_[i] = shape.sides != 3;
  }
  for (double& pdf : placePdf_) pdf /= total;
}

// Returns the pdf of a place on a shape, by area.
double LightSources::placePdf(const RenderScene& scene, uint32_t shape) const {
  if (kind_ == Kind::glossy) return placePdf_[shape];
  const EmissiveShapes& shapes = *scene.emitters->shapes();
  const double area = shapes.place(scene, shape, .5f, .5f).area,
               pdf = shapes[shape].power * M_PI / cumulative_.back() / area;
  return area > 0 && std::isfinite(pdf) && !shapes[shape].uncertain
             ? pdf
             : std::numeric_limits<double>::infinity();
}

double LightSources::startPdf(const RenderScene& scene, uint32_t shape, const Vec3f& place) const {
  Vec3f axis;
  const double cosine = coneToTargets(place, axis),
               half = kind_ == Kind::glossy && cosine == -1 && oneSided_[shape] ? .5 : 1;
  return placePdf(scene, shape) / (2 * M_PI * (1 - cosine) * half);
}

// Returns the cosine of the half angle of the cone about the targets as seen from a point; -1 from
// inside their bounding sphere.
double LightSources::coneToTargets(const Vec3f& from, Vec3f& axis) const {
  const double distance = length(Vec3d(center_) - Vec3d(from));
  axis = distance > 0 ? Vec3f(Vec3d(center_ - from) / distance) : Vec3f{0, 0, 1};
  const double sine = radius_ / distance;
  return sine < 1 ? std::sqrt(1 - sine * sine) : -1;
}

// Samples a direction in the cone about the targets for a light far away. Rounded to float, the aim
// would miss them and hits would lie beside the surfaces. So the ray is traced from nearby, where
// the whole scene lies in front of it, and distances are computed from the targets on: no sum
// contains the distance of the light, and 1 - cosine is no difference.
void LightSources::aimFromAfar(const float direction[2], LightRay& start) const {
  const Vec3d way = Vec3d(center_) - Vec3d(start.origin);
  const double distance = length(way), sine = double(radius_) / distance;
  const double cap = sine * sine / (1 + std::sqrt(1 - sine * sine)); // 1 - cosine of the cone
  const double below = cap * direction[0], z = 1 - below;
  const double round = std::sqrt(below * (2 - below));
  const double phi = 2 * M_PI * direction[1];
  const Vec3d axis = way / distance;
  Vec3f s, t;
  basisOf(Vec3f(axis), s, t);
  const Vec3d across = std::cos(phi) * Vec3d(s) + std::sin(phi) * Vec3d(t);
  start.skipped = distance * z - double(far_);
  start.direction = Vec3f(round * across + z * axis);
  start.from = Vec3f(Vec3d(center_) - (distance * round * round + far_ * z) * axis +
                     start.skipped * round * across);
  start.weight = 2 * M_PI * cap;
}

// Returns a point of the disc through which all light of one direction passes that reaches the
// specular surfaces.
Vec3f LightSources::startOfParallel(const Vec3f& towards, const float place[2]) const {
  Vec3f s, t;
  basisOf(towards, s, t);
  const float r = radius_ * std::sqrt(place[0]), phi = float(2 * M_PI) * place[1];
  return center_ + r * (std::cos(phi) * s + std::sin(phi) * t) - far_ * towards;
}

LightSources::LightRay LightSources::sampleRay(const RenderScene& scene, double pick,
                                               const float place[2],
                                               const float direction[2]) const {
  const double at = pick * cumulative_.back();
  const size_t i = size_t(
      std::min(std::upper_bound(cumulative_.begin(), cumulative_.end(), at) - cumulative_.begin(),
               ptrdiff_t(cumulative_.size()) - 1));
  const Source& source = sources_[i];
  const double before = i ? cumulative_[i - 1] : 0, power = cumulative_[i] - before,
               probability = power / cumulative_.back();
  LightRay start;
  start.light = source.light;
  start.shape = source.shape;
  Vec3f axis;
  if (source.light != none) {
    const RtsExtent& e = source.extent;
    start.parallel = e.parallel != 0;
    start.endless = !std::isfinite(e.radius);
    if (!start.parallel) {
      start.origin = start.from = vectorOf(e.position);
      if (length(Vec3d(center_) - Vec3d(start.origin)) > farLight * far_) {
        aimFromAfar(direction, start);
        start.weight /= probability;
        return start;
      }
      const double cosine = coneToTargets(start.origin, axis);
      start.direction = sampleCone(axis, cosine, direction[0], direction[1]);
      start.weight = 2 * M_PI * (1 - cosine) / probability;
      return start;
    }
    start.direction = vectorOf(e.direction);
    start.origin = start.from = startOfParallel(start.direction, place);
    start.weight = M_PI * radius_ * radius_ / probability;
    return start;
  }
  if (source.shape == none) {
    const double rest = std::clamp((at - before) / power, 0.0, 1 - 0x1p-53),
                 pdf = scene.emitters->sampleSun(rest, direction[0], direction[1], axis);
    start.sun = true;
    start.direction = -axis;
    start.origin = start.from = startOfParallel(start.direction, place);
    start.weight = pdf > 0 ? M_PI * radius_ * radius_ / (probability * pdf) : 0;
    return start;
  }
  const EmissiveShapes& shapes = *scene.emitters->shapes();
  start.place = shapes.place(scene, source.shape, place[0], place[1]);
  const Vec3f position = start.place.position, normal = start.place.normal;
  start.origin = position;
  const double cosine = coneToTargets(position, axis);
  double solidAngle = 2 * M_PI * (1 - cosine);
  start.direction = sampleCone(axis, cosine, direction[0], direction[1]);
  float towards = dot(normal, start.direction);
  const auto emits = [&] { return shapes[source.shape].sides & (towards > 0 ? 1 : 2); };
  if (kind_ == Kind::glossy && cosine == -1 && oneSided_[source.shape]) {
    solidAngle /= 2; // all directions are wanted: those of the side that emits
    if (!emits()) {
      start.direction = -start.direction;
      towards = -towards;
    }
  }
  if (!emits() || towards == 0) return start;
  start.weight = start.place.area * std::fabs(towards) * solidAngle / probability;
  // Offsets the origin off the surface, to the side that the direction leads to. The position is a
  // sum of about three products, each rounded.
  const float bound = dot(abs(normal), abs(position)) * 8 * 0x1p-24f;
  start.origin = start.from = offsetPoint(position, towards > 0 ? normal : -normal, bound);
  return start;
}

} // namespace openrt
