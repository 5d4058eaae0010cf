// lenses.cpp: stock cameras beyond the standard: a thin lens with depth of field, and a panorama.
// As the others, they look along -z with +y up; pixel (0, 0) is the top left corner. [render]
#include <cmath>

#include "vrml97/classes.h"
#include "vrml97/film.h"

namespace vrml97 {
namespace {

constexpr double pi = 3.14159265358979323846;

// Thin lens ---------------------------------------------------------------------------------------

struct ThinLensParams {
  float fovy, radius, focus;
  int32_t blades;
};

const RtsParam thinLensParams[] = {
    {"fovy",
     RTS_FLOAT,
     offsetof(ThinLensParams, fovy),
     {45.0f},
     0.0f,
     180.0f,
     "vertical field of view, degrees"},
    {"radius",
     RTS_FLOAT,
     offsetof(ThinLensParams, radius),
     {0.0f},
     0.0f,
     noLimit,
     "radius of the lens; 0: everything is in focus"},
    {"focus",
     RTS_FLOAT,
     offsetof(ThinLensParams, focus),
     {10.0f},
     1e-6f,
     noLimit,
     "distance of the plane that is in focus"},
    {"blades",
     RTS_INT,
     offsetof(ThinLensParams, blades),
     {0.0f},
     0.0f,
     64.0f,
     "number of corners of the opening, a regular polygon within the lens; below 3: round"}};

struct DiskPoint {
  double x, y;
};

// Maps a point of the unit square to the unit disk, preserving ratios of areas and the centre (P.
// Shirley, K. Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997). With 3 or more
// blades the disk is then mapped, sector by sector, to the regular polygon in it.
DiskPoint samplePointOnLens(float u, float v, int32_t blades) {
  const double a = 2.0 * static_cast<double>(u) - 1.0, b = 2.0 * static_cast<double>(v) - 1.0;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = a * a > b * b;
  const double radius = wide ? a : b;
  const double angle = wide ? pi / 4 * (b / a) : pi / 2 - pi / 4 * (a / b);
  if (blades < 3) return {radius * std::cos(angle), radius * std::sin(angle)};
  const double turn = (radius < 0 ? angle + pi : angle) / (2 * pi), r = std::fabs(radius);
  const double sectors = (turn - std::floor(turn)) * blades, sector = std::floor(sectors),
               part = sectors - sector;
  const double first = 2 * pi * sector / blades, second = 2 * pi * (sector + 1) / blades;
  return {r * ((1 - part) * std::cos(first) + part * std::cos(second)),
          r * ((1 - part) * std::sin(first) + part * std::sin(second))};
}

// Rays start at a sampled point of the lens and pass through the point where the pinhole camera's
// ray hits the focal plane.
void generateThinLens(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                      const float* const xy[2], const float size[2], RtsRays* out) {
  const auto& p = *static_cast<const ThinLensParams*>(params);
  const double step = planeHeight(p.fovy) / static_cast<double>(size[1]), focus = p.focus;
  const bool open = p.radius > 0;
  float* square[2] = {};
  if (open) {
    for (float*& s : square) s = host->scratch(batch, n);
    host->random(batch, 0, square);
  }
  for (uint32_t i = 0; i < n; i++) {
    const DiskPoint unit =
        open ? samplePointOnLens(square[0][i], square[1][i], p.blades) : DiskPoint{0, 0};
    const double lx = unit.x * static_cast<double>(p.radius),
                 ly = unit.y * static_cast<double>(p.radius);
    const double x =
        (static_cast<double>(xy[0][i]) - 0.5 * static_cast<double>(size[0])) * step * focus - lx;
    const double y =
        (0.5 * static_cast<double>(size[1]) - static_cast<double>(xy[1][i])) * step * focus - ly;
    const double scale = 1.0 / std::sqrt(x * x + y * y + focus * focus);
    out->origin[0][i] = static_cast<float>(lx);
    out->origin[1][i] = static_cast<float>(ly);
    out->origin[2][i] = 0.0f;
    out->direction[0][i] = static_cast<float>(x * scale);
    out->direction[1][i] = static_cast<float>(y * scale);
    out->direction[2][i] = static_cast<float>(-focus * scale);
  }
}

// Projects a point along the line from the point of the lens: the pixel is where the line hits the
// focal plane. The weight is that of the perspective camera.
class ThinLensProjection {
 public:
  static constexpr int parallel = 0;
  using Params = ThinLensParams;
  ThinLensProjection(const Params& params, const float size[2])
      : params_(params), pixels_(static_cast<double>(size[1]) / planeHeight(params.fovy)) {}
  Projected project(const float local[3], const float lens[2]) const {
    const DiskPoint unit =
        params_.radius > 0 ? samplePointOnLens(lens[0], lens[1], params_.blades) : DiskPoint{0, 0};
    const double lx = unit.x * static_cast<double>(params_.radius),
                 ly = unit.y * static_cast<double>(params_.radius), focus = params_.focus;
    const double x = static_cast<double>(local[0]) - lx, y = static_cast<double>(local[1]) - ly;
    const double depth = -static_cast<double>(local[2]);
    const double away = std::sqrt(x * x + y * y + depth * depth);
    return {(lx / focus + x / depth) * pixels_,
            (ly / focus + y / depth) * pixels_,
            depth > 0 ? pixels_ * pixels_ / (depth * depth) * away / depth : 0,
            {static_cast<float>(-x), static_cast<float>(-y), static_cast<float>(depth)}};
  }

