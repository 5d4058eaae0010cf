#include "render/lights/emissive_surfaces.h"

#include <cmath>

#include "scene/analytic.h"

namespace openrt {
namespace {

// local: a point of the surface in its own frame.
SurfacePlace placeOf(const Record& r, const Vec3d& local) {
  Vec3d gradient;
  r.surface->valueAt(local, gradient);
  const double steep = length(gradient);
  SurfacePlace place{r.frames->toRender.point(local), {0, 0, 1}, 0};
  if (!(steep > 0)) return place; // the apex of a cone
  // An element of area with the unit normal n grows by |det M| |M^-T n|.
  const Vec3d normal = r.frames->fromRender.transposed(gradient / steep);
  const double stretched = length(normal);
  place.normal = normal / stretched;
  place.area = r.surface->areaAt(local) * std::fabs(determinantOf(r.frames->toRender)) * stretched;
  return place;
}

} // namespace

SurfacePlace sampledPlace(const Record& r, double u, double v) {
  return placeOf(r, r.surface->pointAt(u, v));
}

double pdfOfPlace(const SurfacePlace& place, uint8_t sides, const Vec3f& eye, Vec3d& direction,
                  double& distance) {
  const Vec3d to = place.position - Vec3d(eye);
  distance = length(to);
  if (!(distance > 0) || !(place.area > 0)) return 0;
  direction = to / distance;
  const double along = dot(place.normal, direction);
  if (!(sides & (along < 0 ? 1 : 2)) || along == 0) return 0;
  return distance * distance / (std::fabs(along) * place.area);
}

double pdfAlong(const Record& r, uint8_t sides, const Vec3f& eye, const Vec3d& direction) {
  const Vec3d origin = r.frames->fromRender.point(Vec3d(eye)),
              along = r.frames->fromRender.direction(direction);
  const AnalyticSurface::Crossings crossings = r.surface->intersect(origin, along);
  for (int i = 0; i < crossings.count; i++) {
    const double t = crossings.t[size_t(i)];
    if (!(t > 0)) continue;
    const Vec3d local = origin + t * along;
    Vec3d gradient, towards;
    r.surface->valueAt(local, gradient);
    const bool front = dot(gradient, along) < 0;
    if (r.cull && front == r.flip) continue; // rays pass the back of a solid surface
    double distance;
    return pdfOfPlace(placeOf(r, local), sides, eye, towards, distance);
  }
  return 0;
}

} // namespace openrt
