// emitters.cpp: see emitters.h.
#include "render/emitters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/batch.h"
#include "render/scatter.h"

namespace openrt {
namespace {

constexpr uint32_t none = ~0u;
constexpr size_t batchSize = 1024;

double luminance(const float c[3]) {
  const double l = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  return std::isfinite(l) && l > 0 ? l : 0;
}

float areaOf(const float p[3][3], float normal[3]) {
  double a[3], b[3];
  for (int k = 0; k < 3; k++) a[k] = double(p[1][k]) - p[0][k], b[k] = double(p[2][k]) - p[0][k];
  const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int k = 0; k < 3; k++) normal[k] = float(length > 0 ? n[k] / length : 0);
  return float(length / 2);
}

// Emission of triangles of one record at their middles, as seen head on from the side their corners turn to (or the other).
void emissionOf(const RenderScene& scene, uint32_t record, uint32_t first, uint32_t n, bool otherSide, double* out) {
  const Record& r = scene.records[record];
  Arena arena;
  Rays rays;
  rays.allocate(arena, n);
  RayHits hits;
  hits.allocate(arena, n);
  auto* order = arena.take<uint32_t>(padded(n));
  for (uint32_t i = 0; i < n; i++) {
    float corners[3][3], normal[3];
    cornersOf(r, first + i, corners);
    areaOf(corners, normal);
    const float side = otherSide ? -1.0f : 1.0f;
    for (int k = 0; k < 3; k++) {
      rays.org[k][i] = (corners[0][k] + corners[1][k] + corners[2][k]) / 3 + side * normal[k];
      rays.dir[k][i] = -side * normal[k];
      hits.ng[k][i] = normal[k];
    }
    if (r.instanced) { // the kernel's normal is in its own frame: up to its length the inverse transpose of kernelNormal's map
      for (int k = 0; k < 3; k++)
        hits.ng[k][i] = r.toRender.r[0][k] * normal[0] + r.toRender.r[1][k] * normal[1] + r.toRender.r[2][k] * normal[2];
    }
    hits.t[i] = 1, hits.u[i] = hits.v[i] = 1.0f / 3;
    hits.record[i] = record, hits.primitive[i] = first + i;
    order[i] = i;
  }
  const auto* travelled = arena.takeZero<float>(padded(n));
  const Points points = makePoints(scene, rays, hits, order, n, travelled, arena);
  RtsSurface surface{};
  for (auto& e : surface.emission) e = arena.takeZero<float>(padded(n));
  RayCounters counters;
  RtsBatch batch;
  batch.scene = &scene, batch.arena = &arena, batch.counters = &counters, batch.points = &points;
  (*scene.shaders)[r.shader].shaderClass->surface(&scene.host, &batch, &points.hits, &surface);
  for (uint32_t i = 0; i < n; i++) {
    const float c[3] = {surface.emission[0][i], surface.emission[1][i], surface.emission[2][i]};
    out[i] = std::max(out[i], luminance(c));
  }
}

} // namespace

void cornersOf(const Record& r, uint32_t primitive, float out[3][3]) {
  for (int c = 0; c < 3; c++) {
    const float* v = r.vertices + 3 * size_t(r.indices[3 * size_t(primitive) + c]);
    for (int k = 0; k < 3; k++) {
      const float* m = r.toRender.r[k];
      out[c][k] = r.instanced ? m[0] * v[0] + m[1] * v[1] + m[2] * v[2] + m[3] : v[k] * r.scale;
    }
  }
}

