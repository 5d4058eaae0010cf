// points.cpp: sorts hits into buckets and turns them into shading points: gathers what the records
// say about each hit, block by block, for the vector code in point_block.cpp. Spheres, lines and
// points are computed here, hit by hit.
#include "render/wave/points.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/huge_spheres.h"
#include "render/wave/point_block.h"
#include "shading/parameters.h"

namespace openrt {
namespace {

// Returns the map with the absolute values of its numbers.
Affine absolute(Affine m) {
  for (auto& row : m.r)
    for (float& x : row) x = std::fabs(x);
  return m;
}

// Returns the error bound of the image of p under a map, where e bounds the error of p.
Vec3f boundOfImage(const Affine& m, const Vec3f& p, const Vec3f& e) {
  const Affine magnitude = absolute(m);
  return magnitude.direction(e) + 2 * gammaOf(4) * magnitude.point(abs(p));
}

// Normalises a vector of any length. Returns false if it has no direction.
bool makeUnit(Vec3f& v) {
  const float size = largest(abs(v));
  if (!(size > 0) || !std::isfinite(size)) return false;
  const Vec3f scaled = v * (1 / size); // so that squares neither overflow nor underflow
  v = scaled * (1 / length(scaled));
  return true;
}

// Writes what a record says about the triangle that was hit into lane `to` of a block.
void gatherTriangle(const Record& r, const RayHits& hits, uint32_t lane, PointBlock& block,
                    uint32_t to) {
  const uint32_t* corner = r.indices + 3 * size_t(hits.primitive[lane]);
  uint32_t own = 0;
  block.u[to] = hits.u[lane];
  block.v[to] = hits.v[lane];
  block.scale[to] = r.scale;
  for (int c = 0; c < 3; c++) {
    store(vectorOf(r.vertices + 3 * size_t(corner[c])), block.corner[c], to);
  }
  if (r.instanced) {
    own |= pointInstanced;
    for (int i = 0; i < 3; i++) {
      for (int k = 0; k < 4; k++) block.toRender[i][k][to] = r.frames->toRender.r[i][k];
      store(r.frames->kernelNormal[i], block.kernelNormal[i], to);
    }
  }
  if (r.normals) {
    own |= pointNormals;
    for (int c = 0; c < 3; c++) {
      store(vectorOf(r.normals + 3 * size_t(corner[c])), block.cornerNormal[c], to);
      store(r.normalMatrix[c], block.normalMatrix[c], to);
    }
  }
  if (r.texCoords) {
    own |= pointTexCoords;
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 2; k++)
        block.cornerTexCoord[c][k][to] = r.texCoords[2 * size_t(corner[c]) + k];
  }
  if (r.colors) {
    own |= pointColors;
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 4; k++) block.cornerColor[c][k][to] = r.colors[4 * size_t(corner[c]) + k];
  }
  block.own[to] = own;
  block.attributes |= own;
}

void computeSphere(const Record& r, const Rays& rays, const RayHits& hits, uint32_t lane,
                   PointBlock& block, uint32_t to) {
  const Vec3f origin = load(rays.org, lane), step = hits.t[lane] * load(rays.dir, lane);
  Vec3f p = origin + step, bound = gammaOf(8) * (abs(origin) + abs(step));
  Vec3f l = r.frames->fromRender.point(p); // in the frame of the unit sphere
  if (!makeUnit(l)) l = {0, 0, 1};
  // t is exact to its last bit, so near the ray's origin the position is known far better than to
  // the rounding error of the radius.
  if (!intersectedInDouble(r)) {
    p = r.frames->toRender.point(l);
    bound = boundOfImage(r.frames->toRender, l, {gammaOf(5), gammaOf(5), gammaOf(5)});
  }
  store(p, block.position, to);
  store(bound, block.bound, to);
  store(r.normalMatrix * l, block.ng, to);
  // Clause 6.43: s runs counter-clockwise seen from above, starting at the back; t from bottom to
  // top.
  const float turn = std::atan2(-l.x, -l.z) * float(0.5 / M_PI);
  block.uv[0][to] = turn < 0 ? turn + 1 : turn;
  block.uv[1][to] = 0.5f + std::asin(std::clamp(l.y, -1.0f, 1.0f)) * float(1 / M_PI);
  for (auto& color : block.color) color[to] = 1;
  block.flags[to] = RTS_HIT_TEXCOORD;
  block.smooth[to] = 0;
}

