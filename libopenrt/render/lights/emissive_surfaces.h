// emissive_surfaces.h: quadrics of revolution and aspheres as area lights: points sampled on them,
// and pdfs by solid angle as seen from a point. Pure functions. [any]
#pragma once

#include "render/records.h"

namespace openrt {

// A point of an analytic surface in render space.
struct SurfacePlace {
  Vec3d position, normal; // normal: unit, on the side of the gradient
  double area;            // 1 / pdf by area; 0: nothing of the surface is there
};

// Returns the point that belongs to (u, v) of the unit square. The record's surface must be
// samplable().
SurfacePlace sampledPlace(const Record& record, double u, double v);

// Returns the pdf of a point by solid angle as seen from `eye`. Writes the unit direction to the
// point and its distance. Returns 0 if the point is seen from a side that does not emit. sides:
// EmissiveShapes::Shape::sides.
double pdfOfPlace(const SurfacePlace& place, uint8_t sides, const Vec3f& eye, Vec3d& direction,
                  double& distance);

// Returns the pdf of the first point of the surface that a ray meets. direction: unit.
double pdfAlong(const Record& record, uint8_t sides, const Vec3f& eye, const Vec3d& direction);

} // namespace openrt
