// globe.h: places on a globe by the coordinates of X3D's geospatial nodes (ISO/IEC 19775-1 25.2),
// in double precision. Pure functions, any thread.
#pragma once

#include <memory>
#include <optional>

#include "xvrml/node.h"

namespace xvrml {

// A place in geocentric metres, with its local axes as unit vectors: x to the east, y up, z to the
// south.
struct GlobePlace {
  Vec3d center, east{1, 0, 0}, up{0, 1, 0}, south{0, 0, 1};
};

// Returns the place that coordinates name in a geoSystem (25.2.3): "GD" (degrees of latitude and
// longitude, metres above the ellipsoid), "UTM" (metres to the north and to the east, with its
// zone), or "GC" (geocentric metres). None for another system and for numbers that name no place.
std::optional<GlobePlace> placeOnGlobe(const MFString& geoSystem, const Vec3d& coordinates);

// Returns whether the coordinates of a geoSystem begin with the longitude or the easting.
bool comesEastFirst(const MFString& geoSystem);

// The place that the coordinates of a world count from: that of its first geospatial node or
// GeoOrigin. Floats keep less than a metre at 6,400 km from the origin. All files of a world share
// one.
struct GlobeOrigin {
  std::optional<GlobePlace> place;
  bool turns = false;    // rotateYUp of the GeoOrigin: the axes are those of the place
  bool isCorner = false; // the place is the corner of a grid; a better one replaces it
};
using GlobeOriginPtr = std::shared_ptr<GlobeOrigin>;
// Returns the origin of the world whose file holds the node; null: the centre of the globe.
const GlobeOrigin* globeOriginOf(const Node& node);

} // namespace xvrml
