// hatch.h: the 19 styles of hatching that the International Register of Graphical Items (ISO/IEC
// 9973) numbers and X3D's FillProperties selects (ISO/IEC 19775-1 12.4.2), as functions of a place
// in the picture. The register names what the lines are like or stand for, and no sizes. Here the
// patterns repeat after at most 32 pixels. [render]
#pragma once

#include <cmath>
#include <cstdint>

namespace hatch {

// Returns whether v is in a stripe of this width. Stripes begin at the multiples of the period.
inline bool stripe(float v, float period, float width) {
  return v - period * std::floor(v / period) < width;
}

// Returns whether a place is on a grain of sand. Most cells of 4 by 4 pixels have one, of a pixel.
inline bool sand(float x, float y) {
  const float cellX = std::floor(x / 4), cellY = std::floor(y / 4);
  uint32_t hash = (static_cast<uint32_t>(static_cast<int32_t>(cellX)) & 7u) * 73856093u ^
                  (static_cast<uint32_t>(static_cast<int32_t>(cellY)) & 7u) * 19349663u;
  hash = (hash ^ hash >> 15) * 0x2c1b3c6du;
  hash = (hash ^ hash >> 12) * 0x297a2d39u;
  if (hash >> 30 == 0) return false;
  const float grainX = static_cast<float>(hash >> 4 & 3),
              grainY = static_cast<float>(hash >> 9 & 3);
  return std::floor(x) - 4 * cellX == grainX && std::floor(y) - 4 * cellY == grainY;
}

// Returns whether a place is on a line of the style. Pixels; y points up.
inline bool isLine(int32_t style, float x, float y) {
  const float rising = x - y, falling = x + y; // each is constant along a line of its slope
  switch (style) {
  case 1: return stripe(y, 4, 1);       // horizontal
  case 2: return stripe(x, 4, 1);       // vertical
  case 3: return stripe(rising, 8, 2);  // positive slope
  case 4: return stripe(falling, 8, 2); // negative slope
  case 5: return stripe(x, 4, 1) || stripe(y, 4, 1);
  case 6: return stripe(rising, 8, 2) || stripe(falling, 8, 2);
  case 7: return stripe(rising, 16, 2);                              // cast iron, and in general
  case 8: return stripe(rising, 32, 2) || stripe(rising - 8, 32, 2); // steel
  case 9:                                                            // bronze, brass, copper
    return stripe(rising, 16, 2) || (stripe(rising - 8, 16, 2) && stripe(y, 16, 8));
  case 10: return stripe(rising, 16, 2) || stripe(falling, 16, 2); // white metal, zinc, lead
  case 11:                                                         // magnesium, aluminium
    return stripe(rising, 16, 2) || (stripe(falling, 16, 2) && stripe(y, 16, 8));
  case 12: // rubber, plastic, electrical insulation
    return stripe(rising, 8, 2) && !stripe(rising - 24, 32, 8);
  case 13: // cork, felt, fabric, leather
    return (stripe(y, 8, 1) && stripe(x, 32, 16)) ||
           (stripe(y - 4, 16, 1) && stripe(x - 10, 32, 16)) ||
           (stripe(y - 12, 16, 1) && stripe(x - 20, 32, 16));
  case 14: // thermal insulation: steps along lines
    return stripe(rising, 16, 2) || ((stripe(x, 8, 1) || stripe(y, 8, 1)) && stripe(rising, 16, 8));
  case 15: // titanium, refractory material
    return stripe(rising, 32, 2) || (stripe(rising, 8, 2) && stripe(y, 16, 8));
  case 16: // marble, slate, glass, porcelain
    return (stripe(rising, 16, 2) && stripe(y, 16, 5)) ||
           (stripe(rising - 8, 16, 2) && stripe(y - 8, 16, 5));
  case 17: // earth: fields of lines of both slopes
    return stripe(x, 32, 16) == stripe(y, 32, 16) ? stripe(rising, 8, 2) : stripe(falling, 8, 2);
  case 18: return sand(x, y);
  case 19: return stripe(y, 2, 1) && stripe(stripe(y, 4, 2) ? x : x - 1, 2, 1); // dots
  default: return false;
  }
}

// Returns whether the hatching covers a point that the camera sees at x, y (pixels from the top
// left corner). If the place is not known (placed is false), the lines cover a surface that is not
// filled, which would be invisible, and no other.
inline bool covers(int32_t style, bool placed, float x, float y, bool filled) {
  return placed ? isLine(style, x, -y) : !filled;
}

} // namespace hatch
