// coverage.h: Compares pictures with a reference: how large the errors are, and how often the error
// bars contain the reference (coverage). Pure functions for vv --audit, vv --compare and the tests'
// audit. [any thread]
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace picture {

// One picture of a series in which only the seed differs, with its error bars (RT_RGBA, RT_ERROR,
// RT_TRUST, RT_VARIANCE; variance may be empty) and with the picture error that RTstats predicts.
struct Shot {
  std::vector<float> rgba, half, trust, variance;
  double samples = 1; // mean samples per pixel
  double promised = 0, promisedInterval = 0;
};

struct Coverage {
  uint64_t pixels = 0, trusted = 0; // sums over all pictures
  // The share leaves out two kinds of trusted intervals, which are counted here: those of zero
  // width, and upper bounds, which pixels without any variation have beside others. Bounds hold
  // more often than in 95 % of all cases.
  uint64_t exact = 0, exactHeld = 0, bounds = 0, boundsHeld = 0;
  uint64_t held = 0, heldTrusted = 0;
  double halfWidth = 0; // mean half-width of the intervals of the share
  // Mean errors of whole pictures: measured, predicted, and the interval of the prediction.
  double meanError = 0, promised = 0, promisedInterval = 0;
  // pictures; measured error inside the prediction's interval; below it
  uint64_t shots = 0, promiseHeld = 0, promiseBelow = 0;
  double bias = 0, biasInterval = 0; // mean of the pictures minus the reference, relative
  // 5th percentile of the coverage over the tiles with at least 100 intervals; 1 without such tiles
  double worstTiles = 1;
  // Mean square error divided by that of the same number of independent samples. Plain Monte Carlo
  // has 1; less is better.
  double cost = 0;

  uint64_t intervals() const { return trusted - exact - bounds; }
  // Returns the share of the trusted intervals that contain the reference, and the half-width of
  // its own 95 % interval (E. B. Wilson's score).
  double share() const;
  double shareInterval() const;
  double promiseShare() const { return shots ? double(promiseHeld) / double(shots) : 0; }
  double trustedShare() const { return pixels ? double(trusted) / double(pixels) : 0; }
};

// The colours of a reference picture: red, green, blue of each pixel.
struct Reference {
  std::vector<double> colours;
  // Number of pictures of the series with the same total of samples; infinite: the reference is
  // exact.
  double worth = std::numeric_limits<double>::infinity();
  std::vector<float> half; // error bars of the reference; empty if it has none
};

// Counts the coverage; the red channel stands for the pixel. A reference that is not exact is
// improved with the other pictures of the series, and its remaining error widens the intervals (a
// comparison of two means). Tiles are squares of tileEdge pixels, pooled over all pictures.
Coverage countCoverage(const std::vector<Shot>& shots, const Reference& reference, int width,
                       int height, int tileEdge);

struct Difference { // difference of one picture from a reference, over the colours of all pixels
  double rmse = 0;
  // Mean of (I-R)^2 / (R^2 + 0.01); the trimmed value omits the largest 0.1 % of the pixels.
  double relMse = 0, trimmedRelMse = 0;
  double bias = 0, biasInterval = 0; // mean of I-R, and the half-width of its 95 % interval
  double p999 = 0, largest = 0;      // 99.9th percentile and maximum of |I-R|
  uint64_t notFinite = 0;            // pixels left out because a value is not finite
};
Difference compare(const std::vector<float>& rgba, const std::vector<float>& reference);

} // namespace picture
