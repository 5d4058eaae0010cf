// lamps.h: The lights of a world by the equations of ISO/IEC 14772-1 (4.6.6, 4.14.4), without
// shadows. [lists: the thread that owns the world; lit(): any thread]
#pragma once

#include <numbers>
#include <vector>

#include "libpicture/raster/affine.h"
#include "xvrml/renderer.h"

namespace picture::raster {

// The light of one lamp at a point.
struct Incident {
  Vec toLight; // a unit vector
  xvrml::Color direct, ambient;
};

// The path to a group; empty: everything.
using GroupPath = std::vector<const xvrml::Node*>;
// Returns the scope of a node that acts on its parent group, or, if it is global, on the Inline
// that it is in.
GroupPath scopeOf(const xvrml::RenderState& state, bool global);
// Returns whether a shape is within the scope.
bool isWithin(const GroupPath& scope, const xvrml::RenderState& shape);

class Lamp {
 public:
  // Returns a parallel light, as a headlight is. asNode: it shines as a light node does.
  static Lamp along(const Vec& direction, bool asNode);
  // Returns a light at a point that does not grow weaker with distance, and is as bright on all
  // materials.
  static Lamp at(const Vec& place);
  // Returns nothing for nodes that are no lamps, that are off, and whose place is unusable.
  static std::optional<Lamp> of(const xvrml::Node& node, const xvrml::RenderState& state,
                                bool linear);
  // Returns whether a shape is within the group that the lamp shines on.
  bool reaches(const xvrml::RenderState& shape) const { return isWithin(scope_, shape); }
  Incident incidentAt(const Vec& point) const;
  // Returns the factor of the direct light at a surface that takes intensities as irradiances.
  float irradianceFactor() const { return isNode_ ? float(1 / std::numbers::pi) : 1.0f; }

 private:
  enum class Kind : uint8_t { directional, point, spot };
  Lamp() = default;
  template <class T> void setLight(const T& light, bool linear);
  template <class T> void setPlaced(const T& light, bool linear);

  Kind kind_ = Kind::point;
  bool isNode_ = true;
  xvrml::Color direct_{1, 1, 1}, ambient_;
  Affine toWorld_, fromWorld_; // from the lamp's coordinates, in which distances are measured
  Vec location_, axis_;        // axis_: where the light travels to
  Vec attenuation_{1, 0, 0};
  double radius_ = 0, beam_ = 0, cut_ = 0;
  GroupPath scope_;
};

// More lamps than this light nothing, so that a hostile world ends.
inline constexpr size_t maximumLamps = 32;

} // namespace picture::raster
