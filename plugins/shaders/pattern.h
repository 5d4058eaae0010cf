// pattern.h: functions for solid textures: hashes of grid cells and gradient noise. Shared by Wood,
// Marble, Checker and CarPaint. Pure functions of the position that return the same values on every
// machine and accept any float. [render]
#pragma once

#include <cmath>
#include <cstdint>

#include "openrt/openrts.hpp"

namespace pattern {

// Returns the cell of a coordinate. Beyond 2^24 it returns 0, because a float cannot resolve
// positions within a cell there.
inline int32_t cell(float x) {
  return std::fabs(x) < 16777216.0f ? static_cast<int32_t>(std::floor(x)) : 0;
}

// mix() is the finaliser of A. Appleby's MurmurHash3. hash() applies it after each coordinate.
inline uint32_t mix(uint32_t h) {
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return h ^ (h >> 16);
}
inline uint32_t hash(int32_t x, int32_t y, int32_t z, uint32_t seed = 0) {
  uint32_t h = mix(static_cast<uint32_t>(x) + 0x9e3779b9u * (seed + 1));
  h = mix(h + static_cast<uint32_t>(y));
  return mix(h + static_cast<uint32_t>(z));
}
inline float unit(uint32_t h) { return static_cast<float>(h >> 8) * 0x1p-24f; } // 0 <= unit < 1

// Returns gradient noise, -1..1, 0 at integer coordinates (K. Perlin, "Improving Noise", SIGGRAPH
// 2002).
inline float noise(rts::Vec3 p) {
  const int32_t x = cell(p.x), y = cell(p.y), z = cell(p.z);
  const rts::Vec3 f{p.x - float(x), p.y - float(y), p.z - float(z)};
  if (!(f.x >= 0 && f.x <= 1 && f.y >= 0 && f.y <= 1 && f.z >= 0 && f.z <= 1))
    return 0; // the coordinates are too large or not finite
  const auto fade = [](float t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const auto slope = [&](int32_t i, int32_t j, int32_t k) {
    const uint32_t h = hash(x + i, y + j, z + k) & 15;
    const float a = f.x - float(i), b = f.y - float(j), c = f.z - float(k);
    const float u = h < 8 ? a : b, v = h < 4 ? b : h == 12 || h == 14 ? a : c;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
  };
  const float u = fade(f.x), v = fade(f.y), w = fade(f.z);
  const auto mixed = [](float t, float a, float b) { return a + t * (b - a); };
  const auto layer = [&](int32_t k) {
    return mixed(v, mixed(u, slope(0, 0, k), slope(1, 0, k)),
                 mixed(u, slope(0, 1, k), slope(1, 1, k)));
  };
  return mixed(w, layer(0), layer(1));
}

// Returns the sum of octaves of |noise|, each with half the amplitude and twice the frequency.
inline float turbulence(rts::Vec3 p, int octaves) {
  float sum = 0, strength = 1;
  for (int i = 0; i < octaves; i++) {
    sum += strength * std::fabs(noise(p));
    strength *= 0.5f;
    p = 2 * p +
        rts::Vec3{17.3f, 5.1f, 9.7f}; // offset, so that the zeros of the octaves do not coincide
  }
  return sum;
}

inline rts::Color lerp(rts::Color a, rts::Color b, float t) {
  return a + (b - a) * std::fmin(1.0f, std::fmax(0.0f, t));
}

// Returns the position of a hit in its object, moved a thousandth of a cell below the surface. So a
// face in the plane between two cells always has the same cell.
template <class F> rts::Vec3Of<F> positionBeneath(const rts::HitOf<F>& hit, float cellSize) {
  const rts::LocalOf<F> local = hit.local();
  return local.position - rts::normalize(local.normal) * (1e-3f * cellSize);
}

} // namespace pattern