// The hit is settled on the surface in double, so that neither its position nor its normal has the
// rounding error of t.
void computeAnalytic(const Record& r, const Rays& rays, const RayHits& hits, uint32_t lane,
                     PointBlock& block, uint32_t to) {
  const Vec3d origin(load(rays.org, lane)), direction(load(rays.dir, lane));
  const Vec3d l =
      r.surface->settle(r.frames->fromRender.point(origin + double(hits.t[lane]) * direction),
                        r.frames->fromRender.direction(direction));
  Vec3d normal;
  r.surface->valueAt(l, normal);
  const Vec3f place(l);
  const float rounding = gammaOf(5) * largest(abs(place));
  store(r.frames->toRender.point(place), block.position, to);
  store(boundOfImage(r.frames->toRender, place, {rounding, rounding, rounding}), block.bound, to);
  store(r.normalMatrix * Vec3f(normalize(normal)), block.ng, to);
  const auto uv = r.surface->texCoordAt(l);
  for (size_t k = 0; k < 2; k++) block.uv[k][to] = float(uv[k]);
  for (auto& color : block.color) color[to] = 1;
  block.flags[to] = RTS_HIT_TEXCOORD;
  block.smooth[to] = 0;
}

void computeThin(const Record& r, const Rays& rays, const RayHits& hits, uint32_t lane,
                 PointBlock& block, uint32_t to) {
  const Vec3f origin = load(rays.org, lane), direction = load(rays.dir, lane),
              step = hits.t[lane] * direction;
  store(origin + step, block.position, to);
  // Culled ones let rays pass, which must not enter again. Embree is less exact for cones.
  store(gammaOf(r.cull ? 128 : 8) * (abs(origin) + abs(step)), block.bound, to);
  store(-direction, block.ng, to);
  for (auto& coordinate : block.uv) coordinate[to] = 0;
  for (auto& color : block.color) color[to] = 1;
  block.flags[to] = RTS_HIT_LINE;
  block.smooth[to] = 0;
  if (!r.colors) return;
  const bool line = r.primitive == edit::Primitive::Lines;
  const uint32_t* i = r.indices + size_t(hits.primitive[lane]) * (line ? 2 : 1);
  const float u = line ? std::clamp(hits.u[lane], 0.0f, 1.0f) : 0;
  for (int k = 0; k < 4; k++) {
    const float first = r.colors[4 * size_t(i[0]) + k];
    block.color[k][to] = line ? (1 - u) * first + u * r.colors[4 * size_t(i[1]) + k] : first;
  }
  block.flags[to] |= RTS_HIT_COLOR;
}

// Computes up to 16 hits, whose lanes are given, into the elements of `out` from i on.
void computeBlock(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                  const uint32_t (&hitLanes)[lanes], const PointArrays& out, uint32_t i) {
  PointBlock block;
  block.attributes = 0;
  uint32_t oneSided[lanes]; // RTS_HIT_ONE_SIDED or 0
  uint32_t others = 0;      // hits that are not triangles, as bits
  for (uint32_t to = 0; to < lanes; to++) {
    const uint32_t lane = hitLanes[to];
    const Record& r = scene.records[hits.record[lane]];
    store(load(rays.dir, lane), block.direction, to);
    store(load(hits.ng, lane), block.ng, to);
    block.flipped[to] = r.flip ? ~0u : 0;
    oneSided[to] = r.cull ? RTS_HIT_ONE_SIDED : 0;
    if (r.primitive == edit::Primitive::Triangles) {
      gatherTriangle(r, hits, lane, block, to);
      continue;
    }
    others |= 1u << to;
    for (auto& corner : block.corner)
      for (auto& component : corner) component[to] = 0;
    block.u[to] = block.v[to] = block.scale[to] = 0;
    block.own[to] = 0;
  }
  if (others != (1u << lanes) - 1) interpolateTriangles(block);
  for (; others; others &= others - 1) {
    const uint32_t to = uint32_t(std::countr_zero(others)), lane = hitLanes[to];
    const Record& r = scene.records[hits.record[lane]];
    const auto compute = r.surface                                ? computeAnalytic
                         : r.primitive == edit::Primitive::Sphere ? computeSphere
                                                                  : computeThin;
    compute(r, rays, hits, lane, block, to);
  }
  for (uint32_t to = 0; to < lanes; to++) block.flags[to] |= oneSided[to];
  finishPoints(block, out, i);
}

// The vertices of the primitive that a ray has hit, with the weights of linear interpolation there.
struct HitCorners {
  size_t count = 1;
  const uint32_t* vertex = nullptr;
  float weight[3] = {1, 0, 0};

