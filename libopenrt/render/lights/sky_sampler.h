// sky_sampler.h: importance sampling of the environment by its radiance. A table of equal
// latitude-longitude cells in its local space has the resolution of the environment's textures, and
// at least enough resolution for a sun of half a degree. M. Pharr, W. Jakob, G. Humphreys,
// "Physically Based Rendering", 4th ed., 12.5. Only what is brighter than the mean is sampled,
// because BSDF sampling finds the rest as well (MIS compensation: O. Karlik et al., "MIS
// Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", SIGGRAPH Asia
// 2019). So a sky of one radiance needs no light samples at all, and the strategy is unbiased only
// together with BSDF sampling. Built between frames when the environment or its textures change,
// read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/vec3.h"

namespace openrt {

struct RenderScene;

class SkySampler {
 public:
  // Tabulates the scene's environment.
  explicit SkySampler(const RenderScene& scene);
  // Returns whether there is no environment or it emits nothing.
  bool black() const { return !(emitted_ > 0); }
  // Returns whether sample() has directions: not if the sky is black or has nearly one radiance.
  bool usable() const { return total_ > 0; }
  // Returns the irradiance (as luminance) by what is sampled of the sky, averaged over the
  // orientations of a surface.
  double irradiance() const { return total_ / 4; }
  // Returns the largest mean radiance of a cell, summed over the colours.
  double brightest() const { return brightest_; }
  // Returns whether the scene's environment emits light in any of 2048 directions. The environment
  // must have `miss`.
  static bool shines(const RenderScene& scene);
  // Returns whether the sky has a sun: cells so bright and so small that light paths find their
  // light by way of mirrors and glass with less noise than BSDF sampling does.
  bool hasSun() const { return !sun_.empty(); }
  // Returns the luminance of the sun, integrated over its solid angle.
  double sunIrradiance() const { return sun_.empty() ? 0 : sun_.back().cumulative; }
  // Samples a local unit direction of the sun. pick, u, v: in [0, 1). Returns its solid-angle pdf.
  double sampleSun(double pick, double u, double v, Vec3f& direction) const;
  // Returns whether sampleSun() can return a local direction.
  bool isInSun(const Vec3f& direction) const;
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
  void listSun(const std::vector<float>& radiance);
  // Finds the cell of a local direction. Returns false if that is not a number.
  bool cellOf(const Vec3f& direction, uint32_t& row, uint32_t& column) const;
  // Returns the direction at a place of a cell, given as shares of its height and width.
  Vec3f directionIn(uint32_t row, uint32_t column, double down, double along) const;
  uint32_t columns_ = 0, rows_ = 0;
  std::vector<float> inRow_;  // by cell: cumulative share of its row
  std::vector<double> byRow_; // by row: cumulative share of the sphere
  std::vector<double> edge_;  // cosines of the polar angles that bound the rows
  // Luminance, integrated over the sphere: of the whole sky, and of what is sampled.
  double emitted_ = 0, total_ = 0;
  double brightest_ = 0;
  struct SunCell {
    uint32_t cell;     // row times columns, plus column; ascending
    double cumulative; // luminance times solid angle of this cell and those before it
  };
  std::vector<SunCell> sun_;
};

} // namespace openrt
