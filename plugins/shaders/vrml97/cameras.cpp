// cameras.cpp: the stock cameras. Local frame: looking down -z, +y up; pixel (0, 0) is the top left corner of the picture, so
// y runs down. Thread tag [render].
#include <cmath>

#include "vrml97/batch.h"
#include "vrml97/classes.h"

namespace vrml97 {
namespace {

struct PerspectiveParams {
  float fovy;
};
struct OrthographicParams {
  float height;
};

const RtsParam perspectiveParams[] = {
    {"fovy", RTS_FLOAT, offsetof(PerspectiveParams, fovy), {45.0f}, 0.0f, 180.0f, "vertical field of view, degrees"}};
const RtsParam orthographicParams[] = {{"height",
                                        RTS_FLOAT,
                                        offsetof(OrthographicParams, height),
                                        {2.0f},
                                        0.0f,
                                        noLimit,
                                        "height of the view, units of the camera's local space"}};

// Pixels to the plane z = -1 (perspective) or to the origins (orthographic): position = (pixel - middle) * step.
struct Raster {
  float middle[2];
  float step;
};

Raster rasterOf(const float size[2], double height) {
  return {{0.5f * size[0], 0.5f * size[1]}, static_cast<float>(height / static_cast<double>(size[1]))};
}

VRML97_CLONES void perspectiveRays(const Raster raster, uint32_t n, const float* __restrict px, const float* __restrict py,
                                   float* __restrict ox, float* __restrict oy, float* __restrict oz, float* __restrict dx,
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

VRML97_CLONES void orthographicRays(const Raster raster, uint32_t n, const float* __restrict px, const float* __restrict py,
                                    float* __restrict ox, float* __restrict oy, float* __restrict oz, float* __restrict dx,
                                    float* __restrict dy, float* __restrict dz) {
  for (uint32_t i = 0; i < n; i++) {
    ox[i] = (px[i] - raster.middle[0]) * raster.step;
    oy[i] = (raster.middle[1] - py[i]) * raster.step;
    oz[i] = dx[i] = dy[i] = 0.0f;
    dz[i] = -1.0f;
  }
}

void generatePerspective(const RtsHost*, RtsBatch*, const void* params, uint32_t n, const float* const xy[2], const float size[2],
                         RtsRays* out) {
  constexpr double halfDegree = 3.14159265358979323846 / 360.0;
  const double height = 2.0 * std::tan(static_cast<double>(static_cast<const PerspectiveParams*>(params)->fovy) * halfDegree);
  perspectiveRays(rasterOf(size, height), wholeLanes(n), xy[0], xy[1], out->origin[0], out->origin[1], out->origin[2],
                  out->direction[0], out->direction[1], out->direction[2]);
}

void generateOrthographic(const RtsHost*, RtsBatch*, const void* params, uint32_t n, const float* const xy[2],
                          const float size[2], RtsRays* out) {
  const double height = static_cast<const OrthographicParams*>(params)->height;
  orthographicRays(rasterOf(size, height), wholeLanes(n), xy[0], xy[1], out->origin[0], out->origin[1], out->origin[2],
                   out->direction[0], out->direction[1], out->direction[2]);
}

template <class Params, uint32_t count> constexpr RtsClass
cameraClass(const char* name, const char* text, const RtsParam (&params)[count], decltype(RtsClass::generate) generate) {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_CAMERA;
  c.name = name;
  c.text = text;
  c.paramSize = sizeof(Params);
  c.paramCount = count;
  c.params = params;
  c.generate = generate;
  return c;
}

} // namespace

const RtsClass perspectiveCameraClass =
    cameraClass<PerspectiveParams>("PerspectiveCamera", "all rays start in one point", perspectiveParams, generatePerspective);
const RtsClass orthographicCameraClass =
    cameraClass<OrthographicParams>("OrthographicCamera", "all rays are parallel", orthographicParams, generateOrthographic);

} // namespace vrml97
