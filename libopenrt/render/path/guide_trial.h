// guide_trial.h: decides where photons guide rays (photon_guide.h), and how many. A few pixels are
// rendered with a guided ray at every hit near photons. For each cell of the guide the trial sums
// up which variance the guided rays have taken away, and how many rays that took. The shares of
// hits that send a guided ray minimise variance times cost, which is the variance of all pictures
// that take the same time. One thread.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/film/sums.h"
#include "render/lights/photon_guide.h"
#include "render/wave/batch.h"

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

  // Returns the share of each cell: 0 or one of `shares`, if `always` is set one from `leastAlways`
  // on. counters: all rays of the trial, with those of the guide.
  std::vector<float> choose(const RayCounters& counters, bool always = false) const;
  static constexpr float shares[] = {1 / 16.f, 1 / 4.f, 1 / 2.f, 1};
  // Samples of a rarely guided ray are few and bright, and intervals become too narrow.
  static constexpr size_t leastAlways = 2;

 private:
  struct Block {
    double mean, variance; // samples summed over colours; variance: also over the samples
    size_t end;            // where its gains end
  };
  struct Gain {
    uint32_t cell;
    double square, unguidedWeight; // sums over the light
    // Returns the variance that guided rays at a share of the hits take away.
    double at(double share) const {
      return square * share / (unguidedWeight * (unguidedWeight + share * (1 - unguidedWeight)));
    }
  };
  std::vector<uint32_t> rays_; // by cell
  std::vector<Gain> gains_;
  std::vector<Block> blocks_;
};

} // namespace openrt
