// glossy_gain.h: tells what light paths by way of glossy surfaces are worth
// (lights/light_path_weights.h). [render]
#pragma once

#include <algorithm>
#include <cmath>

namespace openrt {

// The second moments of the radiance that such light paths and one camera path of each pixel find,
// summed over the colours. They are sums over what light paths have found; whoever has traced them
// divides by the number of camera paths.
struct GlossyGain {
  double without = 0, with = 0; // camera paths alone; both, with their weights

  // Adds what a light path has found. square: its squared radiance. share: its weight. Found with
  // the density p and the ratio of pdfs q, it tells that camera paths of the density p / q have the
  // second moment q times the square there.
  void add(double square, double share) {
    constexpr double mostRatio = 1e4;
    share = std::min(1.0, share);
    const double ratio =
        share < 1 ? std::min(mostRatio, std::sqrt(share / (1 - share))) : mostRatio;
    if (!std::isfinite(square * ratio)) return;
    without += square * ratio;
    with += square * (ratio * (1 - share) * (1 - share) + share * share);
  }
};

} // namespace openrt
