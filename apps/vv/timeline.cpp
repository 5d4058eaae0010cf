#include "timeline.h"

#include <cmath>
#include <numbers>

#include "signals.h"

namespace vv {

Timeline::Timeline(const Options& options) : options_(options) {
  if (options.frames)
    count_ = size_t((options.frames->last - options.frames->first) / options.frames->step) + 1;
  if (options.turntable > 0) count_ = size_t(options.turntable);
}

Moment Timeline::operator[](size_t i) const {
  if (options_.frames) {
    const long long frame =
        options_.frames->first + static_cast<long long>(i) * options_.frames->step;
    return {double(frame) / options_.fps, frame};
  }
  Moment moment{options_.time.value_or(0)};
  if (options_.turntable > 0) {
    moment.frame = static_cast<long long>(i);
    moment.turn = 2 * std::numbers::pi * double(i) / double(options_.turntable);
  }
  return moment;
}

double timeOfStep(double time, double fps) {
  double step = std::ceil(time * fps);
  // The product may be rounded to either side.
  while (step > 0 && (step - 1) / fps >= time) --step;
  while (step / fps < time) ++step;
  return step / fps;
}

bool WorldClock::advance(double time) {
  if (currentTime_ == time) return true; // each moment is ticked once
  for (; double(next_) / fps_ < time; ++next_) {
    if (interrupted()) return false;
    tick_(double(next_) / fps_);
  }
  if (double(next_) / fps_ == time) ++next_;
  tick_(time);
  currentTime_ = time;
  return true;
}

} // namespace vv
