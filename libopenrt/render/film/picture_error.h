// picture_error.h: the error of the picture as a whole: the mean over its pixels of their errors,
// with a confidence interval. It is computed from the cumulants of each pixel's own error, which
// its replicates provide. Pure functions. [any]
#pragma once

#include <cstdint>
#include <span>

namespace openrt {

// Statistics of the error of a pixel's mean.
struct PixelNoise {
  // Expected |error| summed over the colours, if it were normal with the pixel's own variance.
  float own = 0;
  float second = 0, third = 0, fourth = 0; // unbiased cumulants, summed over the colours
  float square = 0;    // unbiased squares of the second cumulants, summed over the colours
  float scale = 0;     // sum of the colours + 0.03: errors are relative to this
  float largest = 0;   // largest sample (sum of the colours) over the number of samples
  bool random = false; // a path of the pixel has taken a random decision
  bool finished = false;
};

struct PictureError {
  // Relative errors. The true mean error of the picture lies within mean +- interval with 95 %
  // confidence.
  double mean = 0, interval = 0;
};

// Estimates the picture's error from its pixels, row by row. doubted: relative error expected of
// each pixel for other reasons, or NaN.
PictureError pictureError(uint32_t width, std::span<const PixelNoise> pixels,
                          std::span<const float> doubted);

// How the distribution of errors that are the sum of a normal part and of rare equal jumps differs
// from a normal one.
struct TailShape {
  double factor = 1;  // expected |error| over the mean of what the pixels' own variances suggest
  double without = 0; // number of pixels without a jump for each pixel with one
  // share of the error at pixels without a jump, whose own variance does not show it
  double missing = 0;
};
// variance: variance of the normal part divided by that of the jumps. jumps: expected number of
// jumps in a pixel.
TailShape tailShape(double variance, double jumps);

} // namespace openrt
