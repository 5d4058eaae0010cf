#include "start/world_clock.h"

#include <cmath>

#include "process/signals.h"

namespace vv {

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
