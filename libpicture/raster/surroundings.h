// surroundings.h: The colours of a Background and the Fog of a world, for the z-buffer renderer.
// [made on the thread that owns the world; used on any thread]
#pragma once

#include <optional>
#include <vector>

#include "libpicture/raster/affine.h"
#include "libpicture/raster/lamps.h"
#include "xvrml/renderer.h"

namespace picture::raster {

// Sky and ground as gradients (ISO/IEC 14772-1 6.5). Pictures around are left out.
class Sky {
 public:
  // Returns nothing for a node that is neither a Background nor a TextureBackground.
  static std::optional<Sky> of(const xvrml::Node& node, const double* matrix, bool linear);
  struct Seen {
    xvrml::Color color;
    float alpha = 0;
  };
  Seen along(const Vec& direction) const;

 private:
  struct Stop {
    double angle; // from the pole
    xvrml::Color color;
  };
  template <class T> void read(const T& node, bool linear);
  static std::vector<Stop> stopsOf(const std::vector<xvrml::Color>& colors,
                                   const std::vector<float>& angles, double most, bool linear);
  static xvrml::Color at(const std::vector<Stop>& stops, double angle);

  Affine fromWorld_;
  std::vector<Stop> sky_, ground_; // from the zenith, and from the nadir
  float alpha_ = 1;
};

// Fog (6.19) and LocalFog (ISO/IEC 19775-1 24.4.4). Distances are those of the world, also where
// the node is scaled.
class Haze {
 public:
  // Returns nothing for a node that is no Fog, or is clear air.
  static std::optional<Haze> of(const xvrml::Node& node, bool linear);
  // Returns nothing for a node that is no LocalFog, or is not enabled.
  static std::optional<Haze> local(const xvrml::Node& node, const xvrml::RenderState& state,
                                   bool linear);
  // Returns the colour of a shape at this distance.
  xvrml::Color over(const xvrml::Color& shape, double distance) const;
  bool reaches(const xvrml::RenderState& shape) const { return isWithin(scope_, shape); }
  size_t depth() const { return scope_.size(); } // groups above a LocalFog

 private:
  template <class T> static Haze from(const T& fog, bool linear);

  GroupPath scope_;
  xvrml::Color color_;
  double range_ = 0;
  bool exponential_ = false;
};

// More LocalFogs than this hide nothing, so that a hostile world ends.
inline constexpr size_t maximumLocalFogs = 256;

} // namespace picture::raster
