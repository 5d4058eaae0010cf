// error.h: error bars of a tile's pixels: confidence intervals from independent replicates, whether
// they can be trusted, and which replicates a frame takes. Pure functions of sums of samples.
// [render]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/film/film.h"
#include "render/wave/sampler.h"
#include "scene/scene.h"

namespace openrt {

// Returns the quantile of Student's distribution for two-sided intervals of level 95 %.
double student95(double degreesOfFreedom);

// Returns the replicates of a frame with the given number of samples. [any]
Replicates replicatesOf(const edit::FrameSettingsT& frame, uint32_t samples, uint32_t seed);

// Estimates the error of a pixel as if its samples were independent, for frames without replicates.
// The result is never trusted.
PixelError independentError(const PixelSums& sums);

// Whether the variance of a pixel is pooled with those of the neighbouring pixels of its tile.
// Pixels that are sensors (RT_MEASURE) have nothing in common with their neighbours.
enum class Pooling : uint8_t { neighbours, none };
inline Pooling poolingOf(const edit::FrameSettingsT& frame) {
  return frame.measure ? Pooling::none : Pooling::neighbours;
}

// Estimates the errors of a tile's pixels, row by row (error.cpp).
void tileErrors(uint32_t width, std::span<const PixelSums> pixels, const Replicates& replicates,
                std::span<PixelError> out, Pooling pooling = Pooling::neighbours);

// Adds the contribution and the error of light paths to a pixel's error.
void addLight(const LightSums& light, PixelError& error);
// Returns the half-width of the light paths' contribution alone, summed over the colours.
double lightHalfWidth(const LightSums& light);

} // namespace openrt
