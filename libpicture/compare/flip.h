// flip.h: FLIP, how different two pictures look to somebody who flips between them. For display
// colours: P. Andersson and others, "FLIP: A Difference Evaluator for Alternating Images", HPG
// 2020. For radiance: P. Andersson and others, "Visualizing Errors in Rendered High Dynamic Range
// Images", Eurographics 2021. Pure functions, for vv compare. [any thread]
#pragma once

#include <vector>

#include "libpicture/files/picture.h"

namespace picture {

struct Flip {
  double mean = 0;        // 0: they look the same, 1: the most
  int exposures = 0;      // exposures at which radiance was compared; 0: display colours
  std::vector<float> map; // FLIP for each pixel, first row at the top
};

// Returns FLIP at 67.02 pixels a degree, which the papers assume. The pictures have rgba, one size,
// and both radiance or both display colours (Picture::linear). Exposures are chosen by the
// reference, at most 64 of them. Values that are not finite count as 0.
Flip flipOf(const Picture& reference, const Picture& test);

} // namespace picture
