#include "libpicture/live/pacing.h"

#include <algorithm>
#include <cmath>

#include "libpicture/transport.h"

namespace picture {

namespace {

constexpr int smallest = -12;                     // scale 2^(-12/4): an eighth in each direction
constexpr int mostDoublings = 4;                  // the best step has 2^4 samples
constexpr int quarter = -8, half = -4, whole = 0; // steps: size in each direction

// Holds what Pacing::Light decides.
struct Rule {
  // Pixels each way of the blocks in which one pixel gets light in motion; there is a step of the
  // full size for each smaller number.
  int widestStride;
  // Assumed cost of what a pixel without light shows, in costs of the light of a pixel.
  double unlit;
  // The step below which the frame rate falls before the picture shrinks.
  int kept;
};
constexpr Rule rules[] = {{1, 0.15, quarter}, {2, 0.15, half}, {1, 0.6, whole}, {2, 0.6, whole}};
constexpr const Rule& ruleOf(Pacing::Light light) { return rules[size_t(light)]; }
constexpr double slower = 1.5;    // the budget of that step and of smaller ones, in budgets
constexpr double settling = 0.09; // seconds of a frame between motion and rest
constexpr double fill = 0.85; // fraction of a frame's time for rendering; the window needs the rest
constexpr double tooLong = 1.15; // times the budget: a slower frame shrinks the next picture
constexpr double roomFor = 0.9;  // multiple of the budget that a better step may take, as predicted
constexpr int patience = 4;      // number of consecutive frames with room before a better step
// Overlapping frames that are on time count as this fraction of their interval, so that the quality
// step stays the same.
constexpr double inTime = 0.7;

constexpr double leastSide = 64; // shortest side of a picture, in pixels

constexpr double mostShowing =
    0.5;                          // part of a frame's time that the size of what is shown may take
constexpr int smallestShown = -8; // a quarter of the window in each direction
// Returns the scale of a size in each direction.
double scaleOf(int step) { return std::exp2(step / 4.0); }

} // namespace

Pacing::Pacing(double framesPerSecond) : budget_(fill / std::clamp(framesPerSecond, 0.1, 1000.0)) {}

FrameSize Pacing::at(int step, int width, int height) const {
  const int strides = ruleOf(light_).widestStride - 1;
  if (step >= strides) return {width, height, 1 << (step - strides)};
  if (step >= 0) return {width, height, 1, strides + 1 - step};
  // Both sides have the same scale, so the aspect ratio is kept.
  const double scale = std::min(1.0, std::max(scaleOf(step), leastSide / std::min(width, height)));
  return {int(std::ceil(width * scale)), int(std::ceil(height * scale)), 1, strides + 1};
}

int Pacing::best() const { return mostDoublings + ruleOf(light_).widestStride - 1; }

double Pacing::costOf(const FrameSize& f) const {
  const double unlit = ruleOf(light_).unlit, lit = 1.0 / (f.lightStride * f.lightStride);
  return f.samples * (unlit + lit) / (unlit + 1);
}

double Pacing::seconds(const FrameSize& f) const {
  return overhead_ + showing_ + (rebuilt_ + pixel_ * costOf(f)) * f.width * f.height;
}

double Pacing::predicted(const FrameSize& f) const { return pixel_ > 0 ? seconds(f) : 0; }

void Pacing::took(const FrameSize& frame, double seconds, double alone, double overhead,
                  double samples, double rebuilding, double showing) {
  if (!(seconds >= 0) || !(alone >= 0) || !(overhead >= 0) || !(rebuilding >= 0) ||
      !(showing >= 0) || showing > rebuilding || overhead + rebuilding > seconds * (1 + 1e-9))
    return;
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
  // improvement is not. While the first frames grow, the last one alone counts.
  const auto follow = [this](double& value, double now) {
    const double weight = growing_ ? 1 : now > 1.5 * value ? 0.8 : now > value ? 0.4 : 0.2;
    value = value > 0 ? value + weight * (now - value) : now;
  };
  // A structure that is built once is not built again, so only what two frames in a row have needed
  // counts.
  follow(overhead_, std::min(overhead, lastOverhead_));
  lastOverhead_ = overhead;
  measured_ = true;
  const double pixels = double(frame.width) * frame.height,
               work = pixels * (frame.lightStride > 1 ? costOf(frame) : samples);
  if (rebuilding > 0 && pixels > 0) {
    follow(rebuilt_, (rebuilding - showing) / pixels);
    follow(showing_, showing);
  }
  if (work > 0 && std::isfinite(work))
    follow(pixel_, std::max(0.0, seconds - overhead - rebuilding) / work);
}

FrameSize Pacing::next(int width, int height, bool moving, int samples, Light light) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  const bool begins = moving && (!moving_ || light != light_);
  light_ = light;
  moving_ = moving;
  if (!moving) return {width, height, std::max(samples, 1)};

