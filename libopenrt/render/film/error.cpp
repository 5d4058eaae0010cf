// error.cpp: error bars from replicates.
//
// Replicated randomised quasi-Monte Carlo: A. B. Owen, "Monte Carlo theory, methods and examples",
// 17.3 (error estimation from independent randomisations), with Student's interval over the means
// of the replicates.
//
// A pixel's own estimate of that variance is not enough. Samples of light are skewed, and a pixel
// that has missed a rare event has both too small a mean and too small a variance: only 89 % of
// such intervals contained the true value instead of 95 % (scene `room` of the audit). The variance
// of the surrounding 5x5 pixels does not depend on what this pixel has missed. With it 95 % of the
// intervals contain the true value. The weights of the two variances are estimated as well: where
// the variances of the window really differ, they differ by more than sampling noise explains (H.
// Bühlmann, E. Straub, "Glaubwürdigkeit für Schadensätze", 1970; for intervals G. K. Smyth, "Linear
// models and empirical Bayes methods", 2004).
#include "render/film/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "render/film/light_image.h"
#include "render/wave/random_numbers.h"
#include "scene/quality.h"
#include "student.h"

namespace openrt {
namespace {

// Defaults of frames whose error is requested.
constexpr uint32_t fewestSamples = 32, fewestReplicates = 16;
constexpr uint32_t trustedReplicates = 8;
// number of pixels of a picture's window to each side; the window ends at the border of the tile
constexpr uint32_t pictureReach = 2;
constexpr uint32_t windowOf(uint32_t reach) { return (2 * reach + 1) * (2 * reach + 1); }
// fewestMeans: minimum effective number of replicate means that carry the variance of a window.
// fewestHits: minimum number of hits of a rare bright feature in a window.
constexpr double fewestMeans = 2.5, fewestHits = 4;
constexpr double negligible = .25; // fraction of a half-width

// Spread of the replicates' means of one colour of one pixel about their mean.
struct Spread {
  double variance = 0;    // k-statistic
  double uncertainty = 0; // unbiased variance of `variance`
  double fourth = 0;      // sum of fourth powers of the differences from the mean
  double k3 = 0, k4 = 0;  // k-statistics
};

Spread spreadOf(const PixelSums& s, int k, double size) {
  Spread out;
  const double r = s.replicates, m = s.closed[k] / r;
  const double second = s.closed2[k] - s.closed[k] * m;
  if (!(second > 1e-13 * s.closed2[k])) return out; // rounding of the subtraction
  const double fourth =
      s.closed4[k] - 4 * m * s.closed3[k] + 6 * m * m * s.closed2[k] - 3 * r * m * m * m * m;
  const double third = s.closed3[k] - 3 * m * s.closed2[k] + 2 * r * m * m * m;
  const double scale = 1 / (size * size);
  const double squares = second * scale;
  out.fourth = std::max(fourth, 0.0) * scale * scale;
  out.variance = squares / (r - 1);
  // Fisher's fourth k-statistic; Var(k2) = k4 / r + 2 k2^2 / (r - 1), with k2^2 corrected for its
  // own bias.
  if (r > 3) {
    out.k3 = r * third * scale / size / ((r - 1) * (r - 2));
    out.k4 = r * ((r + 1) * out.fourth - 3 * (r - 1) / r * squares * squares) /
             ((r - 1) * (r - 2) * (r - 3));
  }
  out.uncertainty = out.k4 / r + 2 / (r + 1) * (out.variance * out.variance - out.k4 / r);
  return out;
}

// Quantities that are summed over a window.
struct Cell {
  double count = 0, variance = 0, variance2 = 0, uncertainty = 0, fourth = 0;
  void scale(double s) {
    variance *= s;
    variance2 *= s * s;
    uncertainty *= s * s;
    fourth *= s * s;
  }
  void add(const Cell& c) {
    count += c.count;
    variance += c.variance;
    variance2 += c.variance2;
    uncertainty += c.uncertainty;
    fourth += c.fourth;
  }
};

// Sums cells over windows, in two passes. Each window is summed anew, so that no result depends on
// numbers outside of its window.
void sumWindows(std::vector<Cell>& cells, uint32_t width, uint32_t height, uint32_t reach) {
  std::vector<Cell> rows(cells.size());
  const auto pass = [&](const std::vector<Cell>& from, std::vector<Cell>& to, bool across) {
    for (uint32_t y = 0; y < height; y++)
      for (uint32_t x = 0; x < width; x++) {
        Cell& sum = to[size_t(y) * width + x] = {};
        const uint32_t at = across ? x : y, end = across ? width : height;
        for (uint32_t i = at - std::min(at, reach); i <= std::min(at + reach, end - 1); i++)
          sum.add(from[across ? size_t(y) * width + i : size_t(i) * width + x]);
      }
  };
  pass(cells, rows, true);
  pass(rows, cells, false);
}

// The variance of a pixel's replicates as estimated from a window.
struct Pool {
  // mean: mean of the window's variances. samplingVariance: variance of these due to sampling
  // noise. real: variance of these beyond sampling noise.
  double mean = 0, samplingVariance = 0, real = 0;
  explicit Pool(const Cell& window) {
    const double n = window.count;
    mean = window.variance / n;
    samplingVariance = std::max(window.uncertainty / n, 0.0);
    const double between =
        n > 1 ? std::max(0.0, window.variance2 / n - mean * mean) * n / (n - 1) : 0;
    real = std::max(0.0, between - samplingVariance);
  }
  double differing() const { return mean > 0 ? real / (mean * mean) : 0; }
  // Combines the pixel's own variance with the window's. Writes the degrees of freedom to
  // `freedom`.
  double combined(double own, double n, double replicates, double& freedom) const {
    const double weight =
        n > 1 && real + samplingVariance > 0 ? real / (real + samplingVariance) : 1;
    freedom = (replicates - 1) / (weight * weight + (1 - weight) * (1 - weight) / n);
    return mean + weight * (own - mean);
  }
};

// Detects rare bright features of a tile. Estimates from the fourth moments of the samples' grey
// how often the affected pixels have hit them.
struct Rare {
  // Sums over the pixels. square2: sum of (sum of squares)^2 / samples.
  double square2 = 0, fourth = 0, variance = 0;
  uint32_t pixels = 0;
  float largest[3] = {};

