// pilots.h: adaptive sampling: decides how many samples each tile of a frame with a target error
// takes. The decision is made from pilot samples, which are thrown away, so that the picture's
// samples are independent of it (docs/decisions/0037). Called by FrameWork. The decision is a pure
// function of the pilots' samples, in whatever order they arrive.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/film/error.h"
#include "render/wave/tiles.h"
#include "scene/scene.h"

namespace openrt {

inline constexpr uint32_t samplesOfPilot = 32; // samples per pixel of the first pilot

// Returns the number of samples of a frame's first pilot; 0: it needs none.
uint32_t firstPilotOf(const edit::FrameSettingsT& frame, bool timed);

// Result of a pilot for one pixel: relative half-widths, which may exceed 1.
struct PilotPixel {
  float noise = 0; // half-width of the samples
  float light = 0; // half-width of the light paths, whose number does not depend on the samples
  bool trusted = false;  // whether the error of the samples alone is trusted
  bool constant = false; // all samples are equal and no path took a random decision
};
// Summarises a pixel. error: error of the samples alone; this function adds the error of the light
// paths to it.
PilotPixel pilotPixel(PixelError& error, const LightSums* light);

class Pilots {
 public:
  Pilots(const edit::FrameSettingsT& frame, const TileGrid& grid, bool timed);

  struct Decision {
    uint32_t samples = 0;
    // true: take a further pilot of `samples`; false: take `samples` for the picture
    bool pilot = false;
  };
  // Stores the first pilot's results of a tile, row by row. Call once for each tile. [any]
  void note(uint32_t tile, std::span<const PilotPixel> pixels, std::span<const PixelError> errors);
  // Decides for all tiles, after note() was called for each.
  std::vector<Decision> decideAll();
  // Decides after a further pilot of `samples` of a tile. Call after decideAll(). [any]
  Decision decide(uint32_t tile, std::span<const PilotPixel> pixels, uint32_t samples) const;

 private:
  struct Estimate {
    uint32_t wanted = 0;
    // Relative half-width that untrusted pixels contribute after `wanted` samples.
    double unknown = 0;
  };
  float doubtOf(const PilotPixel& pixel, size_t at) const {
    return pixel.constant && !doubt_.empty() ? doubt_[at] : 0;
  }
  double expected(const Tile& tile, std::span<const PilotPixel> pixels, double samples,
                  double wanted) const;
  Estimate estimate(const Tile& tile, std::span<const PilotPixel> pixels, uint32_t samples) const;
  Decision decision(const Estimate& estimate, double unknown, uint32_t samples) const;
  std::vector<PilotPixel> pixelsOf(const Tile& tile) const;

  const TileGrid grid_;
  const uint32_t width_, most_;
  const double target_;
  const bool timed_;
  const std::vector<uint32_t> ladder_; // the numbers of samples that a tile may take
  // Results of the first pilot, row by row. The half-width of constant pixels beside an edge
  // depends on neighbours in other tiles.
  ErrorMap map_;
  std::vector<PilotPixel> first_;
  std::vector<float> scale_, doubt_;
};

} // namespace openrt
