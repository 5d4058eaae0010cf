#include "render/lights/light_rays.h"

#include "openrt/openrts.h"
#include "render/surface/lobes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/lights/light_rays.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/compress-inl.h"
#include "render/lanes/directions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

Mask isZero(const uint8_t* from) {
  const hn::Rebind<uint8_t, BitsTag> bytes;
  const Bits v = hn::PromoteTo(BitsTag(), hn::LoadU(bytes, from));
  return maskOf(hn::Eq(v, bitsOf(0)));
}

} // namespace

uint32_t listEmitting(const float* const emission[3], uint32_t n, uint32_t* hits) {
  const Lanes zero = lanesOf(0);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i += width()) {
    const LaneVec e = load(emission, i);
    const Mask emits =
        hn::And(presentFrom(i, n), hn::Or(e.x != zero, hn::Or(e.y != zero, e.z != zero)));
    Compressed{emits, count}(hn::Iota(BitsTag(), i), hits);
    count += countTrue(emits);
  }
  return count;
}

void startShadowRays(const LightPoints& points, const SampledLights& sampled, LightSamples& out) {
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const Rays& rays = out.rays;
  uint32_t n = 0;
  for (uint32_t i = 0; i < points.count; i += width()) {
    const Lanes pdf = load(sampled.pdf + i);
    const Mask present = hn::And(presentFrom(i, points.count), pdf > zero);
    const LaneVec direction = load(sampled.direction, i), normal = load(points.normal, i);
    const LaneVec side = select(dot(normal, direction) > zero, one, lanesOf(-1)) * normal;
    const Compressed append{present, n};
    append(offsetPoint(load(points.position, i), side, load(points.error + i)), rays.org);
    append(direction, rays.dir);
    append(zero, rays.tnear);
    append(load(sampled.end + i), rays.tfar);
    append(load(sampled.distance + i), out.distance);
    append(pdf, out.pdf);
    append(load(sampled.shape + i), out.shape);
    append(hn::Iota(BitsTag(), i), out.hit);
    n += countTrue(present);
  }
  out.rays.count = n;
}

void weightByLobe(const RtsLobe& lobe, const float* followed, const LobeValues& values, bool more,
                  const LightSamples& samples, const float* cameraShare) {
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const LaneVec none{zero, zero, zero};
  const uint32_t n = samples.rays.count;
  const bool coated = samples.coated[0] && lobe.coat;
  for (uint32_t r = 0; r < n; r += width()) {
    const Indices hit = indicesFrom(samples.hit, r, n);
    const Lanes share = gather(followed, hit);
    const LaneVec weight = checked(gather(lobe.weight, hit));
    const Mask lit = hn::And(share > zero, largest(weight) > zero);
    const Lanes scale = one / (load(samples.pdf + r) + share * load(values.pdf + r));
    LaneVec response = select(lit, weight * load(values.value, r) * scale, none);
    if (cameraShare) response = response * load(cameraShare + r);
    store(more ? load(samples.response, r) + response : response, samples.response, r);
    if (coated) store(load(samples.coated, r) + response, samples.coated, r);
  }
}

void removeUseless(LightSamples& samples) {
  const Lanes zero = lanesOf(0);
  const Rays& rays = samples.rays;
  uint32_t left = 0;
  for (uint32_t r = 0; r < rays.count; r += width()) {
    const LaneVec response = load(samples.response, r);
    const Mask useful = hn::Or(response.x > zero, hn::Or(response.y > zero, response.z > zero));
    const Mask kept = hn::And(presentFrom(r, rays.count), useful);
    const Compressed move{kept, left};
    move(load(rays.org, r), rays.org);
    move(load(rays.dir, r), rays.dir);
    move(response, samples.response);
    if (samples.coated[0]) move(load(samples.coated, r), samples.coated);
    move(load(rays.tnear + r), rays.tnear);
    move(load(rays.tfar + r), rays.tfar);
    move(load(samples.distance + r), samples.distance);
    move(load(samples.pdf + r), samples.pdf);
    move(load(samples.shape + r), samples.shape);
    move(load(samples.hit + r), samples.hit);
    left += countTrue(kept);
  }
  samples.rays.count = left;
}

uint32_t addOneRadiance(const ShapeArrays& shapes, const LightSamples& samples,
                        const float* const response[3], const uint8_t* blocked,
                        float* const radiance[3], uint32_t* others) {
  const uint32_t n = samples.rays.count;
  uint32_t left = 0;
  for (uint32_t r = 0; r < n; r += width()) {
    const Mask arrives = hn::And(presentFrom(r, n), isZero(blocked + r));
    const Bits number = load(samples.shape + r);
    const Mask onShape = hn::And(arrives, maskOf(hn::Ne(number, bitsOf(EmissiveShapes::none))));
    const Indices shape =
        hn::BitCast(hn::RebindToSigned<LanesTag>(), hn::IfThenElseZero(maskOf(onShape), number));
    const Mask added =
        hn::And(onShape, hasBits(gather(shapes.sides, shape), ShapeArrays::oneRadiance));
    Compressed{hn::AndNot(added, arrives), left}(hn::Iota(BitsTag(), r), others);
    left += countTrue(hn::AndNot(added, arrives));
    float light[3][lanes];
    uint32_t hit[lanes];
    float* const to[3] = {light[0], light[1], light[2]};
    const Compressed append{added, 0};
    append(load(response, r) * gather(shapes.radiance, shape), to);
    append(load(samples.hit + r), hit);
    for (uint32_t j = 0, end = countTrue(added); j < end; j++)
      for (int k = 0; k < 3; k++) radiance[k][hit[j]] += light[k][j];
  }
  return left;
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {

void LightSamples::allocate(Arena& arena, uint32_t capacity) {
  const uint32_t n = padded(capacity);
  rays.allocate(arena, capacity);
  for (auto* a : {&distance, &pdf, &response[0], &response[1], &response[2]})
    *a = arena.take<float>(n);
  shape = arena.take<uint32_t>(n);
  hit = arena.take<uint32_t>(n);
}

HWY_EXPORT(listEmitting);
HWY_EXPORT(startShadowRays);
HWY_EXPORT(weightByLobe);
HWY_EXPORT(removeUseless);
HWY_EXPORT(addOneRadiance);
uint32_t listEmitting(const float* const emission[3], uint32_t n, uint32_t* hits) {
  return HWY_DYNAMIC_DISPATCH(listEmitting)(emission, n, hits);
}
void startShadowRays(const LightPoints& points, const SampledLights& sampled, LightSamples& out) {
  HWY_DYNAMIC_DISPATCH(startShadowRays)(points, sampled, out);
}
void weightByLobe(const RtsLobe& lobe, const float* followed, const LobeValues& values, bool more,
                  const LightSamples& samples, const float* share) {
  HWY_DYNAMIC_DISPATCH(weightByLobe)(lobe, followed, values, more, samples, share);
}
void removeUseless(LightSamples& samples) { HWY_DYNAMIC_DISPATCH(removeUseless)(samples); }
uint32_t addOneRadiance(const ShapeArrays& shapes, const LightSamples& samples,
                        const float* const response[3], const uint8_t* blocked,
                        float* const radiance[3], uint32_t* others) {
  return HWY_DYNAMIC_DISPATCH(addOneRadiance)(shapes, samples, response, blocked, radiance, others);
}

} // namespace openrt
#endif
