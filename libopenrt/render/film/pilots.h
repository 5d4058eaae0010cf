// pilots.h: how many samples each tile of a frame with a target error takes. Pilots decide it:
// samples that are thrown away, so that those which make the picture know nothing of the decision
// (docs/decisions/0037). Called by FrameWork; a pure function of the pilots' samples, whoever takes
// them and in whatever order they come.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/film/error.h"
#include "render/frame/tiles.h"
#include "scene/scene.h"

namespace openrt {

inline constexpr uint32_t samplesOfPilot = 32; // of the first one

// Samples of the first pilot of a frame, 0: it needs none.
uint32_t firstPilotOf(const edit::FrameSettingsT& frame, bool timed);

// What a pilot tells of a pixel: relative half-widths, which may be more than 1.
struct PilotPixel {
  float noise = 0;       // of its samples
  float light = 0;       // of the paths from lamps, whose number does not depend on the samples
  bool trusted = false;  // of its samples alone
  bool constant = false; // all samples are equal, and nothing is random
};
// error: of the samples alone; paths from lamps are added to it.
PilotPixel pilotPixel(PixelError& error, const LightSums* light);

class Pilots {
 public:
  Pilots(const edit::FrameSettingsT& frame, const TileGrid& grid, bool timed);

  struct Verdict {
    uint32_t samples = 0;
    bool pilot = false; // so many samples of a further pilot; else of the picture
  };
  // What the first pilot has found in a tile, row by row. [any] Each tile once.
  void note(uint32_t tile, std::span<const PilotPixel> pixels, std::span<const PixelError> errors);
  // Of all tiles, once all are noted.
  std::vector<Verdict> judgeAll();
  // What a further pilot of so many samples has found in a tile. After judgeAll(). [any]
  Verdict judge(uint32_t tile, std::span<const PilotPixel> pixels, uint32_t samples) const;

 private:
  struct Opinion {
    uint32_t wanted = 0;
    double unknown =
        0; // relative half-width that the tile's pixels have by what they do not trust, then
  };
  float doubtOf(const PilotPixel& pixel, size_t at) const {
    return pixel.constant && !doubt_.empty() ? doubt_[at] : 0;
  }
  double expected(const Tile& tile, std::span<const PilotPixel> pixels, double samples,
                  double wanted) const;
  Opinion opinion(const Tile& tile, std::span<const PilotPixel> pixels, uint32_t samples) const;
  Verdict verdict(const Opinion& opinion, double unknown, uint32_t samples) const;
  std::vector<PilotPixel> pixelsOf(const Tile& tile) const;

  const TileGrid grid_;
  const uint32_t width_, most_;
  const double target_;
  const bool timed_;
  const std::vector<uint32_t> ladder_; // numbers of samples that tiles may take
  // Row by row, of the first pilot. The half-width that constant pixels beside an edge have:
  // neighbours of other tiles tell.
  ErrorMap map_;
  std::vector<PilotPixel> first_;
  std::vector<float> scale_, doubt_;
};

} // namespace openrt
