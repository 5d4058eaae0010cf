// stipple.h: the pattern of dashed lines (rtLineStipple). Read on any thread.
#pragma once

#include <cstdint>

namespace openrt {

// 16 cells of `factor` pixels each along a line; bit 0 is the first, and a 1 is drawn.
struct Stipple {
  static constexpr uint32_t cells = 16;
  static constexpr uint16_t solid = 0xffff;
  static constexpr int largestFactor = 256; // OpenGL 1.1, section 3.4.2

  uint16_t factor = 1, pattern = solid;
  bool operator==(const Stipple&) const = default;
};

// A line with a pattern as a camera sees it. Places are from 0 to 1 along the line in the world.
struct StippledLine {
  float from = 0, to = 0; // the part that has the pattern; the rest is solid
  float begin = 0;        // cells of the pattern that come before that part
  float cells = 0;        // cells over that part
  float recession = 1;    // size of a pixel at its beginning by that at its end

  // Returns whether nothing is drawn at a place.
  bool isGap(uint16_t pattern, float u) const {
    if (!(u >= from && u <= to && from < to)) return false;
    const float part = (u - from) / (to - from), seen = part / (recession * (1 - part) + part);
    const float cell = begin + seen * cells;
    return cell >= 0 && !(pattern >> (uint32_t(cell) % Stipple::cells) & 1);
  }
};

} // namespace openrt
