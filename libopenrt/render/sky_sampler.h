// sky_sampler.h: directions of the environment in proportion to its radiance: a table of cells of equal latitude and longitude in
// its local space, as fine as its pictures, at least fine enough for a sun of half a degree. M. Pharr, W. Jakob, G. Humphreys,
// "Physically Based Rendering", 4th ed., 12.5 (without its compensation, so that the choice serves alone where need be). Made
// between frames when the environment or its pictures change, read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

namespace openrt {

struct RenderScene;

class SkySampler {
 public:
  // Reads the environment of the scene; not usable() where there is none or it is black.
  explicit SkySampler(const RenderScene& scene);
  bool usable() const { return total_ > 0; }
  double brightest() const { return brightest_; } // largest mean radiance of a cell, colours summed
  // Whether some of 2048 directions of the scene's environment, which has `miss`, has light.
  static bool shines(const RenderScene& scene);
  // A local unit direction and its density by solid angle, from a point of the unit square. 0: none.
  float sample(double u, double v, float direction[3]) const;
  float density(const float direction[3]) const;
  uint32_t columns() const { return columns_; }

 private:
  SkySampler() = default;
  // Writes the mean luminance of each cell; returns the largest mean radiance of one, colours summed.
  double measure(const RenderScene& scene, std::vector<float>& cells) const;
  double solidAngle(uint32_t row) const;
  float cellDensity(uint32_t row, uint32_t column) const;
  uint32_t columns_ = 0, rows_ = 0;
  std::vector<float> inRow_;  // by cell: share of its row up to its end
  std::vector<double> byRow_; // share of the sphere up to the row's end
  double total_ = 0, brightest_ = 0;
};

} // namespace openrt
