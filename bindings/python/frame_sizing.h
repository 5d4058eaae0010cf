// frame_sizing.h: Chooses the size and the samples of the frames that a view shows while something
// moves. Up to full size the frame rate falls from 30 to 15 a second; only then does the size fall.
// Pure arithmetic without clock or thread. Owned by a Viewer.
#pragma once

#include <algorithm>
#include <cmath>

struct FrameSize {
  int width = 1, height = 1, samples = 1;
  bool operator==(const FrameSize&) const = default;
};

class FrameSizing {
 public:
  // Records a frame that has ended. overhead: part of `seconds` before tracing. samples: samples
  // taken, mean over the pixels.
  void took(const FrameSize& frame, double seconds, double overhead, double samples) {
    const double work = double(frame.width) * frame.height * samples;
    if (!(overhead >= 0) || !(seconds >= overhead) || !(work > 0)) return;
    follow(overhead_, overhead);
    follow(pixel_, (seconds - overhead) / work);
  }

  // Returns the next frame for a view of this size.
  FrameSize next(int width, int height) {
    const int fitting = fittingStep(width, height);
    framesWithRoom_ = fitting > step_ ? framesWithRoom_ + 1 : 0;
    if (fitting < step_ || !begun_) {
      step_ = fitting;
    } else if (framesWithRoom_ >= patience) {
      ++step_;
      framesWithRoom_ = 0;
    }
    begun_ = true;
    return at(step_, width, height);
  }

 private:
  static constexpr int smallest = -12; // scale 2^(-12/4): an eighth in each direction
  static constexpr int best = 4;       // full size with 2^4 samples
  static constexpr int patience = 4;   // frames in a row with room before a better step
  static constexpr double leastSide = 64;
  static constexpr double share = 0.85; // part of a frame's time for rendering
  static constexpr double assumedPixel = 2e-7;

  // Slower times count mostly at once, faster ones slowly: a late frame is visible.
  static void follow(double& value, double now) {
    const double weight = now > 1.5 * value ? 0.8 : now > value ? 0.4 : 0.2;
    value = value > 0 ? value + weight * (now - value) : now;
  }

  static FrameSize at(int step, int width, int height) {
    if (step >= 0) return {width, height, 1 << step};
    const double scale =
        std::min(1.0, std::max(std::exp2(step / 4.0), leastSide / std::min(width, height)));
    return {int(std::ceil(width * scale)), int(std::ceil(height * scale)), 1};
  }

  // Returns the best step that keeps the frame rate: 30 a second with more than one sample, else
  // 15. If reading the world takes that time, half of it is allowed in addition.
  int fittingStep(int width, int height) const {
    const double pixel = pixel_ > 0 ? pixel_ : assumedPixel;
    int step = best;
    for (; step > smallest; --step) {
      const FrameSize f = at(step, width, height);
      const double budget = std::max(share / (step > 0 ? 30 : 15), 1.5 * overhead_);
      if (overhead_ + pixel * f.width * f.height * f.samples <= budget) break;
    }
    return step;
  }

  // seconds per sample of a pixel, seconds per frame; both smoothed
  double pixel_ = 0, overhead_ = 0;
  int step_ = 0, framesWithRoom_ = 0;
  bool begun_ = false;
};
