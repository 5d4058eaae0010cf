// emissive_shapes.cpp: finds the area lights of a scene. The emission of a shape is measured by
// evaluating its shader at a few points, seen along the normal.
#include "render/lights/emissive_shapes.h"

#include <algorithm>
#include <cmath>

#include "render/lights/emissive_surfaces.h"
#include "render/lights/luminance.h"
#include "render/wave/batch.h"
#include "scene/analytic.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr uint32_t batchSize = 1024;

// Returns the cross product of two edges of a triangle: its normal, twice as long as its area.
Vec3d areaNormalOf(const std::array<Vec3f, 3>& p) {
  return cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0]));
}

// Returns whether the instance's map reverses the orientation of corners. The kernel's normal is
// not reversed with it.
bool mirrors(const Record& r) { return r.instanced && determinantOf(r.frames->toRender) < 0; }

// Probe rays that hit points of a record along given directions, usually the normal.
struct ProbeRays {
  Rays rays;
  RayHits hits;
  uint32_t* order;
  uint32_t count = 0;

  ProbeRays(Arena& arena, uint32_t capacity) {
    rays.allocate(arena, capacity);
    hits.allocate(arena, capacity);
    order = arena.take<uint32_t>(padded(capacity));
  }
  // Adds a probe ray at `place`. `towards` is the unit direction from the point to the ray's
  // origin.
  void add(const Vec3f& place, const Vec3f& towards) {
    store(place + towards, rays.org, count);
    store(-towards, rays.dir, count);
    hits.t[count] = 1;
    order[count] = count;
    count++;
  }
};

// Evaluates the shader at the probed points, towards the probes' origins.
RtsSurface evaluateEmission(const RenderScene& scene, uint32_t record, const ProbeRays& probes,
                            Arena& arena) {
  const Record& r = scene.records[record];
  const uint32_t n = probes.count;
  const auto* travelled = arena.takeZero<float>(padded(n));
  const Points points =
      makePoints(scene, probes.rays, probes.hits, probes.order, n, travelled, arena);
  RtsSurface surface{};
  for (auto& e : surface.emission) e = arena.takeZero<float>(padded(n));
  RayCounters counters;
  RtsBatch batch({scene, arena, counters});
  batch.points = &points;
  const RunningShader running(*(*scene.shaders)[r.shader].shaderClass);
  (*scene.shaders)[r.shader].shaderClass->surface(&scene.host, &batch, &points.hits, &surface);
  return surface;
}

// The radiance that a point or a side emits. The luminance decides how often it is sampled; the sum
// of the colours bounds the light that is missing if no path has found it. radiance: 0 where a
// colour is not finite.
struct Brightness {
  double luminance = 0, sum = 0;
  Vec3d radiance;
  void add(const Brightness& other, double weight) {
    luminance += weight * other.luminance;
    sum += weight * other.sum;
    radiance += weight * other.radiance;
  }
};

// Returns whether the emission of a record is known to be the same at all points of a side and in
// all directions. Traits do not cover parameter values of geometries.
bool emitsUniformly(const RenderScene& scene, const Record& r) {
  return ((*scene.shaders)[r.shader].traits & RTS_UNIFORM_EMISSION) && r.parameterCount == 0;
}

// Computes the emitted radiance of the probed points.
void emittedBrightness(const RenderScene& scene, uint32_t record, const ProbeRays& probes,
                       Arena& arena, Brightness* out) {
  const RtsSurface surface = evaluateEmission(scene, record, probes, arena);
  for (uint32_t i = 0; i < probes.count; i++) {
    const Vec3f c = load(surface.emission, i);
    const double sum = double(c.x) + double(c.y) + double(c.z);
    out[i] = {luminance(c), std::isfinite(sum) && sum > 0 ? std::min(sum, 1e30) : 0, {}};
    for (int k = 0; k < 3; k++) out[i].radiance[k] = std::isfinite(c[k]) ? double(c[k]) : 0;
  }
}

