// coverage.h: pictures against a reference: how far they are off, and how often their error bars
// hold it. Pure functions; used by vv --audit and --compare and by the audit of the tests. [any
// thread]
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace picture {

// One picture of a series that differs in the seed alone, with its error bars (RT_RGBA, RT_ERROR,
// RT_TRUST, RT_VARIANCE; variance may be empty) and what RTstats says of the whole.
struct Shot {
  std::vector<float> rgba, half, trust, variance;
  double samples = 1; // a pixel, on average
  double promised = 0, promisedInterval = 0;
};

struct Coverage {
  uint64_t pixels = 0, trusted = 0; // over all pictures
  uint64_t exact = 0,
           exactHeld =
               0; // of the trusted ones, those with no error at all: not counted in the share
  uint64_t held = 0, heldTrusted = 0;
  double halfWidth = 0; // mean of the trusted ones
  double meanError = 0, promised = 0,
         promisedInterval = 0; // of whole pictures: what they were off by, and what was said
  uint64_t shots = 0, promiseHeld = 0, promiseBelow = 0; // pictures; off by what was said, by less
  double bias = 0, biasInterval = 0; // of the pictures' means against the reference, relative
  double worstTiles = 1;             // 5th percentile over the tiles of their share
  double cost = 0; // mean square error over that of as many independent samples: 1 for plain Monte
                   // Carlo, less is better

  uint64_t intervals() const { return trusted - exact; }
  // Share of the trusted intervals that held, and the half-width of its own 95 % interval (E. B.
  // Wilson's score).
  double share() const;
  double shareInterval() const;
  double promiseShare() const { return shots ? double(promiseHeld) / double(shots) : 0; }
  double trustedShare() const { return pixels ? double(trusted) / double(pixels) : 0; }
};

// Red, green, blue of each pixel.
struct Reference {
  std::vector<double> colours;
  double worth = std::numeric_limits<double>::infinity(); // as many pictures of the series as it
                                                          // has samples; infinite: exact
  std::vector<float> half;                                // its own error bars, if it has any
};

// Red by itself stands for the pixel. Where the reference is not exact the other pictures of the
// series add to it, and the error that it has left makes the intervals wider (two means compared).
// Tiles: squares of tileEdge pixels, over all pictures.
Coverage countCoverage(const std::vector<Shot>& shots, const Reference& reference, int width,
                       int height, int tileEdge);

struct Difference { // of one picture from a reference, colours of all pixels
  double rmse = 0;
  double relMse = 0,
         trimmedRelMse =
             0; // mean of (I-R)^2 / (R^2 + 0.01); without the pixels of the highest 0.1 %
  double bias = 0, biasInterval = 0; // mean of I-R, and the half-width of its 95 % interval
  double p999 = 0, largest = 0;      // of |I-R|
  uint64_t notFinite = 0;            // pixels left out
};
Difference compare(const std::vector<float>& rgba, const std::vector<float>& reference);

} // namespace picture
