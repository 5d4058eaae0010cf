#include "libpicture/coverage.h"

#include <algorithm>
#include <cmath>

#include "student.h"

namespace picture {

namespace {

// Fewer intervals of a tile miss too often by chance to say anything.
constexpr uint64_t fewestOfTile = 100;

double colour(const std::vector<float>& rgba, size_t k) { return double(rgba[k / 3 * 4 + k % 3]); }

class Count {
 public:
  Count(const std::vector<Shot>& shots, const Reference& reference, int width, int height,
        int tileEdge)
      : shots_(shots), reference_(reference), width_(size_t(width)),
        pixels_(size_t(width) * size_t(height)), edge_(size_t(tileEdge)),
        columns_((size_t(width) + edge_ - 1) / edge_),
        tiles_(columns_ * ((size_t(height) + edge_ - 1) / edge_)) {}

  Coverage run() {
    sum_.assign(3 * pixels_, 0);
    for (const Shot& shot : shots_)
      for (size_t k = 0; k < sum_.size(); k++) sum_[k] += colour(shot.rgba, k);
    for (const Shot& shot : shots_) add(shot);
    if (variance_ > 0) c_.cost = square_ / variance_;
    if (c_.intervals()) c_.halfWidth /= double(c_.intervals());
    bias();
    std::vector<double> shares;
    for (const auto& [held, all] : tiles_)
      if (all >= fewestOfTile) shares.push_back(double(held) / double(all));
    std::sort(shares.begin(), shares.end());
    if (!shares.empty()) c_.worstTiles = shares[(shares.size() - 1) / 20];
    return c_;
  }

 private:
  void add(const Shot& shot) {
    const double count = double(shots_.size()),
                 others = std::isinf(reference_.worth) ? 0 : count - 1;
    const double wider =
        std::isinf(reference_.worth) ? 1 : std::sqrt(1 + 1 / (reference_.worth + others));
    double off = 0;
    for (size_t i = 0; i < pixels_; i++) {
      double error = 0, all = .03;
      for (size_t k = 3 * i; k < 3 * i + 3; k++) {
        const double mine = colour(shot.rgba, k);
        double truth = reference_.colours[k];
        if (others > 0)
          truth = (truth * reference_.worth + sum_[k] - mine) / (reference_.worth + others);
        if (k == 3 * i) one(shot, i, mine - truth, wider, truth);
        error += std::fabs(mine - truth) / wider;
        all += std::fabs(mine);
        if (!shot.variance.empty()) {
          square_ += (mine - truth) * (mine - truth) / wider / wider;
          variance_ += double(shot.variance[k]) / shot.samples;
        }
      }
      off += std::min(1.0, error / all) / double(pixels_);
    }
    c_.meanError += off / count;
    c_.shots++;
    c_.promiseHeld += std::fabs(off - shot.promised) <= shot.promisedInterval;
    c_.promiseBelow += off < shot.promised - shot.promisedInterval;
    c_.promised += shot.promised / count;
    c_.promisedInterval += shot.promisedInterval / count;
  }

  // Returns whether the samples of a pixel are all equal.
  static bool isConstant(const Shot& shot, size_t i) {
    if (shot.variance.empty()) return false;
    const float* const v = &shot.variance[3 * i];
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
  }

  void one(const Shot& shot, size_t i, double off, double wider, double truth) {
    double half = double(shot.half[3 * i]) * wider;
    if (!reference_.half.empty()) half = std::hypot(half, double(reference_.half[3 * i]));
    // the margin covers rounding errors in sums of floats
    const bool held = std::fabs(off) <= half + 1e-6 * std::fabs(truth);
    c_.pixels++;
    c_.held += held;
    if (shot.trust[i] == 0) return;
    c_.trusted++;
    if (half == 0) {
      c_.exact++;
      c_.exactHeld += held;
      return;
    }
    if (isConstant(shot, i)) {
      c_.bounds++;
      c_.boundsHeld += held;
      return;
    }
    c_.heldTrusted += held;
    c_.halfWidth += half;
    auto& tile = tiles_[i / width_ / edge_ * columns_ + i % width_ / edge_];
    tile.first += held;
    tile.second++;
  }

