#include "render/surface/lambert.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/surface/lambert.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/directions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

Lanes lambertPdf(const LaneVec& normal, const LaneVec& direction) {
  return max(dot(normal, direction), lanesOf(0)) * lanesOf(0.318309886f);
}

} // namespace

void evaluateLambert(const RtsLobe* lobe, const RtsHits*, uint32_t n, const uint32_t* hit,
                     const float* const direction[3], float* const value[3], float* pdf) {
  for (uint32_t i = 0; i < n; i += width()) {
    const LaneVec normal = gather(lobe->normal, indicesFrom(hit, i, n));
    const Lanes each = lambertPdf(normal, loadSome(direction, i, n - i));
    storeSome({each, each, each}, value, i, n - i);
    storeSome(each, pdf + i, n - i);
  }
}

void sampleLambert(const RtsLobe* lobe, const RtsHits*, uint32_t n, const uint32_t* hit,
                   const float* const square[2], float* const direction[3],
                   float* const quotient[3], float* pdf) {
  const Lanes one = lanesOf(1);
  for (uint32_t i = 0; i < n; i += width()) {
    const LaneVec normal = gather(lobe->normal, indicesFrom(hit, i, n));
    const LaneVec d = sampleCosineHemisphere(normal, loadSome(square[0] + i, n - i),
                                             loadSome(square[1] + i, n - i));
    storeSome(d, direction, i, n - i);
    storeSome({one, one, one}, quotient, i, n - i);
    storeSome(lambertPdf(normal, d), pdf + i, n - i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {
HWY_EXPORT(evaluateLambert);
HWY_EXPORT(sampleLambert);
void evaluateLambert(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                     const float* const direction[3], float* const value[3], float* pdf) {
  HWY_DYNAMIC_DISPATCH(evaluateLambert)(lobe, hits, n, hit, direction, value, pdf);
}
void sampleLambert(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                   const float* const square[2], float* const direction[3],
                   float* const quotient[3], float* pdf) {
  HWY_DYNAMIC_DISPATCH(sampleLambert)(lobe, hits, n, hit, square, direction, quotient, pdf);
}
} // namespace openrt
#endif
