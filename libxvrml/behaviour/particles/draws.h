// draws.h: the random numbers of particles: pure functions of the particle and of what they are
// for. Any thread.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "geometry/vector_math.h"

namespace xvrml {

// The uses of random numbers. Each has a stream of its own, so that one does not shift another.
// The models of `physics` have those from `physics` on.
enum class Stream : uint64_t { life, birth, body, physics };

// Mixes the bits of a number (the finalizer of SplitMix64, Steele et al. 2014).
inline uint64_t mixed(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}
inline uint64_t mixed(uint64_t a, uint64_t b) { return mixed(a ^ mixed(b + 0x9e3779b97f4a7c15)); }
inline uint64_t mixed(std::string_view text) {
  uint64_t sum = text.size();
  for (const char c : text) sum = mixed(sum, uint64_t(uint8_t(c)));
  return sum;
}

// One stream of random numbers of a particle.
class Draws {
 public:
  Draws(uint64_t particle, Stream stream, uint64_t number = 0)
      : state_(mixed(particle, uint64_t(stream) + number)) {}

  // Returns a number in [0,1).
  double next() {
    state_ += 0x9e3779b97f4a7c15;
    return double(mixed(state_) >> 11) * 0x1p-53;
  }
  // Returns a number that differs from the mean by at most the part `variation` of it, not below 0.
  double around(double mean, double variation) {
    return std::max(0.0, mean * (1 + variation * (2 * next() - 1)));
  }
  // Returns a unit vector whose angle to the axis is at most `angle`, evenly over the solid angle.
  // Without an axis it can be any.
  V3d within(const V3d& axis, double angle) {
    const V3d z = unit(axis);
    const bool free = z == V3d(0);
    const double cosine = 1 - next() * (free ? 2 : 1 - std::cos(angle));
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double turn = 2 * std::numbers::pi * next();
    if (free) return {sine * std::cos(turn), sine * std::sin(turn), cosine};
    const V3d x = unit(std::abs(z.x) < 0.5 ? V3d(1, 0, 0).cross(z) : V3d(0, 1, 0).cross(z));
    return x * (sine * std::cos(turn)) + z.cross(x) * (sine * std::sin(turn)) + z * cosine;
  }

 private:
  uint64_t state_;
};

} // namespace xvrml
