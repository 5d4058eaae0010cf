// picture_error.h: what a picture as a whole is off by: the mean over its pixels of their errors,
// with an interval that holds the true one, from what each pixel's replicates tell of the cumulants
// of its own error. Pure functions. [any]
#pragma once

#include <cstdint>
#include <span>

namespace openrt {

// Of the error of a pixel's mean.
struct PixelNoise {
  float own =
      0; // expected sum over the colours of |error|, were it normal, from the pixel's own variance
  float second = 0, third = 0, fourth = 0; // cumulants without bias, summed over the colours
  float square = 0;    // of the second cumulants, without bias, summed over the colours
  float scale = 0;     // colours summed + 0.03: what errors are relative to
  float largest = 0;   // largest sample, colours summed, over the number of samples
  bool random = false; // a path has taken a random decision
  bool finished = false;
};

struct PictureError {
  double mean = 0,
         interval =
             0; // relative; the picture's true mean error lies within mean +- interval with 95 %
};

// The pixels row by row; doubted: relative error expected of each pixel for other reasons, or NaN.
PictureError pictureError(uint32_t width, std::span<const PixelNoise> pixels,
                          std::span<const float> doubted);

// How errors that are the sum of something normal and of rare equal jumps differ from normal ones.
struct TailShape {
  double factor = 1;  // expected |error| over what pixels' own variances make of it, on average
  double without = 0; // pixels that have met no jump, for each that has
  double missing =
      0; // share of it that is at pixels that have not met what is rare and do not know of it
};
// variance: of the normal part over that of the jumps; jumps: expected number in a pixel.
TailShape tailShape(double variance, double jumps);

} // namespace openrt
