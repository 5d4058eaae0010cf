// media.h: the bodies that a ray is inside of, and what it meets at their boundaries. Bodies may
// overlap: the one of the highest priority is there (C. Schmidt, B. Budge, "Simple Nested
// Dielectrics in Ray Traced Images", JGT 7(2), 2002). Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "openrt/openrts.h"

namespace openrt {

// Numbers from 1 into a scene's media, in the order they were entered; 0: none. A fifth body inside
// four others is not noticed.
using MediaStack = std::array<uint16_t, 4>;

// The medium a ray of this stack is in, 0: none. Of equal priorities the one entered last.
uint16_t mediumOf(const MediaStack& stack, std::span<const RtsMedium> media);

struct Crossing {
  MediaStack behind; // on the other side of the boundary
  uint16_t from, to; // media on both sides
  bool seen;         // false: the boundary lies in a body of higher priority
  bool unknown;      // the ray came from inside a body that it never entered: there the eye is
};
// A ray meets the boundary of a medium; back: from inside.
Crossing cross(const MediaStack& stack, uint16_t medium, bool back,
               std::span<const RtsMedium> media);

// Index of refraction of a medium (0: nothing, 1) by colour.
inline float indexOf(uint16_t medium, int colour, std::span<const RtsMedium> media) {
  return medium ? media[medium - 1].index[colour] : 1.0f;
}
// What is left of light after a way through a medium, by colour.
void absorb(uint16_t medium, float length, std::span<const RtsMedium> media, float colour[3]);

} // namespace openrt