// Computes the mean emission of one side of triangles: from four points where parameters, colours
// or textures may vary, else from one.
void triangleEmission(const RenderScene& scene, uint32_t record,
                      std::span<const EmissiveShapes::Shape> shapes, bool otherSide, Arena& arena,
                      Brightness* out) {
  const Record& r = scene.records[record];
  static constexpr float at[4][2] = {
      {1.0f / 3, 1.0f / 3}, {1.0f / 6, 1.0f / 6}, {2.0f / 3, 1.0f / 6}, {1.0f / 6, 2.0f / 3}};
  const bool mirrored = mirrors(r);
  const bool varies = !emitsUniformly(scene, r) && (r.texCoords || r.colors || r.parameterCount ||
                                                    r.texGen != edit::TexGen::Off);
  const uint32_t places = varies ? 4 : 1;
  ArenaScope scope(arena);
  ProbeRays probes(arena, uint32_t(shapes.size()) * places);
  for (const EmissiveShapes::Shape& s : shapes) {
    const Vec3f normal(normalize(areaNormalOf(s.corner))), kernel = kernelNormal(r, normal);
    for (uint32_t p = 0; p < places; p++) {
      const uint32_t i = probes.count;
      const float u = at[p][0], v = at[p][1];
      store(kernel, probes.hits.ng, i);
      probes.hits.u[i] = mirrored ? v : u;
      probes.hits.v[i] = mirrored ? u : v;
      probes.hits.record[i] = record;
      probes.hits.primitive[i] = s.primitive;
      probes.add((1 - u - v) * s.corner[0] + u * s.corner[1] + v * s.corner[2],
                 otherSide ? -normal : normal);
    }
  }
  auto* each = arena.take<Brightness>(probes.count);
  emittedBrightness(scene, record, probes, arena, each);
  for (uint32_t i = 0; i < probes.count; i++) out[i / places].add(each[i], 1.0 / places);
}

// Computes the mean emission of the outside of a sphere from the six ends of its axes.
Brightness sphereEmission(const RenderScene& scene, uint32_t record, Arena& arena) {
  const Record& r = scene.records[record];
  ArenaScope scope(arena);
  ProbeRays probes(arena, 6);
  for (int axis = 0; axis < 3; axis++)
    for (const float sign : {1.0f, -1.0f}) {
      const Vec3f normal = sign * r.normalMatrix.column(size_t(axis)),
                  towards = normal / length(normal);
      const uint32_t i = probes.count;
      store(towards, probes.hits.ng, i);
      probes.hits.u[i] = probes.hits.v[i] = 0;
      probes.hits.record[i] = record;
      probes.hits.primitive[i] = 0;
      probes.add(r.frames->toRender.translation() + sign * r.frames->toRender.column(axis),
                 towards);
    }
  Brightness each[6], mean;
  emittedBrightness(scene, record, probes, arena, each);
  for (const Brightness& x : each) mean.add(x, 1.0 / 6);
  return mean;
}

// The emission of the two sides of an analytic surface, and its area.
struct SurfaceEmission {
  Brightness front, back;
  double area = 0;
};

// Computes means from 16 points, weighted by the area that each stands for.
SurfaceEmission surfaceEmission(const RenderScene& scene, uint32_t record, Arena& arena) {
  constexpr uint32_t along = 4, around = 4;
  const Record& r = scene.records[record];
  ArenaScope scope(arena);
  SurfaceEmission out;
  for (const bool otherSide : {false, true}) {
    ProbeRays probes(arena, along * around);
    double areas[along * around];
    for (uint32_t i = 0; i < along * around; i++) {
      const SurfacePlace p = sampledPlace(r, (i / around + .5) / along, (i % around + .5) / around);
      if (!(p.area > 0)) continue;
      const uint32_t at = probes.count;
      areas[at] = p.area;
      const Vec3f normal(p.normal);
      store(normal, probes.hits.ng, at);
      probes.hits.u[at] = probes.hits.v[at] = 0;
      probes.hits.record[at] = record;
      probes.hits.primitive[at] = 0;
      probes.add(Vec3f(p.position), otherSide ? -normal : normal);
    }
    if (probes.count == 0) return {};
    Brightness each[along * around];
    emittedBrightness(scene, record, probes, arena, each);
    double all = 0;
    for (uint32_t i = 0; i < probes.count; i++) all += areas[i];
    for (uint32_t i = 0; i < probes.count; i++)
      (otherSide ? out.back : out.front).add(each[i], areas[i] / all);
    out.area = all / (along * around);
  }
  // As for triangles, nobody sees the back of a solid surface.
  if (r.cull) (r.flip ? out.front : out.back) = {};
  return out;
}

