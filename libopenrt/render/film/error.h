// error.h: how far the pixels of a tile may be off: intervals from independent replicates, whether
// they can be trusted; how many samples make them small enough. Pure functions of sums of samples.
// [render]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/film/film.h"
#include "render/path/sampler.h"
#include "scene/scene.h"

namespace openrt {

// Quantile of Student's distribution for two-sided intervals of level 95 %.
double student95(double degreesOfFreedom);

// Whether somebody asks for the error of a frame.
bool wantsError(const edit::FrameSettingsT& frame);
// The replicates of a frame of a number of samples. [any]
Replicates replicatesOf(const edit::FrameSettingsT& frame, uint32_t samples, uint32_t seed);

// What independent samples would have: for frames without replicates. Never trusted.
PixelError independentError(const PixelSums& sums);

// Of a tile: its pixels' sums row by row, as many errors. All that its pixels know of each other is
// used (error.cpp).
void tileErrors(uint32_t width, std::span<const PixelSums> pixels, const Replicates& replicates,
                std::span<PixelError> out);

// What paths from lamps add to a pixel.
void addLight(const LightSums& light, PixelError& error);
// The half-width of that by itself, colours summed.
double lightHalfWidth(const LightSums& light);

} // namespace openrt
