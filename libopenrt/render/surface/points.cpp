// points.cpp: computes the position of hits with its error bound, normals, texture coordinates and
// colour. Error bounds follow pbrt's running error analysis: gamma(n) = n e / (1 - n e), e = 2^-24.
#include "render/surface/points.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/huge_spheres.h"
#include "shading/parameters.h"

namespace openrt {
namespace {

constexpr float gammaOf(int n) { return n * 0x1p-24f / (1 - n * 0x1p-24f); }

struct PointArrays { // output arrays, filled lane by lane
  float *position[3], *direction[3], *geometric[3], *normal[3], *uv[2], *color[4], *distance,
      *segment, *error;
  uint32_t *flags, *record;
  const void** params;
};

void apply(const float m[3][3], const float v[3], float out[3]) {
  for (int i = 0; i < 3; i++) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

// Transforms a point and its componentwise error bound by an affine map.
void applyBound(const Affine& m, const float p[3], const float e[3], float out[3], float bound[3]) {
  for (int i = 0; i < 3; i++) {
    const float* r = m.r[i];
    const float x = r[0] * p[0], y = r[1] * p[1], z = r[2] * p[2];
    out[i] = x + y + z + r[3];
    const float magnitude = std::fabs(x) + std::fabs(y) + std::fabs(z) + std::fabs(r[3]);
    bound[i] = std::fabs(r[0]) * e[0] + std::fabs(r[1]) * e[1] + std::fabs(r[2]) * e[2] +
               2 * gammaOf(4) * magnitude;
  }
}

bool normalize(float v[3]) {
  const float largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (!(largest > 0) || !std::isfinite(largest)) return false;
  const float s = 1 / largest; // scaled first, so that squares neither overflow nor underflow
  const float x = v[0] * s, y = v[1] * s, z = v[2] * s;
  const float k = 1 / std::sqrt(x * x + y * y + z * z);
  v[0] = x * k;
  v[1] = y * k;
  v[2] = z * k;
  return true;
}

template <int N>
void mix(const float* values, const uint32_t i[3], const float w[3], float out[N]) {
  for (int k = 0; k < N; k++)
    out[k] =
        w[0] * values[N * i[0] + k] + w[1] * values[N * i[1] + k] + w[2] * values[N * i[2] + k];
}

struct Local { // intermediate data of one hit
  float p[3], bound[3], ng[3], ns[3], uv[2] = {0, 0}, color[4] = {1, 1, 1, 1};
  uint32_t flags = 0;
  bool smooth = false;
};

void triangle(const Record& r, const RayHits& hits, uint32_t lane, Local& h) {
  const uint32_t* corner = r.indices + 3 * size_t(hits.primitive[lane]);
  const uint32_t i[3] = {corner[0], corner[1], corner[2]};
  const float u = hits.u[lane], v = hits.v[lane];
  const float w[3] = {1 - u - v, u, v};
  const float *a = r.vertices + 3 * size_t(i[0]), *b = r.vertices + 3 * size_t(i[1]),
              *c = r.vertices + 3 * size_t(i[2]);
  float p[3], e[3];
  for (int k = 0; k < 3; k++) {
    const float x = w[0] * a[k], y = w[1] * b[k], z = w[2] * c[k];
    p[k] = x + y + z;
    e[k] = gammaOf(7) * (std::fabs(x) + std::fabs(y) + std::fabs(z));
  }
  const float kernel[3] = {hits.ng[0][lane], hits.ng[1][lane], hits.ng[2][lane]};
  if (r.instanced) {
    applyBound(r.toRender, p, e, h.p, h.bound);
    apply(r.kernelNormal, kernel, h.ng);
  } else {
    for (int k = 0; k < 3; k++) {
      h.p[k] = p[k] * r.scale;
      h.bound[k] = e[k] * r.scale;
      h.ng[k] = kernel[k];
    }
  }
  if (r.normals) {
    float n[3];
    mix<3>(r.normals, i, w, n);
    apply(r.normalMatrix, n, h.ns);
    h.smooth = true;
  }
  if (r.texCoords) mix<2>(r.texCoords, i, w, h.uv), h.flags |= RTS_HIT_TEXCOORD;
  if (r.colors) mix<4>(r.colors, i, w, h.color), h.flags |= RTS_HIT_COLOR;
}

void sphere(const Record& r, const Rays& rays, const RayHits& hits, uint32_t lane, Local& h) {
  float p[3], bound[3], l[3], none[3] = {0, 0, 0}, ignored[3];
  for (int k = 0; k < 3; k++) {
    const float step = hits.t[lane] * rays.dir[k][lane];
    p[k] = rays.org[k][lane] + step;
    bound[k] = gammaOf(8) * (std::fabs(rays.org[k][lane]) + std::fabs(step));
  }
  applyBound(r.fromRender, p, none, l, ignored);
  if (!normalize(l)) {
    l[0] = 0;
    l[1] = 0;
    l[2] = 1;
  }
  const float e[3] = {gammaOf(5), gammaOf(5), gammaOf(5)};
  // t is exact to its last bit, so near the ray's origin the position is known far better than to
  // the rounding error of the radius.
  if (intersectedInDouble(r))
    for (int k = 0; k < 3; k++) {
      h.p[k] = p[k];
      h.bound[k] = bound[k];
    }
  else
    applyBound(r.toRender, l, e, h.p, h.bound);
  apply(r.normalMatrix, l, h.ng);
  // Clause 6.43: s runs counter-clockwise seen from above, starting at the back; t from bottom to
  // top.
  const float turn = std::atan2(-l[0], -l[2]) * float(0.5 / M_PI);
  h.uv[0] = turn < 0 ? turn + 1 : turn;
  h.uv[1] = 0.5f + std::asin(std::clamp(l[1], -1.0f, 1.0f)) * float(1 / M_PI);
  h.flags |= RTS_HIT_TEXCOORD;
}

void thin(const Record& r, const Rays& rays, const RayHits& hits, uint32_t lane, Local& h) {
  for (int k = 0; k < 3; k++) {
    const float step = hits.t[lane] * rays.dir[k][lane];
    h.p[k] = rays.org[k][lane] + step;
    h.bound[k] = gammaOf(8) * (std::fabs(rays.org[k][lane]) + std::fabs(step));
    h.ng[k] = -rays.dir[k][lane];
  }
  h.flags |= RTS_HIT_LINE;
  if (!r.colors) return;
  const bool line = r.primitive == edit::Primitive::Lines;
  const uint32_t* i = r.indices + size_t(hits.primitive[lane]) * (line ? 2 : 1);
  const float u = line ? std::clamp(hits.u[lane], 0.0f, 1.0f) : 0;
  for (int k = 0; k < 4; k++) {
    const float first = r.colors[4 * size_t(i[0]) + k];
    h.color[k] = line ? (1 - u) * first + u * r.colors[4 * size_t(i[1]) + k] : first;
  }
  h.flags |= RTS_HIT_COLOR;
}

// Makes a private copy of the shader's parameters with the geometry's own values interpolated at
// the hit.
const void* ownParameters(const RenderScene& scene, const Record& r, const RayHits& hits,
                          uint32_t lane, Arena& arena) {
  const ShaderSlot& shader = (*scene.shaders)[r.shader];
  auto* block = arena.take<std::byte>(shader.shaderClass->paramSize);
  std::memcpy(block, shader.params, shader.shaderClass->paramSize);
  const size_t primitive = hits.primitive[lane];
  const size_t corners = r.primitive == edit::Primitive::Triangles ? 3
                         : r.primitive == edit::Primitive::Lines   ? 2
                                                                   : 1;
  const float u = corners == 2 ? std::clamp(hits.u[lane], 0.0f, 1.0f) : hits.u[lane],
              v = corners == 3 ? hits.v[lane] : 0;
  const float w[3] = {1 - u - v, u, v};
  for (uint32_t p = 0; p < r.parameterCount; p++) {
    const GeometryParameter& own = r.parameters[p];
    const RtsParam& param = shader.shaderClass->params[own.index];
    const size_t n = parameterFloats(param.type);
    const float* values = own.values->as<float>();
    float mixed[16] = {};
    if (own.perVertex && corners > 1) {
      for (size_t c = 0; c < corners; c++) {
        const float* at = values + n * size_t(r.indices[corners * primitive + c]);
        for (size_t k = 0; k < n; k++) mixed[k] += w[c] * at[k];
      }
    } else {
      std::copy_n(values + n * (own.perVertex ? size_t(r.indices[primitive]) : primitive), n,
                  mixed);
    }
    // Interpolation weights may be below 0 by a rounding error.
    if (param.minimum != 0 || param.maximum != 0)
      for (size_t k = 0; k < n; k++) mixed[k] = std::clamp(mixed[k], param.minimum, param.maximum);
    std::memcpy(block + param.offset, mixed, n * sizeof(float));
  }
  return block;
}

void store(const Record& r, const Rays& rays, uint32_t lane, Local& h, const PointArrays& out,
           uint32_t to) {
  const float d[3] = {rays.dir[0][lane], rays.dir[1][lane], rays.dir[2][lane]};
  if (!normalize(h.ng))
    for (int k = 0; k < 3; k++) h.ng[k] = -d[k];
  const float towards = h.ng[0] * d[0] + h.ng[1] * d[1] + h.ng[2] * d[2];
  const bool thinHit = h.flags & RTS_HIT_LINE;
  const bool away = towards > 0; // the kernel's normal points away from the ray's origin
  if (!thinHit && away != r.flip) h.flags |= RTS_HIT_BACK;
  const float sign = away ? -1.0f : 1.0f;
  if (h.smooth && !normalize(h.ns)) h.smooth = false;
  // A vertex normal given by the geometry is flipped only together with its face, if that is seen
  // from the back (two-sided lighting). It is not flipped because it points away from the ray.
  const float smoothSign = (h.flags & RTS_HIT_BACK) ? -1.0f : 1.0f;
  float error = 0;
  for (int k = 0; k < 3; k++) {
    out.position[k][to] = h.p[k];
    out.direction[k][to] = d[k];
    out.geometric[k][to] = sign * h.ng[k];
    out.normal[k][to] = h.smooth ? smoothSign * h.ns[k] : sign * h.ng[k];
    out.color[k][to] = h.color[k];
    error += std::fabs(h.ng[k]) * h.bound[k];
  }
  out.color[3][to] = h.color[3];
  out.uv[0][to] = h.uv[0];
  out.uv[1][to] = h.uv[1];
  // The bound along the normal is 0 for a face in a coordinate plane through the origin, but rays
  // must still be offset.
  out.error[to] = std::max(error, 0x1p-6f * std::max({h.bound[0], h.bound[1], h.bound[2]}));
  out.flags[to] = h.flags;
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
  for (uint32_t i = 0; i < size; i++) { // the padding repeats the last hit
    const uint32_t lane = order[std::min(i, n - 1)];
    const Record& r = scene.records[hits.record[lane]];
    Local h;
    switch (r.primitive) {
    case edit::Primitive::Triangles: triangle(r, hits, lane, h); break;
    case edit::Primitive::Sphere: sphere(r, rays, hits, lane, h); break;
    default: thin(r, rays, hits, lane, h);
    }
    store(r, rays, lane, h, out, i);
    out.distance[i] = travelled[lane] + hits.t[lane];
    out.segment[i] = hits.t[lane];
    out.record[i] = hits.record[lane];
    out.params[i] = r.parameterCount ? ownParameters(scene, r, hits, lane, arena)
                                     : (*scene.shaders)[r.shader].params;
  }
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

bool liftToSmooth(const RenderScene& scene, const Points& points, uint32_t i, float out[3]) {
  const Record& r = scene.records[points.record[i]];
  if (!r.normals || r.primitive != edit::Primitive::Triangles) return false;
  const uint32_t lane = points.order[i];
  const uint32_t* corner = r.indices + 3 * size_t(points.rayHits->primitive[lane]);
  const float u = points.rayHits->u[lane], v = points.rayHits->v[lane], w[3] = {1 - u - v, u, v};
  const float sign = points.hits.flags[i] & RTS_HIT_BACK ? -1.0f : 1.0f;
  float p[3], lift[3] = {0, 0, 0};
  for (int k = 0; k < 3; k++) p[k] = points.hits.position[k][i];
  for (int c = 0; c < 3; c++) {
    const float* at = r.vertices + 3 * size_t(corner[c]);
    float n[3], vertex[3];
    apply(r.normalMatrix, r.normals + 3 * size_t(corner[c]), n);
    if (!normalize(n)) return false;
    for (int k = 0; k < 3; k++) {
      const float* m = r.toRender.r[k];
      vertex[k] = r.instanced ? m[0] * at[0] + m[1] * at[1] + m[2] * at[2] + m[3] : at[k] * r.scale;
    }
    float below = 0; // depth of the point below the tangent plane of the vertex
    for (int k = 0; k < 3; k++) below += (p[k] - vertex[k]) * n[k] * sign;
    below = std::min(below, 0.0f);
    for (int k = 0; k < 3; k++) lift[k] -= w[c] * below * n[k] * sign;
  }
  for (int k = 0; k < 3; k++) out[k] = p[k] + lift[k];
  return true;
}

} // namespace openrt