  void add(const PixelSums& s) {
    const double n = s.samples, sum = s.delta[0] + s.delta[1] + s.delta[2], m = sum / n;
    double second = s.grey[0] - sum * m;
    if (!(second > 1e-12 * std::fabs(s.grey[0]))) second = 0; // rounding of the subtraction
    const double g4 = s.grey[2] - 4 * m * s.grey[1] + 6 * m * m * s.grey[0] - 3 * n * m * m * m * m;
    square2 += second * second / n;
    fourth += std::max(g4, 0.0);
    variance += n > 1 ? second / (n * (n - 1)) : 0;
    pixels++;
    for (int k = 0; k < 3; k++) largest[k] = std::max(largest[k], s.largest[k]);
  }
  // Returns the mean number of hits. For light that a fraction p of n samples hits, fourth /
  // square2 is n / (1 + n p).
  double hits(double samples) const {
    if (!(fourth > 0)) return std::numeric_limits<double>::infinity();
    return std::max(samples * square2 / fourth - 1, 1 / double(pixels));
  }
  // Returns the mean contribution of rare features to a pixel: the root of hits^2 times the
  // variance that one hit causes.
  double mean(double samples) const { return std::sqrt(variance / pixels * hits(samples)); }
};

// Returns the mean of |x| of a normal x with estimated variance v, corrected for the bias of the
// root of a variance (the factor known as c4).
double meanError(double v, double freedom) {
  return std::sqrt(2 / M_PI * v) * (4 * freedom + 1) / (4 * freedom);
}

void finish(PixelError& e) {
  double half = 0;
  for (float h : e.halfWidth) half += double(h);
  e.relative = relativeError(half, e.mean);
}

// Returns the value that errors are relative to.
float scaleOf(const float mean[3]) {
  return darkest + std::fabs(mean[0]) + std::fabs(mean[1]) + std::fabs(mean[2]);
}

// Estimates the errors of a tile's pixels, colour by colour.
class TileErrors {
 public:
  TileErrors(uint32_t width, std::span<const PixelSums> pixels, const Replicates& replicates,
             Pooling pooling, std::span<PixelError> out)
      : width_(width), height_(uint32_t(pixels.size()) / width), pixels_(pixels),
        replicates_(replicates), reach_(pooling == Pooling::neighbours ? pictureReach : 0),
        out_(out), pooled_(pixels.size()) {}

  void make() {
    for (size_t i = 0; i < pixels_.size(); i++) {
      out_[i] = independentError(pixels_[i]);
      rare_.add(pixels_[i]);
    }
    if (!replicates_.many()) return;
    for (size_t i = 0; i < pixels_.size(); i++)
      if (pixels_[i].replicates >= 2) out_[i].noise.own = 0; // noteNoise() adds to it
    for (const bool random : {false, true})
      for (int k = 0; k < 3; k++) pool(random, k);
    for (size_t i = 0; i < pixels_.size(); i++) {
      const bool enough = pixels_[i].replicates >= trustedReplicates;
      if (out_[i].constant)
        out_[i].trusted = enough;
      else if (pixels_[i].replicates >= 2)
        judge(pixels_[i], pooled_[i], enough, out_[i]);
    }
  }

