#include "render/wave/light_stride.h"

#include "render/wave/sampler.h"
#include "scene/quality.h"

namespace openrt {

uint32_t lightStrideOf(const edit::FrameSettingsT& frame) {
  const bool everywhere = wantsError(frame) || frame.targetError > 0 || frame.timeLimit > 0;
  return everywhere || frame.lightStride < 1 ? 1 : frame.lightStride;
}

bool isLit(uint32_t x, uint32_t y, uint32_t stride, uint32_t seed) {
  if (stride <= 1) return true;
  // Steps that have no factor in common with the number of pixels, so that all are visited, and
  // lead to distant pixels.
  constexpr uint32_t steps[] = {1, 1, 3, 4, 7};
  const uint32_t pixels = stride * stride, step = stride < 5 ? steps[stride] : 1;
  const uint32_t start = hash(x / stride, y / stride);
  return (y % stride) * stride + x % stride == (start % pixels + seed % pixels * step) % pixels;
}

} // namespace openrt
