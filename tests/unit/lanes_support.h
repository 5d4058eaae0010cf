// lanes_support.h: random numbers for tests of vector code.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "unit/same_bytes.h"

namespace openrt::test {

inline constexpr uint32_t count = 4096;

class Numbers {
 public:
  explicit Numbers(uint32_t seed) : random_(seed) {}
  float operator()(float low, float high) {
    return low + (high - low) * float(random_() >> 8) * 0x1p-24f;
  }
  std::vector<float> list(float low, float high) {
    std::vector<float> out(count);
    for (float& x : out) x = (*this)(low, high);
    return out;
  }

 private:
  std::mt19937 random_;
};

using Arrays = std::array<std::vector<float>, 3>;

inline Arrays vectors(Numbers& numbers, float size) {
  return {numbers.list(-size, size), numbers.list(-size, size), numbers.list(-size, size)};
}

inline Arrays unitVectors(Numbers& numbers) {
  Arrays v = vectors(numbers, 1);
  for (uint32_t i = 0; i < count; i++) {
    const double length = std::sqrt(double(v[0][i]) * v[0][i] + double(v[1][i]) * v[1][i] +
                                    double(v[2][i]) * v[2][i]);
    for (auto& component : v) component[i] = float(component[i] / length);
  }
  return v;
}

} // namespace openrt::test
