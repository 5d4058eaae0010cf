#include "render/lanes/all_finite.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/lanes/all_finite.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

bool allFinite(const float* values, uint32_t n) {
  Mask all = isFinite(lanesOf(0));
  for (uint32_t i = 0; i < n; i += width())
    all = hn::And(all, isFinite(loadSome(values + i, n - i)));
  return hn::AllTrue(LanesTag(), all);
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {
HWY_EXPORT(allFinite);
bool allFinite(const float* values, uint32_t n) {
  return HWY_DYNAMIC_DISPATCH(allFinite)(values, n);
}
} // namespace openrt
#endif