// Returns whether the points that emit light samples have one radiance. It is finite, so that light
// from such a shape needs no checks.
bool emitsOneRadiance(const EmissiveShapes::Shape& s) {
  if (!s.uniform || !isFinite(s.radiance[0]) || !isFinite(s.radiance[1])) return false;
  return s.sphere || s.sides != 3 || s.radiance[0] == s.radiance[1];
}

LightBounds triangleBounds(const EmissiveShapes::Shape& s, double front, double back) {
  LightBounds b;
  const Vec3d areaNormal = areaNormalOf(s.corner);
  const double area = length(areaNormal) / 2;
  const Vec3f normal(normalize(areaNormal));
  b.low = min(min(s.corner[0], s.corner[1]), s.corner[2]);
  b.high = max(max(s.corner[0], s.corner[1]), s.corner[2]);
  b.axis = front > 0 ? normal : -normal;
  b.cosineNormals = 1;
  b.bothSides = front > 0 && back > 0;
  const double intensity = std::max(front, back) * area;
  b.intensity = std::isfinite(intensity) ? float(std::min(intensity, 1e30)) : 0;
  return b;
}

LightBounds sphereBounds(const Record& r, double outside) {
  LightBounds b;
  const Affine& m = r.frames->toRender;
  const Vec3d half{length(Vec3d(m.row(0))), length(Vec3d(m.row(1))), length(Vec3d(m.row(2)))};
  b.low = Vec3f(Vec3d(m.translation()) - half);
  b.high = Vec3f(Vec3d(m.translation()) + half);
  const double disc = largest(M_PI * half * half); // about the area of the largest projection
  const double intensity = outside * disc;
  b.intensity = std::isfinite(intensity) ? float(std::min(intensity, 1e30)) : 0;
  return b;
}

LightBounds surfaceBounds(const Record& r, double luminance) {
  LightBounds b;
  const Vec3d &low = r.surface->low(), &high = r.surface->high();
  const Vec3d middle = r.frames->toRender.point((low + high) / 2), half = (high - low) / 2;
  Vec3d reach;
  for (size_t k = 0; k < 3; k++) reach[k] = dot(abs(Vec3d(r.frames->toRender.row(k))), half);
  b.low = Vec3f(middle - reach);
  b.high = Vec3f(middle + reach);
  const double projected = 4 * std::max({reach.x * reach.y, reach.y * reach.z, reach.z * reach.x});
  const double intensity = luminance * projected;
  b.intensity = std::isfinite(intensity) ? float(std::min(intensity, 1e30)) : 0;
  return b;
}

} // namespace

// For an instance that is the normal in the instance's frame, mapped by the transpose of toRender:
// the inverse of the map Record::kernelNormal except for the length.
Vec3f kernelNormal(const Record& r, const Vec3f& normal) {
  return r.instanced ? r.frames->toRender.transposed(normal) : normal;
}

