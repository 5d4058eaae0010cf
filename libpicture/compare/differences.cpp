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

// Counts triples of pixels in a row or a column, a distance apart, whose differences only rise or
// only fall; triples with equal ones are left out.
class Triples {
 public:
  Triples(const Differences& d, int dx, int dy) {
    const auto at = [&](size_t k, int x, int y) {
      return d.of[k][size_t(y) * size_t(d.width) + size_t(x)];
    };
    for (size_t k = 0; k < 3; ++k)
      for (int y = 0; y + 2 * dy < d.height; ++y)
        for (int x = 0; x + 2 * dx < d.width; ++x) {
          const float first = at(k, x, y), second = at(k, x + dx, y + dy),
                      third = at(k, x + 2 * dx, y + 2 * dy);
          if (first == second || second == third) continue;
          ++all_;
          monotone_ += (first < second) == (second < third);
        }
  }

  // Returns the correlation of the steps from the first to the second and from the second to the
  // third. For independent differences of any distribution, a third of the triples rises or falls,
  // and it is -1/2, the least that is returned. For normal variables it follows from the share (W.
  // F. Sheppard, Philosophical Transactions A 192, 1899).
  double correlation() const {
    if (all_ == 0) return -.5;
    return std::max(-.5, std::sin(std::numbers::pi * (double(monotone_) / double(all_) - .5)));
  }

 private:
  uint64_t all_ = 0, monotone_ = 0;
};

// Returns the correlation factor of rows (dx = 1) or columns: 1 + 2 r1 + 2 r2, where r1 and r2 are
// the correlations at a distance of one and of two pixels, and further away there is none. The
// correlation of the steps of a triple is (2 r1 - 1 - r2) / (2 - 2 r1).
double factorOf(const Differences& d, int dx, int dy) {
  constexpr double most = .999;
  const double one = std::min(most, Triples(d, dx, dy).correlation()),
               two = std::min(most, Triples(d, 2 * dx, 2 * dy).correlation());
  const double r2 = (2 * two + 1) / (2 * two + 2), r1 = (2 * one + 1 + r2) / (2 * one + 2);
  return 1 + 2 * r1 + 2 * r2;
}

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
    bool finiteBefore = true, finiteNow = true;
    for (size_t k = 4 * i; k < 4 * i + 3; ++k) {
      finiteBefore = finiteBefore && std::abs(first[k]) < largest;
      finiteNow = finiteNow && std::abs(second[k]) < largest;
      most = std::max({most, std::abs(double(first[k])), std::abs(double(second[k]))});
    }
    const bool finite = finiteBefore && finiteNow;
    isInfinite_[i] = !finite;
    notFinite += !finite;
    oneSided += finiteBefore != finiteNow;
    const double margin = a.linear ? rounding * most : step;
    for (size_t k = 0; finite && k < 3; ++k) {
      const double d = double(second[4 * i + k]) - double(first[4 * i + k]);
      of[k][i] = std::abs(d) > margin ? float(d) : 0;
      before[k][i] = first[4 * i + k];
    }
  }
}

Correlation correlationOf(const Differences& d) {
  constexpr double most = 3; // a filter gives less: a tent of four pixels has 2.7
  const double rows = factorOf(d, 1, 0), columns = factorOf(d, 0, 1);
  return rows > most || columns > most ? Correlation{1, true} : Correlation{rows * columns, false};
}

} // namespace picture
