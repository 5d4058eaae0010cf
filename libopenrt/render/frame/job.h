// job.h: a piece of a frame's work, and what has become of it. What a job makes is a pure function
// of the committed scene and of the numbers in it: who does it, when, and how often does not
// matter. A FrameWork gives jobs out, a JobRunner does them, here or on another machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/film/ledger.h"
#include "render/film/sums.h"
#include "render/frame/tiles.h"
#include "render/path/sampler.h"
#include "render/surface/batch.h"

namespace openrt {

struct Job {
  enum class Kind : uint8_t {
    samples, // of a tile's pixels
    light    // a part of the picture that paths from lamps make
  };
  Kind kind = Kind::samples;
  bool centred = false;  // one sample in the middle of each pixel
  uint32_t number = 0;   // the tile; the part
  uint32_t first = 0;    // first sample
  uint32_t count = 0;    // samples of a pixel; paths
  Replicates replicates; // of light only the seed
  bool operator==(const Job&) const = default;
};

struct JobResult {
  std::vector<PixelSums>
      sums; // of a tile, row by row; what the frame does not gather (Gathering) means nothing
  std::vector<float> light; // rgb of the whole picture, row by row
  Ledger ledger;
  RayCounters counters;
  double seconds = 0; // it took, on one thread
};

} // namespace openrt
