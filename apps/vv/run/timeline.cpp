#include "run/timeline.h"

#include <algorithm>
#include <numbers>

#include "libpicture/files/read_note.h"
#include "libpicture/files/whole.h"
#include "libpicture/live/film_history.h"
#include "options/names.h"

namespace vv {

namespace {

// Returns whether a frame lacks one of its files, or has one that an interrupt cut short.
bool isMissing(const Options& options, long long frame) {
  return std::any_of(options.outputs.begin(), options.outputs.end(), [&](const Output& output) {
    if (!output.format) return false;
    const std::string path = pathFor(output.path, {{}, frame});
    return !picture::isWholePicture(path, *output.format) ||
           picture::readNote(path) == picture::unfinishedNote;
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
  if (options_.frames)
    return momentOf(i < missing_.size() && missing_.size() == count_
                        ? missing_[i]
                        : options_.frames->first +
                              static_cast<long long>(i) * options_.frames->step);
  if (options_.turntable > 0) return momentOf(static_cast<long long>(i));
  return {options_.time.value_or(0)};
}

std::vector<Moment> Timeline::withHistory(size_t i) const {
  std::vector<Moment> moments;
  const Moment shown = (*this)[i];
  if (options_.render.preview) {
    long long next = picture::live::FilmHistory::firstFor(*shown.frame);
    if (i > 0) next = std::max(next, *(*this)[i - 1].frame + 1);
    for (; next < *shown.frame; ++next) {
      moments.push_back(momentOf(next));
      moments.back().isShown = false;
    }
  }
  moments.push_back(shown);
  return moments;
}

Moment Timeline::momentOf(long long frame) const {
  if (options_.frames) return {double(std::max(0LL, frame)) / options_.fps, frame};
  const long long count = options_.turntable, place = (frame % count + count) % count;
  return {options_.time.value_or(0), frame, 2 * std::numbers::pi * double(place) / double(count)};
}

} // namespace vv
