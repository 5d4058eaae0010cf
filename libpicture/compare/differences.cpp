#include "libpicture/compare/differences.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "openrt/openrt.h"

namespace picture {

namespace {

// Returns the largest relative error by which the numbers of a picture are rounded: that of the
// bits of the mantissa that are used at all. Sums of floats in another order differ by more than
// their last bits.
double roundingOf(const Picture& picture) {
  constexpr int fewestBits = 8, mostBits = 20, allBits = 23;
  uint32_t used = 0;
  for (const float v : rgbaOf(picture))
    if (std::isfinite(v)) used |= std::bit_cast<uint32_t>(v);
  const int bits = allBits - std::countr_zero(used | 1u << allBits);
  return std::ldexp(1.0, -std::clamp(bits, fewestBits, mostBits));
}

// Numbers beyond it count as infinite: the squares of their differences could not be summed.
constexpr float largest = 1e30f;

template <class T> T medianOf(std::vector<T> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

constexpr int side = 32;  // edge of a tile in pixels
constexpr int reach = 2;  // how far away neighbours are compared
constexpr int fewest = 8; // the smallest tile, at the edge of the picture

// The differences in a tile, for one colour.
class Tile {
 public:
  Tile(const Differences& d, size_t colour, int left, int top)
      : width_(std::min(side, d.width - left)), height_(std::min(side, d.height - top)) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        values_.push_back(d.of[colour][size_t(top + y) * size_t(d.width) + size_t(left + x)]);
    const auto equal = std::count(values_.begin(), values_.end(), 0.0f);
    isEqual_ = equal == std::ptrdiff_t(values_.size());
    isFull_ = equal * 10 < std::ptrdiff_t(values_.size());
    if (isFull_) toSigns();
    for (const float v : values_) square_ += double(v) * double(v);
  }
  bool isUseful() const { return !isEqual_ && width_ >= fewest && height_ >= fewest; }

  // Returns the correlation of pixels at a distance. Where nearly all pixels differ it is that of
  // the signs, since a few bright pixels would decide otherwise; for normal variables the sine
  // follows (W. F. Sheppard, Philosophical Transactions A 192, 1899).
  double at(int dx, int dy) const {
    double sum = 0;
    for (int y = 0; y + dy < height_; ++y)
      for (int x = std::max(0, -dx); x < std::min(width_, width_ - dx); ++x)
        sum += value(x, y) * value(x + dx, y + dy);
    if (!isFull_) return sum / square_;
    const int pairs = (width_ - std::abs(dx)) * (height_ - dy);
    return std::sin(std::numbers::pi / 2 * sum / pairs);
  }

 private:
  // Replaces the values by their signs about the median.
  void toSigns() {
    const float middle = medianOf(values_);
    for (float& v : values_) v = v > middle ? 1.0f : v < middle ? -1.0f : 0.0f;
  }
  double value(int x, int y) const {
    return double(values_[size_t(y) * size_t(width_) + size_t(x)]);
  }
  int width_, height_;
  bool isEqual_ = false, isFull_ = false; // none, nearly all of its pixels differ
  double square_ = 0;
  std::vector<float> values_;
};

} // namespace

bool hasErrors(const Picture& picture) {
  return picture.planes.count(RT_ERROR) && picture.planes.count(RT_TRUST);
}

Differences::Differences(const Picture& a, const Picture& b) : width(a.width), height(a.height) {
  constexpr double step = 1.001 / 255; // display colours may be rounded either way
  const double rounding = std::max(roundingOf(a), roundingOf(b));
  const std::vector<float>&first = rgbaOf(a), &second = rgbaOf(b);
  const size_t pixels = first.size() / 4;
  isInfinite_.resize(pixels);
  for (size_t k = 0; k < 3; ++k) {
    of[k].resize(pixels);
    before[k].resize(pixels);
  }
  for (size_t i = 0; i < pixels; ++i) {
    double most = 0;
    bool finite = true;
    for (size_t k = 4 * i; k < 4 * i + 3; ++k) {
      finite = finite && std::abs(first[k]) < largest && std::abs(second[k]) < largest;
      most = std::max({most, std::abs(double(first[k])), std::abs(double(second[k]))});
    }
    isInfinite_[i] = !finite;
    notFinite += !finite;
    const double margin = a.linear ? rounding * most : step;
    for (size_t k = 0; finite && k < 3; ++k) {
      const double d = double(second[4 * i + k]) - double(first[4 * i + k]);
      of[k][i] = std::abs(d) > margin ? float(d) : 0;
      before[k][i] = first[4 * i + k];
    }
  }
}

Correlation correlationOf(const Differences& d) {
  constexpr double most = 9; // a filter gives less: a tent of 4x4 pixels has 7.1
  std::vector<double> factors;
  for (size_t k = 0; k < 3; ++k)
    for (int top = 0; top < d.height; top += side)
      for (int left = 0; left < d.width; left += side) {
        const Tile tile(d, k, left, top);
        if (!tile.isUseful()) continue;
        double sum = 1;
        for (int dy = 0; dy <= reach; ++dy)
          for (int dx = dy ? -reach : 1; dx <= reach; ++dx) sum += 2 * tile.at(dx, dy);
        factors.push_back(sum);
      }
  if (factors.empty()) return {};
  const double factor = std::max(1.0, medianOf(std::move(factors)));
  return factor > most ? Correlation{1, true} : Correlation{factor, false};
}

} // namespace picture