  // Compares the time of a step with its budget. If reading the world takes all of it, half of that
  // time is allowed in addition.
  const auto load = [&](int step) {
    const double budget =
        std::max(step <= ruleOf(light).kept ? slower * budget_ : budget_, 1.5 * overhead_);
    return seconds(at(step, width, height)) / budget;
  };
  const auto fitting = [&] {
    int step = best();
    while (step > smallest && load(step) > 1) --step;
    return step;
  };
  // The first frame is as small as possible, and each one after it is as large as the one before
  // allows, until they grow no more.
  const double now = load(step_);
  if (!(pixel_ > 0)) {
    step_ = smallest;
  } else if (growing_) {
    const int before = step_;
    if (measured_ || begins) step_ = fitting();
    growing_ = !measured_ || step_ > before;
    framesWithRoom_ = 0;
  } else if (begins || now > 2) {
    step_ = fitting();
    framesWithRoom_ = 0;
  } else if (now > tooLong) {
    step_ = std::max(smallest, step_ - 1);
    framesWithRoom_ = 0;
  } else if (step_ < best() && load(step_ + 1) <= roomFor) {
    if (++framesWithRoom_ >= patience) {
      ++step_;
      framesWithRoom_ = 0;
    }
  } else
    framesWithRoom_ = 0;
  measured_ = false;
  FrameSize frame = at(step_, width, height);
  frame.samples = std::min(frame.samples, std::max(samples, 1));
  return frame;
}

FrameSize Pacing::shown(int width, int height) {
  // The time of the next smaller and the next larger size follows from their pixels.
  const double most = mostShowing * budget_, larger = scaleOf(1) * scaleOf(1);
  int step = shownStep_;
  if (showing_ > tooLong * most)
    step = std::max(smallestShown, step - 1);
  else if (showing_ * larger < roomFor * most)
    step = std::min(0, step + 1);
  if (step != shownStep_) showing_ *= step > shownStep_ ? larger : 1 / larger;
  shownStep_ = step;
  return {std::max(1, int(std::ceil(width * scaleOf(step)))),
          std::max(1, int(std::ceil(height * scaleOf(step))))};
}

FrameSize Pacing::settle(int width, int height, int samples) const {
  width = std::max(width, 1);
  height = std::max(height, 1);
  int step = pixel_ > 0 ? best() : step_;
  while (step > step_ && seconds(at(step, width, height)) > std::max(settling, 1.5 * overhead_))
    --step;
  FrameSize frame = at(step, width, height);
  frame.samples = std::min(frame.samples, std::max(samples, 1));
  return frame;
}

Pacing::Light lightOf(const RTstats& stats, bool rebuilt) {
  const RTtransportInfo transport = transportInfo(stats.transport.chosen);
  const bool direct = transport.name && !transport.tracesPaths;
  if (stats.rays.camera > 0 && direct)
    return rebuilt ? Pacing::Light::sparseDirect : Pacing::Light::direct;
  return rebuilt ? Pacing::Light::sparse : Pacing::Light::sampled;
}

Pacing::Light rawOf(Pacing::Light light) {
  if (light == Pacing::Light::sparse) return Pacing::Light::sampled;
  return light == Pacing::Light::sparseDirect ? Pacing::Light::direct : light;
}

} // namespace picture
