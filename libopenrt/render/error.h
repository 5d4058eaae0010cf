// error.h: how far a pixel may be off: intervals from independent replicates, whether they can be trusted; how many
// samples make them small enough. Pure functions of sums of samples. [render]
#pragma once

#include <cstdint>
#include <vector>

#include "render/film.h"
#include "render/sampler.h"
#include "scene/scene.h"

namespace openrt {

// Quantile of Student's distribution for two-sided intervals of level 95 %.
double student95(uint32_t degreesOfFreedom);

// Whether somebody asks for the error of a frame.
bool wantsError(const edit::FrameSettingsT& frame);
// The replicates of a frame of a number of samples. [any]
Replicates replicatesOf(const edit::FrameSettingsT& frame, uint32_t samples, uint32_t seed);

// Of 8x8 pixels: what is rare in one of them may be missing from its neighbours.
struct Tails {
  double square2 = 0, fourth = 0; // sums over the pixels of (sum of squares)^2 / samples and of the sum of fourth powers
  double skewness = 0;            // sum over the random pixels of |skewness of their replicates' means|
  uint32_t varying = 0;
  float largest[3] = {};

  void add(const PixelSums& sums);
  double kurtosis() const { return square2 > 0 ? fourth / square2 : 0; }
  double meanSkewness() const { return varying ? skewness / varying : 0; }
};

// Around: null where no tails were gathered: then there are no replicates either.
PixelError pixelError(const PixelSums& sums, const Replicates& replicates, const Tails* around);

// Samples that a part of the picture needs for a relative half-width, from independent ones: rounded up to a power of two.
uint32_t samplesFor(double target, double halfWidth, uint32_t samples, uint32_t most);

} // namespace openrt