 private:
  struct Pooled { // pooled variance of a pixel
    double variance[3] = {}, freedom[3] = {};
    double window = 0; // number of pixels in the window
    bool few = false;  // only few replicates carry the window's variance
  };

  bool isRandom(size_t i) const { return pixels_[i].random != 0; }

  // Pools variances. Random and non-random pixels are pooled separately, and exact pixels not at
  // all. Noise may be equally strong everywhere, or proportional to the light. So two kinds of
  // variances are compared, and the kind that differs less within the window is pooled: the
  // variances themselves, and the variances relative to the brightness of the surrounding 3x3
  // pixels.
  void pool(bool random, int k) {
    std::vector<Cell> cells(pixels_.size()), relative;
    const std::vector<double> bright = brightness(random, k);
    for (size_t i = 0; i < pixels_.size(); i++) {
      if (isRandom(i) != random || out_[i].constant || pixels_[i].replicates < 2) continue;
      const Spread s = spreadOf(pixels_[i], k, replicates_.size());
      noteNoise(pixels_[i], s, out_[i].noise);
      cells[i] = {1, s.variance, s.variance * s.variance, s.uncertainty, s.fourth};
    }
    const std::vector<Cell> own = relative = cells;
    for (size_t i = 0; i < relative.size(); i++) relative[i].scale(1 / (bright[i] * bright[i]));
    sumWindows(cells, width_, height_, reach_);
    sumWindows(relative, width_, height_, reach_);
    for (size_t i = 0; i < pixels_.size(); i++) {
      if (own[i].count == 0) continue;
      Pooled& p = pooled_[i];
      const double r = pixels_[i].replicates,
                   parts = pixels_[i].samples / double(replicates_.size());
      const Pool plain(cells[i]), scaled(relative[i]);
      const bool byLight = scaled.differing() < plain.differing();
      const double unit = byLight ? bright[i] * bright[i] : 1;
      const Cell& window = byLight ? relative[i] : cells[i];
      const double n = window.count;
      p.variance[k] =
          unit * (byLight ? scaled : plain).combined(own[i].variance / unit, n, r, p.freedom[k]) /
          parts;
      p.window = n;
      const double squares = window.variance * (r - 1);
      p.few |= random && window.fourth * fewestMeans > squares * squares;
    }
  }

  // Returns the brightness of the surrounding 3x3 pixels: a pixel's own brightness would depend on
  // what it has missed.
  std::vector<double> brightness(bool random, int k) const {
    std::vector<double> out(pixels_.size(), 1);
    for (uint32_t y = 0; y < height_; y++)
      for (uint32_t x = 0; x < width_; x++) {
        double sum = 0, n = 0;
        for (uint32_t v = y - std::min(y, 1u); v <= std::min(y + 1, height_ - 1); v++)
          for (uint32_t u = x - std::min(x, 1u); u <= std::min(x + 1, width_ - 1); u++) {
            const size_t at = size_t(v) * width_ + u;
            if (isRandom(at) != random || out_[at].constant) continue;
            sum += std::fabs(double(out_[at].mean[k]));
            n++;
          }
        if (sum > 0) out[size_t(y) * width_ + x] = sum / n;
      }
    return out;
  }

  // Records a pixel's own spread. The error of the whole picture uses it independently of the
  // neighbours.
  void noteNoise(const PixelSums& sums, const Spread& s, PixelNoise& noise) const {
    const double parts = sums.samples / double(replicates_.size());
    noise.own += float(meanError(s.variance / parts, sums.replicates - 1.0));
    noise.second += float(s.variance / parts);
    noise.square += float((s.variance * s.variance - s.uncertainty) / (parts * parts));
    noise.third += float(s.k3 / (parts * parts));
    noise.fourth += float(s.k4 / (parts * parts * parts));
  }

  void judge(const PixelSums& s, const Pooled& p, bool enough, PixelError& e) const {
    // equal: all samples of the pixel and of its window are equal. dark: and so because random
    // paths may have found nothing. Where all have found light, and the same, as under an even sky,
    // only what covers a small part of the directions can be missing, and the rule of three bounds
    // that.
    const bool equal = s.random && !(p.variance[0] + p.variance[1] + p.variance[2] > 0);
    const bool dark = equal && (s.random & RandomPath::inVain);
    double half = 0;
    for (int k = 0; k < 3; k++) {
      double h = student95(p.freedom[k]) * std::sqrt(p.variance[k]);
      if (equal) // the rule of three applies, because no sample has hit anything else
        h = rare_.largest[k] > 0 ? ruleOfThree / (s.samples * p.window) * rare_.largest[k]
                                 : std::numeric_limits<double>::infinity();
      e.halfWidth[k] = float(h);
      half += h;
    }
    finish(e);
    e.dark = dark;
    e.trusted = enough && !dark && !p.few;
    // Some features are so rare that most windows have missed them. The means there lack their
    // light, and no variance shows it.
    const double hits = rare_.hits(s.samples) * std::min(windowOf(reach_), rare_.pixels);
    if (s.random && hits < fewestHits && rare_.mean(s.samples) > negligible * half)
      e.trusted = false;
  }