EmissiveShapes::EmissiveShapes(const RenderScene& scene) : firstOf_(scene.records.size(), none) {
  std::vector<LightBounds> bounds;
  for (uint32_t id = 0; id < scene.records.size(); id++) add(scene, id, bounds);
  tree_.build(bounds);
  for (const Shape& shape : shapes_) {
    for (size_t c = 0; c < 3; c++)
      for (size_t k = 0; k < 3; k++) corners_[c][k].push_back(shape.corner[c][k]);
    const bool instanced = scene.records[shape.record].instanced;
    sides_.push_back(shape.sides | (shape.curved() ? ShapeArrays::sphere : 0) |
                     (instanced ? ShapeArrays::instanced : 0) |
                     (emitsOneRadiance(shape) ? ShapeArrays::oneRadiance : 0));
    for (int k = 0; k < 3; k++)
      radiance_[k].push_back(shape.radiance[shape.sides == ShapeArrays::back ? 1 : 0][k]);
  }
  markUncertain(scene);
}

ShapeArrays EmissiveShapes::arrays() const {
  ShapeArrays arrays;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++) arrays.corner[c][k] = corners_[c][k].data();
  arrays.sides = sides_.data();
  for (int k = 0; k < 3; k++) arrays.radiance[k] = radiance_[k].data();
  return arrays;
}

void EmissiveShapes::addSurface(const RenderScene& scene, uint32_t id,
                                std::vector<LightBounds>& bounds) {
  const Record& r = scene.records[id];
  Arena arena;
  const SurfaceEmission emission = surfaceEmission(scene, id, arena);
  const double front = emission.front.luminance, back = emission.back.luminance;
  firstOf_[id] = uint32_t(shapes_.size());
  brightest_ = std::max({brightest_, emission.front.sum, emission.back.sum});
  bounds.push_back(surfaceBounds(r, std::max(front, back)));
  Shape& s = shapes_.emplace_back(Shape{id, 0, 0, false, {}, false, 0});
  s.surface = true;
  if (bounds.back().intensity > 0) s.sides = uint8_t((front > 0 ? 1 : 0) | (back > 0 ? 2 : 0));
  const double power = (front + back) * emission.area;
  s.power = std::isfinite(power) ? float(std::min(power, 1e30)) : 0;
  s.uniform = emitsUniformly(scene, r);
  s.radiance[0] = Vec3f(emission.front.radiance);
  s.radiance[1] = Vec3f(emission.back.radiance);
}

void EmissiveShapes::add(const RenderScene& scene, uint32_t id, std::vector<LightBounds>& bounds) {
  const Record& r = scene.records[id];
  const ShaderSlot& shader = (*scene.shaders)[r.shader];
  if (!(shader.traits & RTS_EMISSIVE) || !shader.shaderClass->surface) return;
  if (r.surface && r.surface->samplable()) return addSurface(scene, id, bounds);
  Arena arena;
  if (r.primitive == edit::Primitive::Sphere) {
    const Brightness emission = sphereEmission(scene, id, arena);
    // light emitted to the inside is found by BSDF sampling
    const double outside = emission.luminance;
    firstOf_[id] = uint32_t(shapes_.size());
    brightest_ = std::max(brightest_, emission.sum);
    bounds.push_back(sphereBounds(r, outside));
    Shape& s = shapes_.emplace_back(
        Shape{id, 0, uint8_t(outside > 0 ? 1 : 0), true, {}, false, 4 * bounds.back().intensity});
    s.uniform = emitsUniformly(scene, r);
    s.radiance[0] = Vec3f(emission.radiance);
    return;
  }
  if (r.primitive != edit::Primitive::Triangles || !r.vertices) return;
  firstOf_[id] = uint32_t(shapes_.size());
  std::vector<Brightness> front, back;
  const bool mirrored = mirrors(r), uniform = emitsUniformly(scene, r);
  for (uint32_t first = 0; first < r.primitives; first += batchSize) {
    const uint32_t n = std::min(batchSize, r.primitives - first);
    const size_t begin = shapes_.size();
    for (uint32_t i = 0; i < n; i++) {
      Shape& s = shapes_.emplace_back(Shape{id, first + i, 0, false, {}, mirrored, 0});
      s.corner = r.cornersOf(s.primitive);
      if (mirrored) std::swap(s.corner[1], s.corner[2]);
    }
    front.assign(n, {});
    back.assign(n, {});
    const std::span<const Shape> shapes(shapes_.data() + begin, n);
    triangleEmission(scene, id, shapes, false, arena, front.data());
    triangleEmission(scene, id, shapes, true, arena, back.data());
    // The culled side does not emit.
    if (r.cull) std::fill_n((r.flip ? front : back).begin(), n, Brightness());
    for (uint32_t i = 0; i < n; i++) {
      Shape& s = shapes_[begin + i];
      const double ahead = front[i].luminance, behind = back[i].luminance;
      brightest_ = std::max({brightest_, front[i].sum, back[i].sum});
      bounds.push_back(triangleBounds(s, ahead, behind));
      if (bounds.back().intensity > 0)
        s.sides = uint8_t((ahead > 0 ? 1 : 0) | (behind > 0 ? 2 : 0));
      s.power = bounds.back().intensity * (s.sides == 3 ? 2.0f : 1.0f);
      s.uniform = uniform;
      s.radiance[0] = Vec3f(front[i].radiance);
      s.radiance[1] = Vec3f(back[i].radiance);
    }
  }
}

