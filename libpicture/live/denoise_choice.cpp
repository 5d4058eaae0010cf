#include "libpicture/live/denoise_choice.h"

#include <algorithm>
#include <cmath>

namespace picture::live {

namespace {

constexpr double share = 0.3;       // part of a frame's time that the library may take in motion
constexpr double room = 0.7;        // fraction of the allowed time at which it gets its turn
constexpr double weightOfNew = 0.3; // a measurement's weight in the mean
constexpr int longestPause = 1 << 20;

} // namespace

double denoisingInMotion(double framesPerSecond) {
  return share / std::clamp(framesPerSecond, 0.1, 1000.0);
}

void DenoiseTime::took(double pixels, double seconds) {
  if (!(pixels > 0) || !(seconds >= 0)) return;
  const double now = seconds / pixels;
  perPixel_ = std::isfinite(perPixel_) ? perPixel_ + weightOfNew * (now - perPixel_) : now;
}

bool DenoiseSwitch::next(double seconds, double allowed) {
  wait_ = std::max(0, wait_ - 1);
  if (allowed != allowed_) {
    allowed_ = allowed;
    on_ = wait_ == 0 && seconds <= room * allowed;
  } else if (!on_) {
    on_ = wait_ == 0 && seconds <= room * allowed;
  } else if (seconds > allowed) {
    on_ = false;
    wait_ = pause_;
    pause_ = std::min(2 * pause_, longestPause);
  }
  return on_;
}

} // namespace picture::live