  // Computes the bias of the picture mean. These means are independent between seeds.
  void bias() {
    double all = 0, sum = 0, sum2 = 0;
    for (double r : reference_.colours) all += r;
    for (const Shot& shot : shots_) {
      double off = 0;
      for (size_t k = 0; k < 3 * pixels_; k++) off += colour(shot.rgba, k) - reference_.colours[k];
      if (all > 0) {
        sum += off / all;
        sum2 += off / all * (off / all);
      }
    }
    const double count = double(shots_.size());
    c_.bias = sum / count;
    const double v =
        std::max(0.0, sum2 / count - c_.bias * c_.bias) * count / std::max(count - 1, 1.0);
    // the reference has an error of its own
    c_.biasInterval = count > 1 ? student::quantile95(count - 1) *
                                      std::sqrt(v * (1 / count + 1 / reference_.worth))
                                : 1;
  }

  const std::vector<Shot>& shots_;
  const Reference& reference_;
  size_t width_, pixels_, edge_, columns_;
  std::vector<std::pair<uint64_t, uint64_t>> tiles_; // intervals that hold, all intervals
  std::vector<double> sum_;
  double square_ = 0, variance_ = 0;
  Coverage c_;
};

double at(std::vector<double>& values, double share) {
  const auto place = values.begin() + std::ptrdiff_t(double(values.size() - 1) * share);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

} // namespace

double Coverage::share() const {
  return intervals() ? double(heldTrusted) / double(intervals()) : 0;
}

double Coverage::shareInterval() const {
  if (!intervals()) return 1;
  const double n = double(intervals()), p = share(), z = 1.959964;
  return z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
}

Coverage countCoverage(const std::vector<Shot>& shots, const Reference& reference, int width,
                       int height, int tileEdge) {
  return Count(shots, reference, width, height, tileEdge).run();
}

Difference compare(const std::vector<float>& rgba, const std::vector<float>& reference) {
  Difference d;
  std::vector<double> off, relative;
  double sum = 0, square = 0, squareOfPixels = 0;
  for (size_t i = 0; i < rgba.size() / 4; i++) {
    bool finite = true;
    double ofPixel = 0;
    for (size_t k = 4 * i; k < 4 * i + 3; k++)
      finite = finite && std::isfinite(rgba[k]) && std::isfinite(reference[k]);
    d.notFinite += !finite;
    for (size_t k = 4 * i; finite && k < 4 * i + 3; k++) {
      const double r = double(reference[k]), e = double(rgba[k]) - r;
      ofPixel += e / 3;
      square += e * e;
      off.push_back(std::fabs(e));
      relative.push_back(e * e / (r * r + .01));
    }
    sum += ofPixel;
    squareOfPixels += ofPixel * ofPixel;
  }
  if (off.empty()) return d;
  const double n = double(off.size()), pixels = n / 3;
  d.rmse = std::sqrt(square / n);
  d.bias = sum / pixels;
  // The colours of a pixel share their samples, so that its mean counts once.
  const double spread = std::max(0.0, squareOfPixels / pixels - d.bias * d.bias);
  d.biasInterval =
      pixels > 1 ? student::quantile95(pixels - 1) * std::sqrt(spread / (pixels - 1)) : 0;
  for (double r : relative) d.relMse += r / n;
  const double limit = at(relative, .999);
  double kept = 0, count = 0;
  for (double r : relative)
    if (r <= limit) {
      kept += r;
      count++;
    }
  d.trimmedRelMse = kept / count;
  d.largest = *std::max_element(off.begin(), off.end());
  d.p999 = at(off, .999);
  return d;
}

} // namespace picture
