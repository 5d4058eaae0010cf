// chi_square.h: Pearson's chi-square test of sampled directions against a pdf. Directions are
// counted in 80 x 160 bins of the sphere. Bins with fewer than 5 expected samples are pooled (the
// rules of pbrt's and Mitsuba's BSDF tests).
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "openrt/openrts.hpp"

namespace openrt::test {

// Returns the probability that a chi-square variable exceeds x: 1 - P(k / 2, x / 2), by the series
// or the continued fraction of the incomplete gamma function (M. Abramowitz, I. Stegun, 6.5.29,
// 6.5.31).
inline double chiSquareTail(double x, double degrees) {
  const double a = degrees / 2, y = x / 2;
  if (!(y > 0)) return 1;
  const double scale = std::exp(-y + a * std::log(y) - std::lgamma(a));
  if (y < a + 1) {
    double term = 1 / a, sum = term;
    for (double k = a + 1; term > sum * 1e-15; k++) sum += term *= y / k;
    return 1 - sum * scale;
  }
  double b = y + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int k = 1; k < 10000; k++) {
    const double an = -k * (k - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    const double step = d * c;
    h *= step;
    if (std::fabs(step - 1) < 1e-14) break;
  }
  return scale * h;
}

struct Expected {
  std::vector<double> bins; // integral of the pdf over each bin
  double total = 0;
};

class SphereHistogram {
 public:
  // equal steps of the polar angle, which makes the bins small near the axis
  static constexpr int across = 80, around = 160;
  explicit SphereHistogram(rts::Vec3 axis) : frame_(axis), seen_(across * around) {}

  void count(rts::Vec3 direction) {
    const rts::Vec3 d = frame_.toLocal(direction);
    const double theta = std::acos(std::clamp(double(d.z), -1.0, 1.0)),
                 phi = std::atan2(d.y, d.x) + M_PI;
    const int i = std::clamp(int(theta / M_PI * across), 0, across - 1),
              j = std::clamp(int(phi / (2 * M_PI) * around), 0, around - 1);
    seen_[size_t(i * around + j)]++;
  }
  Expected expect(const std::function<double(rts::Vec3)>& pdf) const {
    Expected e{std::vector<double>(seen_.size()), 0};
    for (int i = 0; i < across; i++)
      for (int j = 0; j < around; j++) {
        const Bin bin{M_PI * i / across, M_PI / across, 2 * M_PI * j / around - M_PI,
                      2 * M_PI / around};
        e.total += e.bins[size_t(i * around + j)] = integral(pdf, bin, rule(pdf, bin, 2), 0);
      }
    return e;
  }
  // Returns the tail probability of the counted directions. lost: number of samples without a
  // direction.
  double chiSquareTail(const Expected& expected, double samples, double lost) const {
    std::vector<size_t> order(seen_.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return expected.bins[a] < expected.bins[b]; });
    double pooledSeen = 0, pooled = 0, x = 0;
    int bins = 0;
    const double given = samples - lost, scale = expected.total > 0 ? given / expected.total : 0;
    for (const size_t b : order) {
      const double e = expected.bins[b] * scale;
      if (e == 0 && seen_[b] > 0) return 0; // the pdf is 0 for a direction that was sampled
      pooledSeen += seen_[b];
      pooled += e;
      if (pooled < 5) continue;
      x += (pooledSeen - pooled) * (pooledSeen - pooled) / pooled;
      bins++;
      pooledSeen = pooled = 0;
    }
    return bins < 2 ? 1 : test::chiSquareTail(x, bins - 1);
  }

 private:
  struct Bin {
    double theta, height, phi, width;
  };
  // Midpoint rule with n x n parts.
  double rule(const std::function<double(rts::Vec3)>& pdf, const Bin& b, int n) const {
    double sum = 0;
    for (int i = 0; i < n; i++) {
      const double t = b.theta + b.height * (i + .5) / n, s = std::sin(t);
      // The area of each part is exact; only the pdf is approximated.
      const double area =
          (std::cos(b.theta + b.height * i / n) - std::cos(b.theta + b.height * (i + 1) / n)) *
          b.width / n;
      for (int j = 0; j < n; j++) {
        const double p = b.phi + b.width * (j + .5) / n;
        sum += area * pdf(frame_.toWorld(
                          {float(s * std::cos(p)), float(s * std::sin(p)), float(std::cos(t))}));
      }
    }
    return sum;
  }
  double integral(const std::function<double(rts::Vec3)>& pdf, const Bin& b, double coarse,
                  int depth) const {
    const double fine = rule(pdf, b, 4);
    if (depth == 6 || std::fabs(fine - coarse) < 1e-7 + 2e-3 * fine) return fine;
    double sum = 0;
    for (int k = 0; k < 4; k++) {
      const Bin part{b.theta + (k & 1) * b.height / 2, b.height / 2, b.phi + (k >> 1) * b.width / 2,
                     b.width / 2};
      sum += integral(pdf, part, rule(pdf, part, 2), depth + 1);
    }
    return sum;
  }

  rts::Frame frame_;
  std::vector<double> seen_;
};

} // namespace openrt::test
