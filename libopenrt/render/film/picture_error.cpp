// picture_error.cpp: the error of the whole picture.
//
// A pixel's own variance is not reliable where light is rare. Pixels that have missed it have too
// small a variance, and the mean of the roots of variances is less than the root of their mean.
// These pixels also have an error of their own: the light that they have missed, relative to their
// dark value. Therefore:
// * Third cumulants, pooled over the surrounding pixels, give the share of rare jumps (hits of rare
//   light) in the variance, and the mean number of jumps per pixel (method of moments for a normal
//   plus a Poisson variable). Closed sums then give the ratio of E|error| to the value that the
//   pixels' own variances suggest.
// * Errors sum to zero: pixels with jumps are too bright by as much as the others are too dark. The
//   deficit of the latter is distributed over the surrounding pixels, each relative to its own
//   colours. The window is chosen so large that it contains some jumps.
// * The interval is a prediction interval. It covers how far the errors of one picture scatter
//   about their expectation, and how well the number of jumps determines this expectation. Pixels
//   are treated as independent.
#include "render/film/picture_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "render/film/error.h"

namespace openrt {
namespace {

constexpr double meanOfNormal = 0.797884560802865; // E|z|
// Variance of |z|, and of the scale estimated from 16 replicates, over E z^2.
constexpr double varianceOfNormal = 1 - 2 / M_PI + .033;
constexpr double fewestJumps = 8; // minimum number of jumps in the window
// Fourth over squared second cumulant below which a tail is ignored.
constexpr double negligibleExcess = .1;
constexpr double lowerHalf = .72;  // mean of the lower half of variances with 15 degrees of freedom
constexpr double unsureShape = .3; // relative uncertainty of the correction by tailShape()
// Relative uncertainty of the errors of random pixels: neighbours have correlated errors.
constexpr double unsureScale = .6;
constexpr double mostJumps = 24;                 // above this a Poisson variable is taken as normal
constexpr std::array<uint32_t, 2> reaches{2, 5}; // window sizes: number of pixels to each side

double normalDensity(double x) { return 0.398942280401433 * std::exp(-.5 * x * x); }
double normalBelow(double x) { return .5 * std::erfc(-x * 0.707106781186548); }

// Returns E|x| of a normal variable.
double foldedMean(double mean, double deviation) {
  if (!(deviation > 0)) return std::fabs(mean);
  const double t = mean / deviation;
  return 2 * deviation * normalDensity(t) + mean * (2 * normalBelow(t) - 1);
}

// Returns E min(1, |x|) of a normal variable of mean 0 for which E|x| = expected.
double cappedMean(double expected) {
  if (!(expected > .1)) return expected;
  if (!(expected < 1e6)) return 1;
  const double s = expected / meanOfNormal;
  return 2 * s * (normalDensity(0) - normalDensity(1 / s)) + 2 * (1 - normalBelow(1 / s));
}

struct Cumulants { // relative cumulants, summed over pixels
  double pixels = 0, second = 0, third = 0, fourth = 0, square = 0;
  void add(const Cumulants& c) {
    pixels += c.pixels;
    second += c.second;
    third += c.third;
    fourth += c.fourth;
    square += c.square;
  }
  double jumps() const { // effective number of jumps among these pixels
    if (!(second > 0)) return 0;
    return fourth > 0 ? second * second / fourth : std::numeric_limits<double>::infinity();
  }
  // Returns whether errors have a tail; otherwise they are treated as normal. Squares are summed
  // pixel by pixel, because pixels with different noise are no tail.
  bool tailed() const {
    return second > 0 && third > 0 && fourth > negligibleExcess * std::max(square, 0.0);
  }
  // Estimates the tail's shape. seconds: the pixels' second cumulants; they are reordered. met:
  // gets the minimum second cumulant of a pixel with a jump.
  TailShape shape(std::vector<double>& seconds, double& met) const {
    if (!tailed()) return {};
    const double k2 = second / pixels, k3 = third / pixels;
    const auto middle = seconds.begin() + std::ptrdiff_t(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    double normal = *middle; // variance of pixels without a jump: mean of the lower half
    for (auto at = seconds.begin(); at != middle; ++at) normal += *at;
    normal /= double(middle - seconds.begin() + 1) * lowerHalf;
    // This estimate is too large if most pixels have a jump. Then the cumulants of equal jumps
    // bound it.
    normal = std::min(normal, std::max(0.0, k2 - k3 * k3 * pixels / fourth));
    const double rest = k2 - normal;
    if (!(rest > 0)) return {};
    // Two estimates of the mean number of jumps. alike: right if all pixels are alike. apart: right
    // if some pixels have many jumps and others none.
    const double alike = rest * rest * rest / (k3 * k3),
                 apart = square * (rest / k2) * (rest / k2) / fourth;
    const double jumps = std::min(std::max(alike, apart), mostJumps);
    met = normal + .5 * rest / jumps;
    return tailShape(normal / rest, jumps);
  }
};

class PictureErrorEstimator {
 public:
  PictureErrorEstimator(uint32_t width, std::span<const PixelNoise> pixels,
                        std::span<const float> doubted)
      : width_(width), height_(uint32_t(pixels.size()) / width), pixels_(pixels), doubted_(doubted),
        stay_(pixels.size()), spread_(pixels.size()), missing_(pixels.size()), part_(pixels.size()),
        met_(pixels.size()), reach_(pixels.size()) {}