  // Returns a component of an attribute with so many floats per vertex.
  float mix(const float* values, size_t floats, size_t component) const {
    float sum = 0;
    for (size_t c = 0; c < count; c++)
      sum += weight[c] * values[floats * size_t(vertex[c]) + component];
    return sum;
  }
};

HitCorners cornersOf(const Record& r, const RayHits& hits, uint32_t lane) {
  HitCorners corners;
  const float u = hits.u[lane], along = std::clamp(u, 0.0f, 1.0f);
  if (r.primitive == edit::Primitive::Triangles)
    corners = {3, nullptr, {1 - u - hits.v[lane], u, hits.v[lane]}};
  else if (r.primitive == edit::Primitive::Lines)
    corners = {2, nullptr, {1 - along, along, 0}};
  corners.vertex = r.indices + corners.count * size_t(hits.primitive[lane]);
  return corners;
}

// Makes a private copy of the shader's parameters with the geometry's own values interpolated at
// the hit.
const void* ownParameters(const RenderScene& scene, const Record& r, const RayHits& hits,
                          uint32_t lane, Arena& arena) {
  const ShaderSlot& shader = (*scene.shaders)[r.shader];
  auto* block = arena.take<std::byte>(shader.shaderClass->paramSize);
  std::memcpy(block, shader.params, shader.shaderClass->paramSize);
  const size_t primitive = hits.primitive[lane];
  const HitCorners corners = cornersOf(r, hits, lane);
  for (uint32_t p = 0; p < r.parameterCount; p++) {
    const GeometryParameter& own = r.parameters[p];
    const RtsParam& param = shader.shaderClass->params[own.index];
    const size_t n = parameterFloats(param.type);
    const float* values = own.values->as<float>();
    float mixed[16] = {};
    for (size_t k = 0; k < n; k++)
      mixed[k] = own.perVertex ? corners.mix(values, n, k) : values[n * primitive + k];
    // Interpolation weights may be below 0 by a rounding error.
    if (param.minimum != 0 || param.maximum != 0)
      for (size_t k = 0; k < n; k++) mixed[k] = std::clamp(mixed[k], param.minimum, param.maximum);
    std::memcpy(block + param.offset, mixed, n * sizeof(float));
  }
  return block;
}

// Returns what the texture coordinates of a point are made of, in the camera's frame.
Vec3f generatedAt(const RenderScene& scene, edit::TexGen mode, const Vec3f& place,
                  const Vec3f& normal) {
  const Affine& toCamera = scene.camera.toLocal;
  if (mode == edit::TexGen::Position) return toCamera.point(place);
  Vec3f n = toCamera.direction(normal), sight = toCamera.direction(place - scene.eye);
  if (!makeUnit(n)) return {};
  if (mode == edit::TexGen::Normal || mode == edit::TexGen::SphereNormal) return n;
  return makeUnit(sight) ? sight - 2 * dot(sight, n) * n : Vec3f();
}

// Replaces the texture coordinates of points whose geometry makes them in the camera's frame.
void generateTexCoords(const RenderScene& scene, const PointArrays& out, uint32_t size) {
  for (uint32_t i = 0; i < size; i++) {
    const edit::TexGen mode = scene.records[out.record[i]].texGen;
    if (mode == edit::TexGen::Off || (out.flags[i] & RTS_HIT_LINE)) continue;
    const Vec3f v = generatedAt(scene, mode, load(out.position, i), load(out.normal, i));
    const bool sphere =
        mode == edit::TexGen::SphereNormal || mode == edit::TexGen::SphereReflection;
    out.uv[0][i] = sphere ? v.x / 2 + 0.5f : v.x;
    out.uv[1][i] = sphere ? v.y / 2 + 0.5f : v.y;
    out.flags[i] |= RTS_HIT_TEXCOORD;
  }
}

} // namespace

std::span<const BucketRange> sortByBucket(const RenderScene& scene, const RayHits& hits,
                                          const uint32_t* rayLanes, uint32_t n, uint32_t* order,
                                          Arena& arena) {
  if (n == 0) return {};
  const uint32_t buckets = uint32_t(scene.buckets.size());
  auto* ranges = arena.take<BucketRange>(std::min(n, buckets));
  if (buckets == 1) {
    std::copy(rayLanes, rayLanes + n, order);
    ranges[0] = {0, 0, n};
    return {ranges, 1};
  }
  auto* counts = arena.takeZero<uint32_t>(buckets);
  for (uint32_t i = 0; i < n; i++) counts[scene.records[hits.record[rayLanes[i]]].bucket]++;
  uint32_t begin = 0, used = 0;
  for (uint32_t b = 0; b < buckets; b++) {
    if (counts[b]) ranges[used++] = {b, begin, begin + counts[b]};
    const uint32_t c = counts[b];
    counts[b] = begin;
    begin += c;
  }
  for (uint32_t i = 0; i < n; i++)
    order[counts[scene.records[hits.record[rayLanes[i]]].bucket]++] = rayLanes[i];
  return {ranges, used};
}

