#include "session/pacing.h"

#include <algorithm>
#include <cmath>

namespace vv {

namespace {

constexpr int smallest = -12; // scale 2^(-12/4): an eighth in each direction
constexpr int best = 4;       // quality step with 2^4 samples
constexpr double fill = 0.85; // fraction of a frame's time for rendering; the window needs the rest
constexpr double tooLong = 1.15; // times the budget: a slower frame shrinks the next picture
constexpr double roomFor = 0.9;  // multiple of the budget that a better step may take, as predicted
constexpr int patience = 4;      // number of consecutive frames with room before a better step
// Overlapping frames that are on time count as this fraction of their interval, so that the quality
// step stays the same.
constexpr double inTime = 0.7;
constexpr double assumedPixel = 2e-7; // initial guess in seconds: 800x600 in a tenth of a second

constexpr double leastSide = 64; // shortest side of a picture, in pixels

} // namespace

Pacing::Pacing(double framesPerSecond) : budget_(fill / std::clamp(framesPerSecond, 0.1, 1000.0)) {}

FrameSize Pacing::at(int step, int width, int height) const {
  if (step >= 0) return {width, height, 1 << step};
  // Both sides have the same scale, so the aspect ratio is kept.
  const double scale =
      std::min(1.0, std::max(std::exp2(step / 4.0), leastSide / std::min(width, height)));
  return {int(std::ceil(width * scale)), int(std::ceil(height * scale)), 1};
}

double Pacing::predicted(const FrameSize& f) const {
  return pixel_ > 0 ? overhead_ + pixel_ * f.width * f.height * f.samples : 0;
}

void Pacing::took(const FrameSize& frame, double seconds, double alone, double overhead,
                  double samples) {
  if (!(seconds >= 0) || !(alone >= 0) || !(overhead >= 0) || overhead > seconds) return;
  if (alone < seconds) {
    // Two frames in flight that follow each other closely end half of a frame's time apart. If
    // frames are started less often, the distance is (seconds + alone) / 2. Then they are on time,
    // and it is unknown how much larger they could be, because the network may take the time.
    const double apart = std::max(seconds, inTime * (seconds + alone)) / 2,
                 light = seconds - overhead;
    seconds = std::min(seconds, apart);
    overhead = std::max(0.0, seconds - light);
  }
  // Slower times count mostly at once, faster ones slowly: a late frame is visible, a missed
  // improvement is not.
  const auto follow = [](double& value, double now) {
    const double weight = now > 1.5 * value ? 0.8 : now > value ? 0.4 : 0.2;
    value = value > 0 ? value + weight * (now - value) : now;
  };
  follow(overhead_, overhead);
  const double work = double(frame.width) * frame.height * samples;
  if (work > 0 && std::isfinite(work)) follow(pixel_, (seconds - overhead) / work);
}

FrameSize Pacing::next(int width, int height, bool moving, int samples) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  const bool begins = moving && !moving_;
  moving_ = moving;
  if (!moving) return {width, height, std::max(samples, 1)};

  const double pixel = pixel_ > 0 ? pixel_ : assumedPixel;
  const auto seconds = [&](int step) {
    const FrameSize f = at(step, width, height);
    return overhead_ + pixel * f.width * f.height * f.samples;
  };
  // Find the best step within the budget. If reading the world takes all of it, allow half of that
  // time in addition.
  const double budget = std::max(budget_, 1.5 * overhead_);
  const auto fitting = [&] {
    int step = best;
    while (step > smallest && seconds(step) > budget) --step;
    return step;
  };
  const double now = seconds(step_) / budget;
  if (begins || now > 2) {
    step_ = fitting();
    framesWithRoom_ = 0;
  } else if (now > tooLong) {
    step_ = std::max(smallest, step_ - 1);
    framesWithRoom_ = 0;
  } else if (step_ < best && seconds(step_ + 1) <= roomFor * budget) {
    if (++framesWithRoom_ >= patience) {
      ++step_;
      framesWithRoom_ = 0;
    }
  } else
    framesWithRoom_ = 0;
  FrameSize frame = at(step_, width, height);
  frame.samples = std::min(frame.samples, std::max(samples, 1));
  return frame;
}

} // namespace vv
