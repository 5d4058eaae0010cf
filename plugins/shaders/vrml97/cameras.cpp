// cameras.cpp: the perspective and the orthographic camera. In local space they look along -z with
// +y up. Pixel (0, 0) is the top left corner of the picture, so pixel y points down. [render]
#include <cmath>

#include "vrml97/batch.h"
#include "vrml97/classes.h"
#include "vrml97/film.h"

namespace vrml97 {
namespace {

struct PerspectiveParams {
  float fovy;
};
struct OrthographicParams {
  float height;
};

const RtsParam perspectiveParams[] = {{"fovy",
                                       RTS_FLOAT,
                                       offsetof(PerspectiveParams, fovy),
                                       {45.0f},
                                       0.0f,
                                       180.0f,
                                       "vertical field of view, degrees"}};
const RtsParam orthographicParams[] = {{"height",
                                        RTS_FLOAT,
                                        offsetof(OrthographicParams, height),
                                        {2.0f},
                                        0.0f,
                                        noLimit,
                                        "height of the view, units of the camera's local space"}};

// Maps pixels to the plane z = -1 (perspective) or to ray origins (orthographic): position = (pixel
// - middle) * step.
struct Raster {
  float middle[2];
  float step;
};

Raster rasterOf(const float size[2], double height) {
  return {{0.5f * size[0], 0.5f * size[1]},
          static_cast<float>(height / static_cast<double>(size[1]))};
}

VRML97_CLONES void perspectiveRays(const Raster raster, uint32_t n, const float* __restrict px,
                                   const float* __restrict py, float* __restrict ox,
                                   float* __restrict oy, float* __restrict oz, float* __restrict dx,
                                   float* __restrict dy, float* __restrict dz) {
  for (uint32_t i = 0; i < n; i++) {
    const float x = (px[i] - raster.middle[0]) * raster.step;
    const float y = (raster.middle[1] - py[i]) * raster.step;
    const float scale = 1.0f / squareRoot(x * x + y * y + 1.0f);
    ox[i] = oy[i] = oz[i] = 0.0f;
    dx[i] = x * scale;
    dy[i] = y * scale;
    dz[i] = -scale;
  }
}

VRML97_CLONES void orthographicRays(const Raster raster, uint32_t n, const float* __restrict px,
                                    const float* __restrict py, float* __restrict ox,
                                    float* __restrict oy, float* __restrict oz,
                                    float* __restrict dx, float* __restrict dy,
                                    float* __restrict dz) {
  for (uint32_t i = 0; i < n; i++) {
    ox[i] = (px[i] - raster.middle[0]) * raster.step;
    oy[i] = (raster.middle[1] - py[i]) * raster.step;
    oz[i] = dx[i] = dy[i] = 0.0f;
    dz[i] = -1.0f;
  }
}

void generatePerspective(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                         const float* const xy[2], const float size[2], RtsRays* out) {
  constexpr double halfDegree = 3.14159265358979323846 / 360.0;
  const double height =
      2.0 * std::tan(static_cast<double>(static_cast<const PerspectiveParams*>(params)->fovy) *
                     halfDegree);
  perspectiveRays(rasterOf(size, height), wholeLanes(n), xy[0], xy[1], out->origin[0],
                  out->origin[1], out->origin[2], out->direction[0], out->direction[1],
                  out->direction[2]);
}

void generateOrthographic(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                          const float* const xy[2], const float size[2], RtsRays* out) {
  const double height = static_cast<const OrthographicParams*>(params)->height;
  orthographicRays(rasterOf(size, height), wholeLanes(n), xy[0], xy[1], out->origin[0],
                   out->origin[1], out->origin[2], out->direction[0], out->direction[1],
                   out->direction[2]);
}

// Projects points to the picture. A surface of area A that faces the eye at distance r has the
// solid angle A / r^2. On the plane z = -1 a solid angle at the angle t from the axis covers an
// area larger by 1 / cos(t)^3.
void projectPerspective(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                        const float* const local[3], const float* const*, const float size[2],
                        RtsProjection* out) {
  constexpr double halfDegree = 3.14159265358979323846 / 360.0;
  const double height =
      2.0 * std::tan(static_cast<double>(static_cast<const PerspectiveParams*>(params)->fovy) *
                     halfDegree);
  const double pixels = static_cast<double>(size[1]) / height; // pixels per unit of the plane
  for (uint32_t i = 0; i < n; i++) {
    const double x = local[0][i], y = local[1][i], depth = -static_cast<double>(local[2][i]);
    const double scale = depth > 0 ? pixels / depth : 0;
    const double weight = scale * scale * std::sqrt(x * x + y * y + depth * depth) / depth;
    writeProjection(out, i, size, 0.5 * static_cast<double>(size[0]) + x * scale,
                    0.5 * static_cast<double>(size[1]) - y * scale, depth > 0 ? weight : 0);
    out->toEye[0][i] = -local[0][i];
    out->toEye[1][i] = -local[1][i];
    out->toEye[2][i] = -local[2][i];
  }
  out->parallel = 0;
}

void projectOrthographic(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                         const float* const local[3], const float* const*, const float size[2],
                         RtsProjection* out) {
  const double pixels = static_cast<double>(size[1]) /
                        static_cast<double>(static_cast<const OrthographicParams*>(params)->height);
  for (uint32_t i = 0; i < n; i++) {
    const double x = local[0][i], y = local[1][i];
    writeProjection(out, i, size, 0.5 * static_cast<double>(size[0]) + x * pixels,
                    0.5 * static_cast<double>(size[1]) - y * pixels,
                    local[2][i] < 0 && local[2][i] >= -noLimit ? pixels * pixels : 0);
    out->toEye[0][i] = out->toEye[1][i] = 0.0f;
    out->toEye[2][i] = 1.0f;
  }
  out->parallel = 1;
}

} // namespace

const RtsClass perspectiveCameraClass =
    cameraClass<PerspectiveParams>("PerspectiveCamera", "all rays start in one point",
                                   perspectiveParams, generatePerspective, projectPerspective);
const RtsClass orthographicCameraClass =
    cameraClass<OrthographicParams>("OrthographicCamera", "all rays are parallel",
                                    orthographicParams, generateOrthographic, projectOrthographic);

} // namespace vrml97
