#include "window/pacing.h"

#include <algorithm>
#include <cmath>

namespace vv {

namespace {

constexpr int smallest = -12;    // scale 2^(-12/4): an eighth each way
constexpr int best = 4;          // 2^4 samples
constexpr double fill = 0.85;    // of a frame's time: the window needs some, too
constexpr double tooLong = 1.15; // in budgets: a smaller picture
constexpr double roomFor = 0.9;  // a better one would take at most this
constexpr int patience = 4;      // that many frames in a row
constexpr double inTime =
    0.7; // of what lies between frames that are in time: no smaller picture, no better one
constexpr double assumedPixel = 2e-7; // before anything is known: 800x600 in a tenth of a second

constexpr double leastSide = 64; // pixels

} // namespace

Pacing::Pacing(double framesPerSecond) : budget_(fill / std::clamp(framesPerSecond, 0.1, 1000.0)) {}

FrameSize Pacing::at(int step, int width, int height) const {
  if (step >= 0) return {width, height, 1 << step};
  // One scale for both sides: the picture keeps its shape.
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
    // Two in flight that follow each other as closely as they can: half of what one takes lies
    // between their ends. If they are begun less often, (seconds + alone) / 2 does: then they are
    // in time, and how much larger they could be is not known, since it may be the link that takes
    // the time.
    const double apart = std::max(seconds, inTime * (seconds + alone)) / 2,
                 light = seconds - overhead;
    seconds = std::min(seconds, apart);
    overhead = std::max(0.0, seconds - light);
  }
  // What has become slower counts at once for the most part: a frame that is late is seen, one that
  // could have been better is not.
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
  // The best that there is time for; where reading the world takes it all, half of the time again.
  const double budget = std::max(budget_, 1.5 * overhead_);
  const auto fitting = [&] {
    int step = best;
    while (step > smallest && seconds(step) > budget) --step;
    return step;
  };
  const double now = seconds(step_) / budget;
  if (begins || now > 2) {
    step_ = fitting();
    calm_ = 0;
  } else if (now > tooLong) {
    step_ = std::max(smallest, step_ - 1);
    calm_ = 0;
  } else if (step_ < best && seconds(step_ + 1) <= roomFor * budget) {
    if (++calm_ >= patience) {
      ++step_;
      calm_ = 0;
    }
  } else
    calm_ = 0;
  FrameSize frame = at(step_, width, height);
  frame.samples = std::min(frame.samples, std::max(samples, 1));
  return frame;
}

} // namespace vv
