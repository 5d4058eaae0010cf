#include "run/timeline.h"

#include <algorithm>
#include <numbers>

#include "libpicture/files/whole.h"
#include "options/names.h"

namespace vv {

namespace {

// Returns whether a frame lacks one of its files.
bool isMissing(const Options& options, long long frame) {
  return std::any_of(options.outputs.begin(), options.outputs.end(), [&](const Output& output) {
    return output.format &&
           !picture::isWholePicture(pathFor(output.path, {{}, frame}), *output.format);
  });
}

} // namespace

Timeline::Timeline(const Options& options) : options_(options) {
  if (options.frames)
    count_ = size_t((options.frames->last - options.frames->first) / options.frames->step) + 1;
  if (options.missing) {
    for (size_t i = 0; i < count_; ++i)
      if (const long long frame = *(*this)[i].frame; isMissing(options, frame))
        missing_.push_back(frame);
    count_ = missing_.size();
  }
  if (options.turntable > 0) count_ = size_t(options.turntable);
}

Moment Timeline::operator[](size_t i) const {
  if (options_.frames) {
    const long long frame =
        i < missing_.size() && missing_.size() == count_
            ? missing_[i]
            : options_.frames->first + static_cast<long long>(i) * options_.frames->step;
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