EmissiveShapes::Place EmissiveShapes::place(const RenderScene& scene, uint32_t number, float u,
                                            float v) const {
  const Shape& s = shapes_[number];
  Place p{};
  if (s.surface) {
    const SurfacePlace sampled = sampledPlace(scene.records[s.record], u, v);
    p.position = Vec3f(sampled.position);
    p.normal = Vec3f(sampled.normal);
    p.area = sampled.area;
    return p;
  }
  if (!s.sphere) {
    const float root = std::sqrt(u); // uniform on the triangle
    p.u = root * (1 - v);
    p.v = root * v;
    p.position = (1 - p.u - p.v) * s.corner[0] + p.u * s.corner[1] + p.v * s.corner[2];
    const Vec3d areaNormal = areaNormalOf(s.corner);
    p.normal = Vec3f(normalize(areaNormal));
    p.area = length(areaNormal) / 2;
    return p;
  }
  const Record& r = scene.records[s.record];
  const double z = 1 - 2.0 * u, round = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * M_PI * v;
  const Vec3d l{round * std::cos(phi), round * std::sin(phi), z},
      n = r.frames->fromRender.transposed(l);
  p.position = Vec3f(r.frames->toRender.point(l));
  p.normal = Vec3f(n / length(n));
  // An element of area grows by |det M| |M^-T n|.
  p.area = 4 * M_PI * std::fabs(determinantOf(r.frames->toRender)) * length(n);
  return p;
}

Vec3f EmissiveShapes::radiance(const RenderScene& scene, uint32_t number, const Place& place,
                               const Vec3f& towards, Arena& arena) const {
  const Shape& s = shapes_[number];
  if (s.uniform) {
    const float along = dot(place.normal, towards);
    return max(s.radiance[along > 0 ? 0 : 1], Vec3f());
  }
  ArenaScope scope(arena);
  ProbeRays probes(arena, 1);
  store(s.curved() ? place.normal : kernelNormal(scene.records[s.record], place.normal),
        probes.hits.ng, 0);
  probes.hits.u[0] = s.swapped ? place.v : place.u;
  probes.hits.v[0] = s.swapped ? place.u : place.v;
  probes.hits.record[0] = s.record;
  probes.hits.primitive[0] = s.primitive;
  probes.add(place.position, towards);
  const RtsSurface surface = evaluateEmission(scene, s.record, probes, arena);
  Vec3f out = load(surface.emission, 0);
  for (float* colour : {&out.x, &out.y, &out.z})
    if (!(*colour > 0) || !std::isfinite(*colour)) *colour = 0;
  return out;
}

} // namespace openrt
