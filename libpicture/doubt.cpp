#include "libpicture/doubt.h"

#include <algorithm>
#include <cmath>

#include "libpicture/luminance.h"
#include "openrt/openrt.h"
#include "student.h"

namespace picture {

namespace {

// Returns the mean luminance of the pixels that are finite.
double meanOf(const std::vector<float>& rgba) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < rgba.size(); i += 4)
    if (const float v = luminanceOf(&rgba[i]); std::isfinite(v)) {
      sum += double(v);
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

} // namespace

std::vector<float> doubtOf(const Picture& raw, const std::vector<float>& denoised) {
  constexpr double ofPixel = 0x1p-7, ofPicture = 0x1p-10, most = 99;
  const std::vector<float>&rgba = rgbaOf(raw), &error = raw.planes.at(RT_ERROR),
        &trust = raw.planes.at(RT_TRUST);
  const double least = ofPicture * std::abs(meanOf(rgba));
  std::vector<float> doubt(rgba.size() / 4, notJudged);
  for (size_t i = 0; i < doubt.size(); ++i) {
    const float *const before = &rgba[4 * i], *const now = &denoised[4 * i];
    if (!(trust[i] > 0)) continue;
    const double brightest = std::abs(double(std::max({before[0], before[1], before[2]})));
    const double margin = std::max(least, ofPixel * brightest);
    double farthest = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double half = std::max(student::from95To99 * double(error[3 * i + k]), margin);
      const double away = std::abs(double(now[k]) - double(before[k]));
      // 0 / 0: both are black in a black picture
      const double here = away == 0 ? 0 : away / half;
      farthest = std::isfinite(here) ? std::max(farthest, here) : most;
    }
    doubt[i] = float(std::min(farthest, most));
  }
  return doubt;
}

DoubtCounts countDoubt(const std::vector<float>& doubt) {
  DoubtCounts counts;
  counts.pixels = doubt.size();
  for (const float v : doubt) {
    counts.judged += v >= 0;
    counts.doubtful += v > 1;
  }
  return counts;
}

} // namespace picture
