#include "libpicture/compare/noise_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "holm.h"
#include "libpicture/compare/differences.h"
#include "libpicture/pixel_reading.h"
#include "openrt/openrt.h"

namespace picture {

namespace {

// Fewer pixels cannot differ for sure (see chanceOf).
constexpr int fewestPixels = fewestSide * fewestSide;
constexpr size_t mostPlaces = 5;
constexpr int edge = 4; // edge of the smallest cells in pixels

// The sums over the pixels of a cell, for each colour.
struct Cell {
  std::array<double, 3> sum{}, square{}, before{};
  int pixels = 0;
  void add(const Cell& other) {
    for (size_t k = 0; k < 3; ++k) {
      sum[k] += other.sum[k];
      square[k] += other.square[k];
      before[k] += other.before[k];
    }
    pixels += other.pixels;
  }
};

// Cells that divide the picture, all of one size but for those at its right and lower edge.
struct Cells {
  int width = 0, height = 0, side = 0; // cells in a row and in a column; pixels of an edge
  std::vector<Cell> all;
  Cells(int w, int h, int s) : width(w), height(h), side(s), all(size_t(w) * size_t(h)) {}
  Cell& at(int x, int y) { return all[size_t(y) * size_t(width) + size_t(x)]; }
  const Cell& at(int x, int y) const { return all[size_t(y) * size_t(width) + size_t(x)]; }
};

Cells smallestCells(const Differences& d) {
  Cells cells((d.width + edge - 1) / edge, (d.height + edge - 1) / edge, edge);
  for (int y = 0; y < d.height; ++y)
    for (int x = 0; x < d.width; ++x) {
      Cell& cell = cells.at(x / edge, y / edge);
      const size_t i = size_t(y) * size_t(d.width) + size_t(x);
      for (size_t k = 0; k < 3; ++k) {
        const double v = double(d.of[k][i]);
        cell.sum[k] += v;
        cell.square[k] += v * v;
        cell.before[k] += double(d.before[k][i]);
      }
      ++cell.pixels;
    }
  return cells;
}

// Returns cells of twice the edge. Sums are added, never subtracted, so that one bright pixel does
// not take the precision of the others.
Cells doubled(const Cells& cells) {
  Cells larger((cells.width + 1) / 2, (cells.height + 1) / 2, 2 * cells.side);
  for (int y = 0; y < cells.height; ++y)
    for (int x = 0; x < cells.width; ++x) larger.at(x / 2, y / 2).add(cells.at(x, y));
  return larger;
}

// Returns the largest loss and the largest gain of a pixel by a bright sample. Where the darker
// picture changes by as much between the pixels around, the difference is that of an edge.
std::array<double, 2> brightestJumps(const Differences& d) {
  std::array<double, 2> most{};
  const auto isEdge = [&d](size_t k, int x, int y, float jump) {
    float brightest = -std::numeric_limits<float>::max(), darkest = -brightest;
    for (int j = std::max(0, y - 1); j <= std::min(d.height - 1, y + 1); ++j)
      for (int i = std::max(0, x - 1); i <= std::min(d.width - 1, x + 1); ++i) {
        const size_t at = size_t(j) * size_t(d.width) + size_t(i);
        const float light = d.before[k][at] + (jump < 0 ? d.of[k][at] : 0);
        brightest = std::max(brightest, light);
        darkest = std::min(darkest, light);
      }
    return brightest - darkest >= std::abs(jump);
  };
  for (size_t k = 0; k < 3; ++k)
    for (int y = 0; y < d.height; ++y)
      for (int x = 0; x < d.width; ++x) {
        const float jump = d.of[k][size_t(y) * size_t(d.width) + size_t(x)];
        double& largest = most[jump > 0 ? 1 : 0];
        if (double(std::abs(jump)) > largest && !isEdge(k, x, y, jump))
          largest = double(std::abs(jump));
      }
  return most;
}

// Judges squares of four cells, at every cell, for cells of every size.
class Squares {
 public:
  Squares(const Differences& differences, Noise noise, double correlation, double rate)
      : d_(differences), noise_(noise), correlation_(correlation), rate_(rate),
        most_(brightestJumps(differences)) {}

