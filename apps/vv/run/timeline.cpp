#include "run/timeline.h"

#include <numbers>

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

} // namespace vv