Points makePoints(const RenderScene& scene, const Rays& rays, const RayHits& hits,
                  const uint32_t* order, uint32_t n, const float* travelled, Arena& arena) {
  const uint32_t size = padded(n);
  PointArrays out;
  const auto floats = [&] { return arena.take<float>(size); };
  for (auto* group : {out.position, out.direction, out.geometric, out.normal})
    for (int k = 0; k < 3; k++) group[k] = floats();
  for (auto& a : out.uv) a = floats();
  for (auto& a : out.color) a = floats();
  out.distance = floats();
  out.segment = floats();
  out.error = floats();
  out.flags = arena.take<uint32_t>(size);
  out.record = arena.take<uint32_t>(size);
  out.params = arena.take<const void*>(size);
  bool generates = false;
  for (uint32_t first = 0; first < size; first += lanes) {
    uint32_t hitLanes[lanes];
    for (uint32_t to = 0; to < lanes; to++) { // the padding repeats the last hit
      const uint32_t i = first + to, lane = hitLanes[to] = order[std::min(i, n - 1)];
      const Record& r = scene.records[hits.record[lane]];
      out.distance[i] = travelled[lane] + hits.t[lane];
      out.segment[i] = hits.t[lane];
      out.record[i] = hits.record[lane];
      generates |= r.texGen != edit::TexGen::Off;
      out.params[i] = r.parameterCount ? ownParameters(scene, r, hits, lane, arena)
                                       : (*scene.shaders)[r.shader].params;
    }
    computeBlock(scene, rays, hits, hitLanes, out, first);
  }
  if (generates) generateTexCoords(scene, out, size);
  Points points;
  RtsHits& to = points.hits;
  to.count = n;
  for (int k = 0; k < 3; k++) {
    to.position[k] = out.position[k];
    to.direction[k] = out.direction[k];
    to.geometric[k] = out.geometric[k];
    to.normal[k] = out.normal[k];
  }
  to.uv[0] = out.uv[0];
  to.uv[1] = out.uv[1];
  for (int k = 0; k < 4; k++) to.color[k] = out.color[k];
  to.distance = out.distance;
  to.segment = out.segment;
  to.flags = out.flags;
  to.params = out.params;
  points.error = out.error;
  points.record = out.record;
  points.rayHits = &hits;
  points.order = order;
  return points;
}

float fogCoordAt(const RenderScene& scene, const Points& points, uint32_t i) {
  constexpr float none = -1;
  if (points.record[i] == noHit) return none; // a sensor
  const Record& r = scene.records[points.record[i]];
  if (!r.fogCoords) return none;
  return std::clamp(cornersOf(r, *points.rayHits, points.order[i]).mix(r.fogCoords, 1, 0), 0.0f,
                    1.0f);
}

bool liftToSmooth(const RenderScene& scene, const Points& points, uint32_t i, Vec3f& out) {
  if (points.record[i] == noHit) return false; // a sensor
  const Record& r = scene.records[points.record[i]];
  if (!r.normals || r.primitive != edit::Primitive::Triangles) return false;
  const uint32_t lane = points.order[i];
  const uint32_t* corner = r.indices + 3 * size_t(points.rayHits->primitive[lane]);
  const float u = points.rayHits->u[lane], v = points.rayHits->v[lane], w[3] = {1 - u - v, u, v};
  const float sign = points.hits.flags[i] & RTS_HIT_BACK ? -1.0f : 1.0f;
  const Vec3f p = load(points.hits.position, i);
  Vec3f lift;
  for (int c = 0; c < 3; c++) {
    const size_t at = 3 * size_t(corner[c]);
    Vec3f n = r.normalMatrix * vectorOf(r.normals + at);
    if (!makeUnit(n)) return false;
    n *= sign;
    // Depth of the point below the tangent plane of the vertex.
    const Vec3f vertex = r.placeOf(vectorOf(r.vertices + at));
    const float below = std::min(dot(p - vertex, n), 0.0f);
    lift -= w[c] * below * n;
  }
  out = p + lift;
  return true;
}

} // namespace openrt
