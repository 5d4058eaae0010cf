#include "render/path/trial_blocks.h"

#include <algorithm>
#include <cmath>

#include "openrt/openrt.h"

namespace openrt {

// M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018.
Tile trialBlock(const edit::FrameSettingsT& frame, uint32_t i) {
  const auto place = [i](double step, uint32_t size) {
    const double at = .5 + i * step;
    return uint32_t((at - std::floor(at)) * ((size + trialBlockEdge - 1) / trialBlockEdge)) *
           trialBlockEdge;
  };
  const uint32_t x = place(0.7548776662466927, frame.width),
                 y = place(0.5698402909980532, frame.height);
  return {x, y, std::min(x + trialBlockEdge, frame.width),
          std::min(y + trialBlockEdge, frame.height)};
}

void prepareTrial(edit::FrameSettingsT& frame) {
  frame.channels |= RT_VARIANCE;
  frame.lightStride = 1;
  frame.clamp = 0; // clipped samples would hide what a trial is about
}

} // namespace openrt
