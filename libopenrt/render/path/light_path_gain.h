// light_path_gain.h: tells what it is worth that light paths and camera paths share light
// (lights/light_path_weights.h). [render]
#pragma once

#include <algorithm>
#include <cmath>

namespace openrt {

// Light that a light path has brought to a place of the picture, in pixels. radiance, square: what
// it would add to a pixel if there were one path for each pixel, summed over the colours, and its
// square. share: the weight of light paths there.
struct LightPathFind {
  double x, y, radiance, square, share;
};

// The second moments of the radiance that shared light brings to one camera path of each pixel,
// summed over the colours: by camera paths alone, by light paths alone, and by both with their
// weights, of which light paths have `ofLight`. They are sums over what light paths have found.
struct LightPathGain {
  double camera = 0, light = 0, both = 0, ofLight = 0;

  // Adds what a light path has found. square: its squared radiance. share: its weight. Found with
  // the density p and the ratio of pdfs q, it tells that camera paths of the density p / q have the
  // second moment q times the square there.
  void add(double square, double share) {
    constexpr double mostRatio = 1e4;
    share = std::min(1.0, share);
    const double ratio =
        share < 1 ? std::min(mostRatio, std::sqrt(share / (1 - share))) : mostRatio;
    if (!std::isfinite(square * ratio)) return;
    camera += square * ratio;
    light += square;
    ofLight += square * share * share;
    both += square * (ratio * (1 - share) * (1 - share) + share * share);
  }
};

} // namespace openrt
