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

// The arrays of n pixels; restrict as in VectorArrays.
struct PixelArrays {
  const float* __restrict x;
  const float* __restrict y;
};

VRML97_CLONES void perspectiveRays(const Raster raster, uint32_t n, const PixelArrays pixel,
                                   const VectorArrays origin, const VectorArrays direction) {
  for (uint32_t i = 0; i < n; i++) {
    const float x = (pixel.x[i] - raster.middle[0]) * raster.step;
    const float y = (raster.middle[1] - pixel.y[i]) * raster.step;
    const float scale = 1.0f / squareRoot(x * x + y * y + 1.0f);
    origin.x[i] = origin.y[i] = origin.z[i] = 0.0f;
    direction.x[i] = x * scale;
    direction.y[i] = y * scale;
    direction.z[i] = -scale;
  }
}

VRML97_CLONES void orthographicRays(const Raster raster, uint32_t n, const PixelArrays pixel,
                                    const VectorArrays origin, const VectorArrays direction) {
  for (uint32_t i = 0; i < n; i++) {
    origin.x[i] = (pixel.x[i] - raster.middle[0]) * raster.step;
    origin.y[i] = (raster.middle[1] - pixel.y[i]) * raster.step;
    origin.z[i] = direction.x[i] = direction.y[i] = 0.0f;
    direction.z[i] = -1.0f;
  }
}

void generatePerspective(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                         const float* const xy[2], const float size[2], RtsRays* out) {
  const double height = planeHeight(static_cast<const PerspectiveParams*>(params)->fovy);
  perspectiveRays(rasterOf(size, height), wholeLanes(n), {xy[0], xy[1]}, arraysOf(out->origin),
                  arraysOf(out->direction));
}

void generateOrthographic(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                          const float* const xy[2], const float size[2], RtsRays* out) {
  const double height = static_cast<const OrthographicParams*>(params)->height;
  orthographicRays(rasterOf(size, height), wholeLanes(n), {xy[0], xy[1]}, arraysOf(out->origin),
                   arraysOf(out->direction));
}

// Projects points to the picture. A surface of area A that faces the eye at distance r has the
// solid angle A / r^2. On the plane z = -1 a solid angle at the angle t from the axis covers an
// area larger by 1 / cos(t)^3.
class PerspectiveProjection {
 public:
  static constexpr int parallel = 0;
  using Params = PerspectiveParams;
  PerspectiveProjection(const Params& params, const float size[2])
      : pixels_(static_cast<double>(size[1]) / planeHeight(params.fovy)) {}
  Projected project(const float local[3], const float*) const {
    const double x = local[0], y = local[1], depth = -static_cast<double>(local[2]);
    const double scale = depth != 0 ? pixels_ / depth : 0;
    const double weight = scale * scale * std::sqrt(x * x + y * y + depth * depth) / depth;
    return {x * scale, y * scale, depth > 0 ? weight : 0, {-local[0], -local[1], -local[2]}};
  }

 private:
  double pixels_; // pixels per unit of the plane
};

class OrthographicProjection {
 public:
  static constexpr int parallel = 0; // rays start in the plane of the camera, not at infinity
  using Params = OrthographicParams;
  OrthographicProjection(const Params& params, const float size[2])
      : pixels_(static_cast<double>(size[1]) / static_cast<double>(params.height)) {}
  Projected project(const float local[3], const float*) const {
    const double x = local[0], y = local[1];
    return {x * pixels_,
            y * pixels_,
            local[2] < 0 && local[2] >= -noLimit ? pixels_ * pixels_ : 0,
            {0.0f, 0.0f, -local[2]}};
  }

 private:
  double pixels_; // pixels per unit of local space
};

} // namespace

const RtsClass perspectiveCameraClass = cameraClass<PerspectiveProjection>(
    "PerspectiveCamera", "all rays start in one point", perspectiveParams, generatePerspective);
const RtsClass orthographicCameraClass = cameraClass<OrthographicProjection>(
    "OrthographicCamera", "all rays are parallel", orthographicParams, generateOrthographic);

} // namespace vrml97