void Emitters::build(const RenderScene& scene) {
  if (scene.frame.transport != RT_TRANSPORT_PATH) return;
  scene_ = &scene;
  sky_.build(scene);
  firstOf_.assign(scene.records.size(), none);
  std::vector<double> emission;
  double total = 0;
  for (uint32_t id = 0; id < scene.records.size(); id++) {
    const Record& r = scene.records[id];
    const ShaderSlot& shader = (*scene.shaders)[r.shader];
    if (r.primitive != edit::Primitive::Triangles || !(shader.traits & RTS_EMISSIVE) || !shader.shaderClass->surface ||
        !r.vertices)
      continue;
    firstOf_[id] = uint32_t(triangles_.size());
    for (uint32_t first = 0; first < r.primitives; first += batchSize) {
      const uint32_t n = std::min(uint32_t(batchSize), r.primitives - first);
      emission.assign(n, 0);
      emissionOf(scene, id, first, n, false, emission.data());
      emissionOf(scene, id, first, n, true, emission.data());
      for (uint32_t i = 0; i < n; i++) {
        float corners[3][3], normal[3];
        cornersOf(r, first + i, corners);
        const float area = areaOf(corners, normal);
        const double power = std::isfinite(area) ? area * emission[i] : 0;
        triangles_.push_back({id, first + i, area, float(power)});
        cumulative_.push_back(total += power);
      }
    }
  }
  if (!(total > 0)) triangles_.clear(), cumulative_.clear();
  for (Triangle& t : triangles_) t.probability = float(t.probability / total);
}

Sight Emitters::choose(const Receiver& from, float pick, float u, float v) const {
  Sight sight;
  const float skyShare = this->skyShare();
  if (pick < skyShare) {
    float local[3];
    sight.distance = std::numeric_limits<float>::infinity();
    sight.density = skyShare * sky_.sample(u, v, local);
    const auto& m = scene_->environment.fromLocal.r;
    for (int k = 0; k < 3; k++) sight.direction[k] = m[k][0] * local[0] + m[k][1] * local[1] + m[k][2] * local[2];
  } else {
    const double at = double((pick - skyShare) / (1 - skyShare)) * cumulative_.back();
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), at);
    const Triangle& t = triangles_[size_t(std::min(found - cumulative_.begin(), ptrdiff_t(triangles_.size()) - 1))];
    sight.record = t.record, sight.primitive = t.primitive;
    float corner[3][3], way[3], a[3], b[3];
    cornersOf(scene_->records[t.record], t.primitive, corner);
    const float root = std::sqrt(u), w[3] = {1 - root, root * (1 - v), root * v}; // uniform on the triangle
    for (int k = 0; k < 3; k++) {
      way[k] = w[0] * corner[0][k] + w[1] * corner[1][k] + w[2] * corner[2][k] - from.position[k];
      a[k] = corner[1][k] - corner[0][k], b[k] = corner[2][k] - corner[0][k];
    }
    const float normal[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const float square = dot3(way, way), distance = std::sqrt(square);
    const float projected = std::fabs(dot3(normal, way)) / (2 * distance); // area x cosine
    for (int k = 0; k < 3; k++) sight.direction[k] = way[k] / distance;
    sight.distance = distance;
    sight.density = (1 - skyShare) * t.probability * square / projected;
    sight.rim = true;
  }
  const bool sided = from.normal[0] != 0 || from.normal[1] != 0 || from.normal[2] != 0;
  if (!(sight.density > 0) || !std::isfinite(sight.density) || (sided && !(dot3(sight.direction, from.normal) > 0)))
    sight.density = 0;
  return sight;
}

// At an edge it may be a neighbour of the same surface, at the same distance.
bool Emitters::sees(const Sight& sight, uint32_t record, uint32_t primitive, float distance) const {
  if (sight.record != record) return false;
  return primitive == sight.primitive || (sight.rim && std::fabs(distance - sight.distance) <= 0x1p-16f * sight.distance);
}

float Emitters::density(const Receiver& from, uint32_t record, uint32_t primitive, const float direction[3],
                        float distance) const {
  if (triangles_.empty() || firstOf_[record] == none) return 0;
  const Triangle& t = triangles_[firstOf_[record] + primitive];
  if (!(t.probability > 0 && t.area > 0)) return 0;
  float corner[3][3], normal[3];
  cornersOf(scene_->records[record], primitive, corner);
  areaOf(corner, normal);
  const float cosine = std::fabs(dot3(normal, direction));
  (void)from;
  return (1 - skyShare()) * t.probability * distance * distance / (cosine * t.area);
}

