#include "behaviour/figures/playback.h"

#include <algorithm>
#include <cmath>

namespace xvrml {
namespace {

// Later frames are not counted: years of any motion, and no product of it with a number of frames
// is too large for 64 bits.
constexpr double mostFrames = 4e9;

// A frame begins this part of its duration early, so that the time of a multiple of the duration,
// which is rounded, has the frame that begins there.
constexpr double early = 1e-6;

int64_t floorDivide(int64_t a, int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }

// Returns how many frames have been played when a cycle begins. offset: place of the first of them
// within the cycle.
int64_t framesBefore(int64_t cycle, int64_t length, int64_t offset, int64_t increment) {
  if (cycle == 0) return 0;
  if (increment > 0) return -floorDivide(offset - cycle * length, increment);
  return -floorDivide(cycle * length + length - 1 - offset, -increment);
}

} // namespace

PlayedFrame playedFrame(const PlayedFrames& played, int64_t from, double seconds) {
  const double passed = std::max(0.0, std::floor(seconds / played.duration + early));
  const auto count = static_cast<int64_t>(std::min(passed, mostFrames));
  const int64_t length = played.last - played.first + 1, offset = from - played.first;
  const int64_t place = offset + count * played.increment;
  PlayedFrame result;
  result.elapsed = std::max(0.0, seconds);
  if (played.loop) {
    result.cycle = floorDivide(place, length);
    result.frame = played.first + (place - result.cycle * length);
    const int64_t before = framesBefore(result.cycle, length, offset, played.increment);
    result.cycleBegan = static_cast<double>(before) * played.duration;
    return result;
  }
  result.frame = played.first + std::clamp<int64_t>(place, 0, length - 1);
  result.ended = place < 0 || place >= length;
  if (result.ended) {
    const int64_t way = played.increment > 0 ? length - 1 - offset : offset;
    const int64_t shown = way / std::abs(played.increment) + 1;
    // The last frame that is shown may lie before the end of the range.
    result.frame = from + (shown - 1) * played.increment;
    result.elapsed = static_cast<double>(shown) * played.duration;
  }
  return result;
}

} // namespace xvrml