  void judge() {
    for (Cells cells = smallestCells(d_);; cells = doubled(cells)) {
      const int columns = std::max(1, cells.width - 1), rows = std::max(1, cells.height - 1);
      levels_.push_back(
          {std::min(d_.width, 2 * cells.side), std::min(d_.height, 2 * cells.side), {}});
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) judgeSquare(cells, x, y);
      if (cells.width <= 2 && cells.height <= 2) return;
    }
  }

  // Returns the places that noise alone is unlikely to explain, before all tests are counted.
  std::vector<ChangedPlace> takePlaces() { return std::move(places_); }
  size_t count() const { return count_; } // tests

  // Returns the changes that would have been found, at the chance that each test has.
  std::vector<SmallestChange> least(double chance) const {
    std::vector<SmallestChange> out;
    for (const Level& level : levels_) {
      std::vector<double> changes;
      for (const Square& square : level.squares) changes.push_back(leastOf(square, chance));
      if (changes.empty()) continue;
      const auto middle = changes.begin() + std::ptrdiff_t(changes.size() / 2);
      std::nth_element(changes.begin(), middle, changes.end());
      out.push_back({level.width, level.height, *middle});
    }
    return out;
  }

 private:
  struct Square {
    int pixels;
    float variance; // variance among the differences of its pixels
  };
  struct Level {
    int width, height; // pixels of its squares
    std::vector<Square> squares;
  };

  void judgeSquare(const Cells& cells, int x, int y) {
    Cell square;
    const int right = std::min(x + 2, cells.width), below = std::min(y + 2, cells.height);
    for (int j = y; j < below; ++j)
      for (int i = x; i < right; ++i) square.add(cells.at(i, j));
    if (square.pixels < fewestPixels) return;
    const int left = x * cells.side, top = y * cells.side, n = square.pixels;
    for (size_t k = 0; k < 3; ++k) {
      const double mean = square.sum[k] / n, chance = chanceOf(square.sum[k], square.square[k]);
      levels_.back().squares.push_back(
          {n, float(std::max(0.0, square.square[k] / n - mean * mean))});
      ++count_;
      if (chance <= rate_)
        places_.push_back({left, top, std::min(right * cells.side, d_.width) - left,
                           std::min(below * cells.side, d_.height) - top, int(k),
                           square.before[k] / n, mean, chance});
    }
  }

  // Returns an upper bound of the probability of such a sum, or a larger one, by noise.
  //
  // If the pictures could be exchanged, each difference has either sign with the same probability,
  // whatever its distribution is. So the sum is one of signs with given weights, and W. Hoeffding's
  // inequality (Journal of the American Statistical Association 58, 1963) bounds it. It needs no
  // variance and no distribution. Where neighbours are correlated, the variance is larger.
  double chanceOf(double sum, double square) const {
    if (sum == 0 || square == 0) return 1;
    const double signs = 2 * std::exp(-sum * sum / (2 * square * correlation_));
    return std::min(1.0, std::max(signs, chanceOfMissedLight(sum)));
  }

  // Returns the probability that the darker picture has missed light here that comes in rare bright
  // samples. They are as bright as the brightest one of that kind in the other pixels; the light of
  // so many of them is missing, and a Poisson variable is 0 with this probability.
  double chanceOfMissedLight(double sum) const {
    if (noise_ == Noise::equal) return 0;
    const double brightest = most_[sum < 0 ? 1 : 0] * correlation_;
    return brightest > 0 ? std::exp(-std::abs(sum) / brightest) : 0;
  }

  double leastOf(const Square& square, double chance) const {
    const double n = square.pixels, wanted = 2 * correlation_ * std::log(2 / chance);
    if (n <= wanted) return std::numeric_limits<double>::infinity();
    const double bySigns = std::sqrt(wanted * double(square.variance) / (n - wanted));
    if (noise_ == Noise::equal) return bySigns;
    return std::max(bySigns, -std::log(chance) * std::max(most_[0], most_[1]) * correlation_ / n);
  }

