// point_block.cpp: computes shading points with vector lanes: interpolates the position with its
// error bound, normals, texture coordinates and colour; turns normals to the side of the ray. Error
// bounds follow pbrt's running error analysis.
#include "render/wave/point_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/wave/point_block.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

// Returns where hits have an attribute of their own.
inline Mask has(const PointBlock& block, PointAttributes attribute, uint32_t i) {
  const Bits own = load(block.own + i);
  return hasBits(own, attribute);
}

// Normalises v. Returns where that is possible. Components are scaled first, so that squares
// neither overflow nor underflow.
inline Mask normalize(LaneVec& v) {
  const Lanes size = largest(abs(v));
  const Mask valid = hn::And(size > lanesOf(0), isFinite(size));
  const LaneVec scaled = v * (lanesOf(1) / size);
  v = scaled * (lanesOf(1) / sqrt(dot(scaled, scaled)));
  return valid;
}

// The barycentric coordinates of hits, as weights of the corners.
struct Weights {
  Lanes a, b, c;
  Lanes operator()(const float* a0, const float* b0, const float* c0) const {
    return a * load(a0) + b * load(b0) + c * load(c0);
  }
};

void interpolateAt(PointBlock& block, uint32_t i) {
  const Lanes u = load(block.u + i), v = load(block.v + i);
  const Weights weights{lanesOf(1) - u - v, u, v};
  const LaneVec a = load(block.corner[0], i) * weights.a, b = load(block.corner[1], i) * weights.b,
                c = load(block.corner[2], i) * weights.c;
  const LaneVec p = a + b + c, error = (abs(a) + abs(b) + abs(c)) * lanesOf(gammaOf(7));
  const Lanes scale = load(block.scale + i);
  LaneVec position = p * scale, bound = error * scale;
  if (block.attributes & pointInstanced) {
    const Mask instanced = has(block, pointInstanced, i);
    const LaneVec kernel = load(block.ng, i);
    store(select(instanced, load(block.kernelNormal, i) * kernel, kernel), block.ng, i);
    const auto row = [&](int k, Lanes& out, Lanes& outBound) {
      const LaneVec m = load(block.toRender[k], i), products = m * p;
      const Lanes offset = load(block.toRender[k][3] + i);
      out = products.x + products.y + products.z + offset;
      const LaneVec sizes = abs(products);
      const Lanes magnitude = sizes.x + sizes.y + sizes.z + abs(offset);
      outBound = dot(abs(m), error) + lanesOf(2 * gammaOf(4)) * magnitude;
    };
    LaneVec moved, movedBound;
    row(0, moved.x, movedBound.x);
    row(1, moved.y, movedBound.y);
    row(2, moved.z, movedBound.z);
    position = select(instanced, moved, position);
    bound = select(instanced, movedBound, bound);
  }
  store(position, block.position, i);
  store(bound, block.bound, i);
  Bits smooth = bitsOf(0);
  if (block.attributes & pointNormals) {
    const auto& n = block.cornerNormal;
    const LaneVec mixed{weights(n[0][0] + i, n[1][0] + i, n[2][0] + i),
                        weights(n[0][1] + i, n[1][1] + i, n[2][1] + i),
                        weights(n[0][2] + i, n[1][2] + i, n[2][2] + i)};
    store(load(block.normalMatrix, i) * mixed, block.normal, i);
    smooth = bitsWhere(has(block, pointNormals, i), ~0u);
  }
  store(smooth, block.smooth + i);
  const Mask textured = has(block, pointTexCoords, i), colored = has(block, pointColors, i);
  const auto& t = block.cornerTexCoord;
  for (int k = 0; k < 2; k++) {
    Lanes value = lanesOf(0);
    if (block.attributes & pointTexCoords)
      value = select(textured, weights(t[0][k] + i, t[1][k] + i, t[2][k] + i), value);
    store(value, block.uv[k] + i);
  }
  const auto& color = block.cornerColor;
  for (int k = 0; k < 4; k++) {
    Lanes value = lanesOf(1);
    if (block.attributes & pointColors)
      value = select(colored, weights(color[0][k] + i, color[1][k] + i, color[2][k] + i), value);
    store(value, block.color[k] + i);
  }
  store(hn::Or(bitsWhere(textured, RTS_HIT_TEXCOORD), bitsWhere(colored, RTS_HIT_COLOR)),
        block.flags + i);
}

void finishAt(const PointBlock& block, uint32_t i, const PointArrays& out, uint32_t to) {
  const LaneVec direction = load(block.direction, i);
  LaneVec ng = load(block.ng, i);
  const LaneVec opposite = lanesOf(-1) * direction;
  const Mask valid = normalize(ng);
  ng = select(valid, ng, opposite);
  // The kernel's normal points away from the ray's origin.
  const Mask away = dot(ng, direction) > lanesOf(0);
  const Bits flags = load(block.flags + i);
  const Mask line = hasBits(flags, RTS_HIT_LINE);
  const Mask back = hn::AndNot(line, hn::Xor(away, loadMask(block.flipped + i)));
  store(hn::Or(flags, bitsWhere(back, RTS_HIT_BACK)), out.flags + to);
  const Lanes one = lanesOf(1), minusOne = lanesOf(-1);
  const LaneVec geometric = select(away, minusOne, one) * ng;
  // A vertex normal given by the geometry is flipped only together with its face, if that is seen
  // from the back (two-sided lighting). It is not flipped because it points away from the ray.
  LaneVec normal = geometric;
  if (block.attributes & pointNormals) {
    LaneVec ns = load(block.normal, i);
    const Mask smooth = hn::And(loadMask(block.smooth + i), normalize(ns));
    normal = select(smooth, select(back, minusOne, one) * ns, geometric);
  }
  const LaneVec bound = load(block.bound, i);
  store(load(block.position, i), out.position, to);
  store(direction, out.direction, to);
  store(geometric, out.geometric, to);
  store(normal, out.normal, to);
  for (int k = 0; k < 4; k++) store(load(block.color[k] + i), out.color[k] + to);
  for (int k = 0; k < 2; k++) store(load(block.uv[k] + i), out.uv[k] + to);
  // The bound along the normal is 0 for a face in a coordinate plane through the origin, but rays
  // must still be offset.
  store(max(dot(abs(ng), bound), lanesOf(0x1p-6f) * largest(bound)), out.error + to);
}

} // namespace

void interpolateTriangles(PointBlock& block) {
  for (uint32_t i = 0; i < lanes; i += width()) interpolateAt(block, i);
}

void finishPoints(const PointBlock& block, const PointArrays& out, uint32_t first) {
  for (uint32_t i = 0; i < lanes; i += width()) finishAt(block, i, out, first + i);
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {
HWY_EXPORT(interpolateTriangles);
HWY_EXPORT(finishPoints);
void interpolateTriangles(PointBlock& block) { HWY_DYNAMIC_DISPATCH(interpolateTriangles)(block); }
void finishPoints(const PointBlock& block, const PointArrays& out, uint32_t first) {
  HWY_DYNAMIC_DISPATCH(finishPoints)(block, out, first);
}
} // namespace openrt
#endif
