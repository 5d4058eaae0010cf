// frame_sums.h: the sums of a frame, kept beside its picture: what a frame was told, and the
// results of its jobs so far (docs/decisions/0070). Another process continues the frame from them,
// and sums of finished frames of different seeds are added. They are immutable once shared. [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/film/light_image.h"
#include "render/film/sums.h"
#include "render/frame/frame_work.h"
#include "scene/scene.h"
#include "scene/sums_error.h"

namespace openrt {

// Results of jobs that lie side by side: samples of a tile, of the picture or of a pilot.
struct KeptBlock {
  Replicates replicates; // the seed tells pictures and pilots apart
  uint32_t first = 0, count = 0;
  RayTotals rays;
  std::shared_ptr<const std::vector<std::byte>> bytes; // as of encodeResult()
};

// Sums of consecutive seeds. Those of more than one seed, or of a condensed frame, have one block a
// tile, with `count` samples of each seed.
struct SeedSums {
  uint32_t first = 0, count = 1;
  std::vector<std::vector<KeptBlock>> tiles; // by tile, in the order of samples
  LightImage::State light;                   // empty without light tracing
  RayTotals lightRays;                       // those of the light paths
};

struct FrameSums {
  edit::FrameSettingsT frame; // with the transport that was chosen; the seed is that of seeds[0]
  FrameFacts facts;
  SumsIdentity identity;
  bool complete = false;       // all jobs are done
  bool condensed = false;      // SeedSums have one block a tile
  std::vector<SeedSums> seeds; // in the order of seeds; one if not condensed
};

using FrameSumsPtr = std::shared_ptr<const FrameSums>;

// Returns the least that is needed of a finished frame to make its picture and to add it to others.
// Throws SumsError if it is not finished, or of a kind that cannot be added.
FrameSumsPtr condense(const FrameSums& sums);
// Adds sums of different seeds. The result does not depend on order and grouping: neighbours merge
// in aligned blocks of seeds, as samples do. Throws SumsError if they do not belong together.
FrameSumsPtr mergeSums(const FrameSums& a, const FrameSums& b);

// Throws SumsError if a frame with these settings cannot continue from the sums.
void checkContinues(const FrameSums& sums, const edit::FrameSettingsT& frame,
                    const FrameFacts& facts, const SumsIdentity& identity);
// Returns whether a block of the sums is also one of a frame with so many samples.
bool isBlockOf(const KeptBlock& block, uint32_t samplesOfSums, uint32_t samples);

// The sums as bytes (sums_codec.cpp). readSums() takes bytes from anywhere; throws SumsError.
std::vector<std::byte> writeSums(const FrameSums& sums);
FrameSumsPtr readSums(std::span<const std::byte> bytes);

// Makes the sums of a tile from a block of condensed sums. Throws SumsError.
void decodeSeeds(const edit::FrameSettingsT& frame, const Tile& tile, const SeedSums& seeds,
                 const KeptBlock& block, SumBlock& out);
// Returns a job that has the samples of a block.
Job jobOf(uint32_t tile, const KeptBlock& block);

} // namespace openrt