  PictureError make() {
    collectCumulants();
    for (size_t i = 0; i < pixels_.size(); i++) splitError(i);
    distribute();
    return sum();
  }

 private:
  // Calls f(pixel) for the random pixels of the window about pixel i.
  template <class F> void window(size_t i, uint32_t reach, const F& f) const {
    const auto x = uint32_t(i % width_), y = uint32_t(i / width_);
    for (uint32_t v = y - std::min(y, reach); v <= std::min(y + reach, height_ - 1); v++)
      for (uint32_t u = x - std::min(x, reach); u <= std::min(x + reach, width_ - 1); u++)
        if (const size_t at = size_t(v) * width_ + u; random(at)) f(at);
  }
  // Returns the pixel's share of the missing light: proportional to its brightness if it has had no
  // jump, else 0.
  double lacking(size_t i, double met) const {
    return random(i) && own_[i].second < met ? double(pixels_[i].scale) : 0;
  }
  bool random(size_t i) const { return pixels_[i].finished && pixels_[i].random; }

  void collectCumulants() {
    own_.resize(pixels_.size());
    for (size_t i = 0; i < pixels_.size(); i++) {
      if (!random(i)) continue;
      // Cumulants are relative to the mean brightness of the 3x3 window. Relative to the pixel's
      // own brightness, pixels with a hit would count for less.
      double scale = 0, n = 0;
      window(i, 1, [&](size_t at) {
        scale += double(pixels_[at].scale);
        n++;
      });
      scale /= n;
      const PixelNoise& p = pixels_[i];
      largest_ = std::max(largest_, double(p.largest));
      if (!std::isfinite(p.second) || !std::isfinite(p.fourth)) continue;
      const double s2 = scale * scale;
      // Scaled so that three equal colours count as one colour would.
      own_[i] = {1, double(p.second) / s2 / std::sqrt(3.0),
                 double(p.third) / (s2 * scale) / std::pow(3.0, .25), double(p.fourth) / (s2 * s2),
                 double(p.square) / (s2 * s2)};
      all_.add(own_[i]);
    }
    if (all_.tailed())
      for (size_t i = 0; i < pixels_.size(); i++)
        if (random(i)) seconds_.push_back(own_[i].second);
    allShape_ = all_.shape(seconds_, allMet_);
  }

  // Splits the pixel's error into the part at the pixel itself and the part at its neighbours.
  void splitError(size_t i) {
    const PixelNoise& p = pixels_[i];
    if (!p.finished || !std::isnan(doubted_[i])) return;
    stay_[i] = double(p.own);
    if (!random(i) || !(p.own > 0)) return;
    Cumulants c;
    uint32_t reach = 0;
    for (uint32_t r : reaches) {
      c = {};
      reach = r;
      window(i, r, [&](size_t at) { c.add(own_[at]); });
      if (c.jumps() >= fewestJumps) break;
    }
    const bool few = c.jumps() < fewestJumps;
    double met = allMet_, without = 0;
    if (!few && !c.tailed()) return;
    seconds_.clear();
    if (!few) window(i, reach, [&](size_t at) { seconds_.push_back(own_[at].second); });
    const TailShape shape = few ? allShape_ : c.shape(seconds_, met);
    // lack: number of pixels without a jump; all: of all pixels in the window
    double lack = 0, all = 0;
    if (shape.missing > 0)
      window(i, reach, [&](size_t at) {
        all++;
        without += lacking(at, met);
        lack += lacking(at, met) > 0 ? 1 : 0;
      });
    const double alike =
        std::max(1.0, all - lack) *
        shape.without; // expected number of pixels without a jump among those that can have jumps
    const double expected = double(p.own) * shape.factor;
    corrected_ += std::fabs(expected - double(p.own)) / double(p.scale);
    missing_[i] = without > 0 ? shape.missing : 0;
    spread_[i] = missing_[i] * expected;
    stay_[i] = expected - spread_[i];
    // No neighbour lacks a larger fraction of its light than the relative error of pixel i.
    if (without > 0)
      part_[i] =
          std::min(spread_[i] / without, std::min(1.0, alike / lack) * expected / double(p.scale));
    reach_[i] = reach;
    met_[i] = met;
  }

  void distribute() {
    lack_.assign(pixels_.size(), 0);
    for (size_t i = 0; i < pixels_.size(); i++) {
      if (!(spread_[i] > 0)) continue;
      window(i, reach_[i], [&](size_t at) { lack_[at] += part_[i] * lacking(at, met_[i]); });
    }
  }

