// lacquer.h: how much of what is below a layer of pigmented lacquer shows. Used by Plastic. Pure
// functions. [render]
//
// The layer scatters and absorbs light by P. Kubelka and F. Munk ("Ein Beitrag zur Optik der
// Farbanstriche", 1931). A layer too thick to see through reflects c. With x = (1/c - c) / 2 times
// the optical thickness s, and E = exp(-2x), a layer reflects and transmits
//   R = c (1 - E) / (1 - E c^2),  T = exp(-x) (1 - c^2) / (1 - E c^2).
// All colours scatter alike, so s is the same for them: dark colours pass less, and what shows
// through has the colour of the lacquer.
//
// Light that shows what is below has passed twice, in and out. A sheet of an export is one-sided:
// only its front is hit, so this hit stands for both and passes T^2; its back, which only some
// shadow rays hit, passes everything. Each hit of a sheet with two sides passes T.
//
// The layer sends c of the rest back: all that a thick layer would. Kubelka and Munk's R is less
// for light colours, because light that is scattered downwards is lost to it; over a surface of the
// reflectance g it comes back in parts, T^2 g / (1 - R g), and more of it the lighter both are.
// Paths pass the back of a one-sided sheet freely and do not find these. For dark colours
// R / (1 - T^2) is c nearly.
#pragma once

#include <algorithm>
#include <cmath>

#include "openrt/openrts.hpp"

namespace lacquer {

// Returns the share that passes a layer of the colour r, g, b twice, in the channel c, if the share
// `transparency` does so in its brightest channel.
inline float passingTwice(float c, float r, float g, float b, float transparency) {
  const auto inside = [](float value) {
    return std::clamp(double(value), 1e-6, 1 - 1e-6); // where the formulas are finite
  };
  const double share = std::clamp(double(transparency), 1e-9, 1 - 1e-9);
  const double colour = inside(c), brightest = inside(std::fmax(r, std::fmax(g, b)));
  const auto slope = [](double of) { return (1 / of - of) / 2; };
  // The inverse of T for the brightest channel.
  const double thickness =
      (std::asinh(slope(brightest) / std::sqrt(share)) + std::log(brightest)) / slope(brightest);
  const double x = slope(colour) * std::fmax(0.0, thickness), e = std::exp(-2 * x),
               below = 1 - e * colour * colour;
  const double through = std::exp(-x) * (1 - colour * colour) / below;
  return static_cast<float>(std::min(1.0, through * through));
}

// Returns what passes at this hit.
template <class F>
rts::ColorOf<F> passing(const rts::HitOf<F>& hit, rts::ColorOf<F> colour, float transparency) {
  const auto each = [&](F c) {
    const F twice = rts::eachLane([&](float own, float r, float g,
                                      float b) { return passingTwice(own, r, g, b, transparency); },
                                  c, colour.r, colour.g, colour.b);
    const F oneSided = rts::select(hit.back(), F(1), twice);
    return rts::select(hit.oneSided(), oneSided, rts::squareRoot(twice));
  };
  return {each(colour.r), each(colour.g), each(colour.b)};
}

} // namespace lacquer
