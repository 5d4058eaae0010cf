// job.h: a unit of a frame's work and its result. The result is a pure function of the committed
// scene and of the numbers in the job: it does not matter who does it, when, or how often. A
// FrameWork hands out jobs; a JobRunner does them, here or on another machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/film/ledger.h"
#include "render/film/sums.h"
#include "render/wave/batch.h"
#include "render/wave/sampler.h"
#include "render/wave/tiles.h"

namespace openrt {

struct Job {
  enum class Kind : uint8_t {
    samples, // samples of a tile's pixels
    light    // a part of the light tracing picture
  };
  Kind kind = Kind::samples;
  bool centred = false;  // take one sample in the middle of each pixel
  uint32_t number = 0;   // number of the tile or of the part
  uint32_t first = 0;    // first sample
  uint32_t count = 0;    // samples per pixel, or light paths
  Replicates replicates; // light tracing uses only the seed
  bool operator==(const Job&) const = default;
};

struct JobResult {
  // Sums of a tile, row by row. Fields that the frame does not need are undefined (RequiredSums).
  std::vector<PixelSums> sums;
  HitCounts hits;           // how often the tile's pixels hit each name, if that is needed
  std::vector<float> light; // rgb of the whole picture, row by row
  Ledger ledger;
  RayCounters counters;
  uint64_t faultsBefore = 0; // shader faults of a result that another process has made
  double seconds = 0;        // time that it took on one thread
};

} // namespace openrt