  PictureError sum() {
    PictureError out;
    double n = 0, unseen = 0, unknown = 0, doubts = 0;
    const bool nothing = all_.pixels > 0 && !(largest_ > 0);
    // If almost nothing has been hit at all, the largest sample may be what was missed.
    const double bound =
        all_.pixels > 0 && !(all_.jumps() > ruleOfThree) ? ruleOfThree * largest_ / all_.pixels : 0;
    std::vector<double> kept(pixels_.size()), slopes(pixels_.size());
    for (size_t i = 0; i < pixels_.size(); i++) {
      const PixelNoise& p = pixels_[i];
      if (!p.finished) continue;
      n++;
      if (!std::isnan(doubted_[i])) {
        kept[i] = double(doubted_[i]);
        out.mean += kept[i];
        doubts += kept[i];
        continue;
      }
      if (random(i) && nothing) {
        unknown++;
        continue;
      }
      const double scale = double(p.scale), stay = stay_[i] / scale, lack = lack_[i] / scale,
                   rare = 2 * missing_[i];
      kept[i] = (1 - rare) * cappedMean(stay) + rare * std::min(1.0, stay);
      const double expected = std::min(1.0, kept[i] + lack);
      out.mean += expected;
      corrected_ += std::min(1.0, lack);
      slopes[i] = kept[i] + lack > 0 ? expected / (kept[i] + lack) / scale : 1 / scale;
      kept[i] *= kept[i] + lack > 0 ? expected / (kept[i] + lack) : 1;
      if (!random(i)) continue;
      unseen += std::min(1 - expected, bound / scale);
    }
    if (n == 0) return out;
    double variance = 0, fourth = 0;
    for (size_t i = 0; i < pixels_.size(); i++) {
      double scattered = 0; // this pixel's contribution to the errors of others
      if (spread_[i] > 0) {
        window(i, reach_[i], [&](size_t at) { scattered += slopes[at] * lacking(at, met_[i]); });
        scattered *= part_[i];
      }
      const double k = kept[i] / meanOfNormal;
      double v = varianceOfNormal * (1 - 2 * missing_[i]) * k * k + scattered * scattered;
      if (!std::isnan(doubted_[i]))
        v = kept[i] *
            // own: the error of the pixel if it has an edge
            std::max(0.0, double(pixels_[i].own) - kept[i]);
      variance += v;
      fourth += v * v;
    }
    const double freedom = fourth > 0 ? variance * variance / fourth : 1;
    const double prediction = student95(std::max(1.0, freedom - 1)) * std::sqrt(variance),
                 unsure = unsureShape * corrected_;
    const double common = unsureScale * (out.mean - doubts);
    // The number of doubted pixels with an edge depends on the scene: from none to twice as many as
    // expected.
    out.interval = std::sqrt(prediction * prediction + unsure * unsure + common * common +
                             unseen * unseen + doubts * doubts);
    // If nothing has been hit at all, the error may be anything.
    out.mean += .5 * unknown;
    out.interval += .5 * unknown;
    out.mean /= n;
    out.interval /= n;
    // The error lies between 0 and 1.
    out.interval = std::min(out.interval, std::max(out.mean, 1 - out.mean));
    return out;
  }

  const uint32_t width_, height_;
  std::span<const PixelNoise> pixels_;
  std::span<const float> doubted_;
  std::vector<Cumulants> own_;
  Cumulants all_;
  TailShape allShape_;
  double largest_ = 0, corrected_ = 0, allMet_ = 0;
  std::vector<double> stay_, spread_, missing_, lack_;
  // part_: the pixel's relative share of what its neighbours lack. met_: second cumulant from which
  // a pixel is taken to have a jump.
  std::vector<double> part_, met_;
  std::vector<double> seconds_; // working storage
  std::vector<uint32_t> reach_; // window size
};

} // namespace

TailShape tailShape(double variance, double jumps) {
  TailShape out;
  if (!(jumps > 0) || !(jumps < mostJumps)) return out;
  // All values are in units of a jump.
  const double normal = std::sqrt(variance * jumps);
  const auto most = uint32_t(jumps + 6 * std::sqrt(jumps) + 6);
  double probability = std::exp(-jumps), error = 0, estimated = 0;
  for (uint32_t k = 0; k <= most; k++, probability *= jumps / k) {
    const double e = foldedMean(k - jumps, normal),
                 own = meanOfNormal * std::sqrt(normal * normal + k);
    if (k == 0) out.missing = probability * std::max(0.0, e - own);
    error += probability * e;
    estimated += probability * own;
  }
  if (!(estimated > 0) || !(error > 0)) return {};
  out.without = 1 / std::expm1(jumps);
  out.factor = std::max(1.0, error / estimated);
  out.missing = std::min(.5, out.missing / error);
  return out;
}

PictureError pictureError(uint32_t width, std::span<const PixelNoise> pixels,
                          std::span<const float> doubted) {
  if (pixels.empty()) return {};
  return PictureErrorEstimator(width, pixels, doubted).make();
}

} // namespace openrt
