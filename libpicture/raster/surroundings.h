// surroundings.h: The colours of a Background and the Fog of a world, for the z-buffer renderer.
// [made on the thread that owns the world; used on any thread]
#pragma once

#include <optional>
#include <vector>

#include "libpicture/raster/affine.h"
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

// Fog (6.19). Distances are those of the world, also where the node is scaled.
class Haze {
 public:
  // Returns nothing for a node that is no Fog, or is clear air.
  static std::optional<Haze> of(const xvrml::Node& node, bool linear);
  // Returns the colour of a shape at this distance.
  xvrml::Color over(const xvrml::Color& shape, double distance) const;

 private:
  xvrml::Color color_;
  double range_ = 0;
  bool exponential_ = false;
};

} // namespace picture::raster
