// sky_sampler.h: importance sampling of the environment by its radiance. A table of equal
// latitude-longitude cells in its local space has the resolution of the environment's textures, and
// at least enough resolution for a sun of half a degree. M. Pharr, W. Jakob, G. Humphreys,
// "Physically Based Rendering", 4th ed., 12.5, without MIS compensation, so that the strategy is
// also unbiased alone. Built between frames when the environment or its textures change, read by
// all render threads.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/vec3.h"

namespace openrt {

struct RenderScene;

class SkySampler {
 public:
  // Tabulates the scene's environment. usable() is false if there is none or it is black.
  explicit SkySampler(const RenderScene& scene);
  bool usable() const { return total_ > 0; }
  // Returns the irradiance (as luminance) by the whole sky, averaged over the orientations of a
  // surface.
  double irradiance() const { return total_ / 4; }
  // Returns the largest mean radiance of a cell, summed over the colours.
  double brightest() const { return brightest_; }
  // Returns whether the scene's environment emits light in any of 2048 directions. The environment
  // must have `miss`.
  static bool shines(const RenderScene& scene);
  // Samples a local unit direction from a point of the unit square and returns its solid-angle pdf;
  // 0: no sample.
  float sample(double u, double v, Vec3f& direction) const;
  float pdf(const Vec3f& direction) const;
  uint32_t columns() const { return columns_; }

 private:
  SkySampler() = default;
  // Writes the mean luminance of each cell; returns the largest mean radiance of one, colours
  // summed.
  double measure(const RenderScene& scene, std::vector<float>& cells) const;
  double solidAngle(uint32_t row) const;
  float cellPdf(uint32_t row, uint32_t column) const;
  uint32_t columns_ = 0, rows_ = 0;
  std::vector<float> inRow_;  // by cell: cumulative share of its row
  std::vector<double> byRow_; // by row: cumulative share of the sphere
  double total_ = 0, brightest_ = 0;
};

} // namespace openrt