  const Differences& d_;
  const Noise noise_;
  const double correlation_, rate_;
  const std::array<double, 2> most_; // the largest loss and the largest gain of a pixel
  std::vector<Level> levels_;
  std::vector<ChangedPlace> places_;
  size_t count_ = 0;
};

// Judges single pixels by their error bars. Returns the number of tests, and adds the places that
// noise alone is unlikely to explain.
size_t judgePixels(const Picture& a, const Picture& b, const Differences& d, double rate,
                   std::vector<ChangedPlace>& places) {
  if (!hasErrors(a) || !hasErrors(b)) return 0;
  const PixelLights before(a), now(b);
  size_t count = 0;
  for (size_t i = 0; i < d.of[0].size(); ++i) {
    if (!before.isTrusted(i) || !now.isTrusted(i) || !d.isFinite(i)) continue;
    ++count;
    if (d.of[0][i] == 0 && d.of[1][i] == 0 && d.of[2][i] == 0) continue; // equal but for rounding
    const PixelReading first = before.luminance(i);
    const LightDifference change = differenceBetween(first, now.luminance(i));
    if (change.chance > rate) continue;
    const int x = int(i % size_t(d.width)), y = int(i / size_t(d.width));
    places.push_back({x, y, 1, 1, 3, double(first.luminance), change.value, change.chance});
  }
  return count;
}

bool overlap(const ChangedPlace& a, const ChangedPlace& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

} // namespace

const char* changedColour(const ChangedPlace& place) {
  constexpr const char* names[] = {"red", "green", "blue", "luminance"};
  return names[place.colour];
}

NoiseTest testNoise(const Picture& a, const Picture& b, Noise noise, double rate) {
  const Differences differences(a, b);
  NoiseTest test;
  test.notFinite = differences.notFinite;
  test.oneSided = differences.oneSided;
  const Correlation correlation = correlationOf(differences);
  test.correlation = correlation.factor;
  test.isSmooth = correlation.isSmooth;
  for (size_t i = 0; i < differences.of[0].size(); ++i)
    test.different +=
        differences.of[0][i] != 0 || differences.of[1][i] != 0 || differences.of[2][i] != 0;
  Squares squares(differences, noise, correlation.factor, rate);
  squares.judge();
  std::vector<ChangedPlace> places = squares.takePlaces();
  test.squares = squares.count();
  test.pixels = judgePixels(a, b, differences, rate, places);
  const size_t count = test.squares + test.pixels;
  std::vector<double> chances;
  for (const ChangedPlace& place : places) chances.push_back(place.chance);
  const std::vector<size_t> found = holm::significantOf(chances, rate, count);
  test.found = found.size();
  test.isSame = found.empty() && test.oneSided == 0;
  for (const size_t i : found) {
    if (test.changes.size() == mostPlaces) break;
    if (std::none_of(test.changes.begin(), test.changes.end(),
                     [&](const ChangedPlace& one) { return overlap(one, places[i]); }))
      test.changes.push_back(places[i]);
  }
  if (count > 0) test.least = squares.least(rate / double(count));
  return test;
}

std::vector<float> standardErrors(const Picture& a, const Picture& b) {
  constexpr int radius = 3;
  constexpr double most = 99;
  const Differences d(a, b);
  std::vector<float> out(3 * size_t(d.width) * size_t(d.height));
  const bool known = hasErrors(a) && hasErrors(b);
  // Returns the variance of a difference by those of the pixels around.
  const auto varianceAround = [&](int x, int y, size_t k) {
    double sum = 0, square = 0, count = 0;
    for (int j = std::max(0, y - radius); j <= std::min(d.height - 1, y + radius); ++j)
      for (int i = std::max(0, x - radius); i <= std::min(d.width - 1, x + radius); ++i) {
        const double v = double(d.of[k][size_t(j) * size_t(d.width) + size_t(i)]);
        sum += v;
        square += v * v;
        ++count;
      }
    return std::max(0.0, square / count - sum / count * (sum / count));
  };
  for (int y = 0; y < d.height; ++y)
    for (int x = 0; x < d.width; ++x)
      for (size_t k = 0; k < 3; ++k) {
        const size_t i = size_t(y) * size_t(d.width) + size_t(x);
        const double v = double(d.of[k][i]);
        if (v == 0) continue;
        const double error = known ? std::hypot(double(a.planes.at(RT_ERROR)[3 * i + k]),
                                                double(b.planes.at(RT_ERROR)[3 * i + k])) /
                                         halfWidthOfNormal
                                   : std::sqrt(varianceAround(x, y, k));
        out[3 * i + k] = float(std::clamp(v / std::max(error, std::abs(v) / most), -most, most));
      }
  return out;
}

} // namespace picture