 private:
  const ThinLensParams& params_;
  double pixels_; // pixels per unit of the plane z = -1
};

// Panorama ----------------------------------------------------------------------------------------

struct PanoramaParams {
  float horizontal, vertical;
};

const RtsParam panoramaParams[] = {{"horizontal",
                                    RTS_FLOAT,
                                    offsetof(PanoramaParams, horizontal),
                                    {360.0f},
                                    1e-3f,
                                    360.0f,
                                    "angle from the left to the right edge, degrees"},
                                   {"vertical",
                                    RTS_FLOAT,
                                    offsetof(PanoramaParams, vertical),
                                    {180.0f},
                                    1e-3f,
                                    180.0f,
                                    "angle from the lower to the upper edge, degrees"}};

// Equirectangular: longitude and latitude are linear in the pixel; the middle looks along -z.
void generatePanorama(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                      const float* const xy[2], const float size[2], RtsRays* out) {
  const auto& p = *static_cast<const PanoramaParams*>(params);
  const double across =
      static_cast<double>(p.horizontal) * (pi / 180) / static_cast<double>(size[0]);
  const double up = static_cast<double>(p.vertical) * (pi / 180) / static_cast<double>(size[1]);
  for (uint32_t i = 0; i < n; i++) {
    const double longitude =
        (static_cast<double>(xy[0][i]) - 0.5 * static_cast<double>(size[0])) * across;
    const double latitude =
        (0.5 * static_cast<double>(size[1]) - static_cast<double>(xy[1][i])) * up;
    out->origin[0][i] = out->origin[1][i] = out->origin[2][i] = 0.0f;
    out->direction[0][i] = static_cast<float>(std::cos(latitude) * std::sin(longitude));
    out->direction[1][i] = static_cast<float>(std::sin(latitude));
    out->direction[2][i] = static_cast<float>(-std::cos(latitude) * std::cos(longitude));
  }
}

// Projects to longitude and latitude. Every row has the same number of pixels, but its circle of
// latitude shrinks with the cosine.
class PanoramaProjection {
 public:
  static constexpr int parallel = 0;
  using Params = PanoramaParams;
  PanoramaProjection(const Params& params, const float size[2])
      : across_(static_cast<double>(size[0]) /
                (static_cast<double>(params.horizontal) * (pi / 180))),
        up_(static_cast<double>(size[1]) / (static_cast<double>(params.vertical) * (pi / 180))) {}
  Projected project(const float local[3], const float*) const {
    const double x = local[0], y = local[1], z = local[2];
    const double level = std::sqrt(x * x + z * z), away2 = level * level + y * y;
    return {std::atan2(x, -z) * across_,
            std::atan2(y, level) * up_,
            across_ * up_ / (std::sqrt(away2) * level),
            {-local[0], -local[1], -local[2]}};
  }

 private:
  double across_, up_; // pixels per radian
};

} // namespace

const RtsClass thinLensClass = cameraClass<ThinLensProjection>(
    "ThinLens", "a lens: everything outside the plane of focus is blurred", thinLensParams,
    generateThinLens);
const RtsClass panoramaClass = cameraClass<PanoramaProjection>(
    "Panorama", "everything around, longitude and latitude", panoramaParams, generatePanorama);

} // namespace vrml97
