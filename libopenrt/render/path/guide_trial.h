// guide_trial.h: decides where photons guide rays (photon_guide.h). A few pixels are rendered with
// all photons. For each cell of the guide the trial sums up which variance the guided rays have
// taken away, and how many rays that took. The cells that are kept minimise variance times cost,
// which is the variance of all pictures that take the same time. One thread.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/film/sums.h"
#include "render/lights/photon_guide.h"
#include "render/surface/batch.h"

namespace openrt {

class GuideTrial {
 public:
  // cells: number of cells of the guide.
  explicit GuideTrial(uint32_t cells) : rays_(cells) {}

  // Counts a ray that starts in a cell, or goes on from there by way of a specular surface.
  void send(uint32_t cell) { rays_[cell]++; }
  // Counts light that such a ray has added to a sample. unguidedWeight: the MIS weight of BSDF
  // sampling for that light, above 0.
  void meet(uint32_t cell, const Vec3f& light, double unguidedWeight);
  // Ends a block of pixels. sums: of its pixels, with `delta2`.
  void endBlock(std::span<const PixelSums> sums);

  // Returns 1 for each cell that is to be kept, else 0. counters: all rays of the trial, with those
  // of the guide.
  std::vector<uint8_t> choose(const RayCounters& counters) const;

 private:
  struct Block {
    double mean, variance; // of the samples, summed over colours; variance: also over the samples
    size_t end;            // of its gains
  };
  struct Gain {
    uint32_t cell;
    double variance;
  };
  std::vector<uint32_t> rays_; // by cell
  std::vector<Gain> gains_;
  std::vector<Block> blocks_;
};

} // namespace openrt
