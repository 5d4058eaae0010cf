// camera_rays.h: the first stage of path tracing: samples positions on the film, asks the camera
// shader for the rays through them, and maps these to render space. [render]
#pragma once

#include <cstdint>
#include <span>

#include "render/wave/batch.h"
#include "render/wave/pixel_samples.h"
#include "render/wave/random_numbers.h"

namespace openrt {

// The samples of a wave: `perPixel` of each pixel, from sample `first` on. Paths are in the order
// of the pixels, then of the samples.
struct FilmSamples {
  std::span<const uint32_t> pixels; // y * width + x
  uint32_t width;                   // the width of the picture
  uint32_t first, perPixel;
  Replicates replicates;
  bool centred; // all positions are in the middles of the pixels
  bool inTurn;  // first samples of consecutive seeds are consecutive points of a sequence

  uint32_t count() const { return uint32_t(pixels.size()) * perPixel; }
};

// Sets the sampler's sequences and points of the paths.
void startSamples(const FilmSamples& film, PathSamples& samples);
// Samples the paths' positions on the film, in pixels. The arrays are padded with the last one.
void sampleFilm(const FilmSamples& film, const PathSamples& samples, Arena& arena, float* xy[2]);
// Records where in their pixels these positions are, if the frame asks for it (RT_PLACE).
void recordPlaces(const FilmSamples& film, const float* const xy[2], const PixelSamples& found);
// Makes the rays of the camera through positions on the film, in render space.
void makeCameraRays(const StageContext& context, const float* const xy[2], Rays& rays);

} // namespace openrt