  uint32_t width_, height_;
  std::span<const PixelSums> pixels_;
  const Replicates& replicates_;
  uint32_t reach_; // pixels of the window to each side
  std::span<PixelError> out_;
  std::vector<Pooled> pooled_;
  Rare rare_;
};

} // namespace

double student95(double v) { return student::quantile95(v); }

Replicates replicatesOf(const edit::FrameSettingsT& frame, uint32_t samples, uint32_t seed) {
  uint32_t count = frame.replicates;
  if (count == 0) count = wantsError(frame) && samples >= fewestSamples ? fewestReplicates : 1;
  if (count <= 1) return {seed, 31};
  return {seed, uint32_t(std::bit_width(std::max(samples / count, 1u))) - 1};
}

PixelError independentError(const PixelSums& s) {
  PixelError e;
  if (s.samples == 0) return e;
  const double n = s.samples;
  bool varies = false;
  for (int k = 0; k < 3; k++) {
    const double squares = std::max(0.0, s.delta2[k] - s.delta[k] * s.delta[k] / n);
    varies |= squares > 1e-12 * s.delta2[k];
    const double v =
        s.samples > 1 ? squares / (n - 1) / n : std::numeric_limits<double>::infinity();
    e.halfWidth[k] = s.samples > 1 ? float(student95(n - 1) * std::sqrt(v)) : float(v);
    e.mean[k] = float(s.rgba[k] / n);
    e.noise.own += float(s.samples > 1 ? meanError(v, n - 1) : v);
    e.noise.largest += float(s.largest[k] / n);
  }
  e.samples = s.samples;
  e.constant = s.samples > 1 && !varies && !s.random;
  e.noise.scale = scaleOf(e.mean);
  e.noise.random = s.random != 0;
  e.noise.finished = true;
  finish(e);
  return e;
}

void tileErrors(uint32_t width, std::span<const PixelSums> pixels, const Replicates& replicates,
                std::span<PixelError> out, Pooling pooling) {
  TileErrors(width, pixels, replicates, pooling, out).make();
}

// Bounds what a sensor may lack whose random paths have found nothing, if light paths have. Without
// them the bound is infinite if nothing was found anywhere. With them it is that of the rule of
// three and the brightest cell. The reading is trusted if this hardly counts.
static void boundDark(const LightSums& light, PixelError& e) {
  double bound = 0, lamps = 0;
  for (int k = 0; k < 3; k++) {
    if (std::isinf(e.halfWidth[k]))
      e.halfWidth[k] = float(ruleOfThree / e.samples * light.brightest);
    bound += double(e.halfWidth[k]);
    lamps += student95(light.parts - 1) * std::sqrt(light.variance[k]);
  }
  e.trusted = bound <= negligible * lamps;
}

void addLight(const LightSums& light, PixelError& e) {
  if (e.dark && light.brightest > 0) boundDark(light, e);
  double half = 0, lamps = 0, own = 0;
  // Mean number of light paths per pixel.
  const double met = std::max(light.hits / light.window, 1e-3);
  for (int k = 0; k < 3; k++) {
    const double w = light.variance[k], h = student95(light.parts - 1) * std::sqrt(w);
    e.mean[k] += float(light.mean[k]);
    e.halfWidth[k] = float(std::hypot(double(e.halfWidth[k]), h));
    half += double(e.halfWidth[k]);
    lamps += h;
    own += meanError(w, light.parts - 1);
    e.noise.second += float(w);
    e.noise.square += float(w * w);
    e.noise.third += float(w * std::sqrt(w / met));
    e.noise.fourth += float(w * w / met);
  }
  e.noise.own = std::hypot(e.noise.own, float(own));
  e.noise.scale = scaleOf(e.mean);
  if (lamps > 0) {
    e.constant = false;
    e.noise.random = true;
  }
  if (lamps > negligible * half && light.hits < fewestPaths)
    e.trusted = false; // few light paths have contributed to the pixel
  e.relative = relativeError(half, e.mean);
}

double lightHalfWidth(const LightSums& light) {
  double half = 0;
  for (const double w : light.variance) half += student95(light.parts - 1) * std::sqrt(w);
  return half;
}

} // namespace openrt