float Emitters::skyDensity(const Receiver&, const float local[3]) const { return skyShare() * sky_.density(local); }

double SkySampler::solidAngle(uint32_t row) const {
  return 2 * M_PI / columns * (std::cos(M_PI * row / rows) - std::cos(M_PI * (row + 1) / rows));
}

// The cells' radiance from four places in each.
void SkySampler::build(const RenderScene& scene) {
  const ShaderSlot& environment = scene.environment.shader;
  if (!environment.shaderClass || !environment.shaderClass->miss) return;
  const auto& m = scene.environment.toLocal.r; // densities hold under rotations only
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const float d = m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2];
      if (std::fabs(d - (i == j ? 1.0f : 0.0f)) > 1e-4f) return;
    }
  Arena arena;
  constexpr uint32_t n = 4 * columns;
  float *d[3], *rgba[4];
  for (auto& a : d) a = arena.take<float>(n);
  for (auto& a : rgba) a = arena.take<float>(n);
  RayCounters counters;
  RtsBatch batch;
  batch.scene = &scene, batch.arena = &arena, batch.counters = &counters;
  for (uint32_t row = 0; row < rows; row++) {
    for (uint32_t i = 0; i < n; i++) {
      const double theta = M_PI * (row + (i % 2 ? 0.75 : 0.25)) / rows;
      const double phi = 2 * M_PI * (i / 4 + (i / 2 % 2 ? 0.75 : 0.25)) / columns;
      d[0][i] = float(std::sin(theta) * std::cos(phi)), d[1][i] = float(std::cos(theta)),
      d[2][i] = float(std::sin(theta) * std::sin(phi));
    }
    for (auto& a : rgba) std::fill_n(a, n, 0.0f);
    const float* directions[3] = {d[0], d[1], d[2]};
    environment.shaderClass->miss(&scene.host, &batch, environment.params, n, directions, rgba);
    for (uint32_t column = 0; column < columns; column++) {
      double mean = 0;
      for (uint32_t i = 4 * column; i < 4 * column + 4; i++) {
        const float c[3] = {rgba[0][i], rgba[1][i], rgba[2][i]};
        mean += luminance(c) / 4;
      }
      cumulative_.push_back(total_ += mean * solidAngle(row));
    }
  }
}

float SkySampler::sample(float u, float v, float direction[3]) const {
  const double at = double(u) * total_;
  const size_t cell = size_t(std::min(std::upper_bound(cumulative_.begin(), cumulative_.end(), at) - cumulative_.begin(),
                                      ptrdiff_t(rows * columns - 1)));
  const double before = cell ? cumulative_[cell - 1] : 0, mass = cumulative_[cell] - before;
  if (!(mass > 0)) return 0;
  const double along = std::clamp((at - before) / mass, 0.0, 1.0); // what is left of u serves again
  const uint32_t row = uint32_t(cell / columns), column = uint32_t(cell % columns);
  const double top = std::cos(M_PI * row / rows), bottom = std::cos(M_PI * (row + 1) / rows);
  const double y = top + (bottom - top) * v, phi = 2 * M_PI * (column + along) / columns, s = std::sqrt(std::max(0.0, 1 - y * y));
  direction[0] = float(s * std::cos(phi)), direction[1] = float(y), direction[2] = float(s * std::sin(phi));
  return float(mass / total_ / solidAngle(row));
}

float SkySampler::density(const float d[3]) const {
  if (!usable()) return 0;
  const double theta = std::acos(std::clamp(double(d[1]), -1.0, 1.0));
  double phi = std::atan2(double(d[2]), double(d[0]));
  if (phi < 0) phi += 2 * M_PI;
  const uint32_t row = std::min(uint32_t(theta / M_PI * rows), rows - 1),
                 column = std::min(uint32_t(phi / (2 * M_PI) * columns), columns - 1);
  const size_t cell = size_t(row) * columns + column;
  const double mass = cumulative_[cell] - (cell ? cumulative_[cell - 1] : 0);
  return float(mass / total_ / solidAngle(row));
}

} // namespace openrt
