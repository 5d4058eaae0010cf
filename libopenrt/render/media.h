// media.h: the stack of the media that contain a ray, and how it changes at their boundaries. Media
// may overlap; the one with the highest priority wins (C. Schmidt, B. Budge, "Simple Nested
// Dielectrics in Ray Traced Images", JGT 7(2), 2002). Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "openrt/openrts.h"
#include "scene/vec3.h"

namespace openrt {

// Media by number (1 + index into the scene's media) in the order they were entered; 0: empty, as
// are all that follow. A fifth medium inside four others is ignored.
using MediaStack = std::array<uint16_t, 4>;

// Returns the medium that a ray with this stack is in, 0 for none. If several media have the
// highest priority, the one entered last wins.
inline uint16_t mediumOf(const MediaStack& stack, std::span<const RtsMedium> media) {
  uint16_t top = 0;
  for (const uint16_t m : stack) {
    if (!m) break;
    if (!top || media[m - 1].priority >= media[top - 1].priority) top = m;
  }
  return top;
}

struct Crossing {
  MediaStack behind; // media stack on the far side of the boundary
  uint16_t from, to; // media on the near and on the far side
  bool visible; // false: the boundary lies inside a medium of higher priority and has no effect
  bool unknown; // the ray leaves a medium that it never entered: the camera is inside that medium
};
// Crosses the boundary of a medium. back: the ray hits it from inside.
Crossing cross(const MediaStack& stack, uint16_t medium, bool back,
               std::span<const RtsMedium> media);

// Returns the index of refraction of a medium by colour; 1 without a medium.
inline float indexOf(uint16_t medium, int colour, std::span<const RtsMedium> media) {
  return medium ? media[medium - 1].index[colour] : 1.0f;
}
// Returns whether a medium scatters light.
inline bool scatters(const RtsMedium& medium) {
  return medium.scattering[0] > 0 || medium.scattering[1] > 0 || medium.scattering[2] > 0;
}
// Returns the coefficient of extinction by colour: absorption and scattering.
inline float extinctionOf(const RtsMedium& medium, int colour) {
  return medium.absorption[colour] + medium.scattering[colour];
}
// Attenuates `colour` by the extinction along `length` in a medium.
void absorb(uint16_t medium, float length, std::span<const RtsMedium> media, Vec3f& colour);

} // namespace openrt
