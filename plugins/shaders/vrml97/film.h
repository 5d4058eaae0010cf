// film.h: functions shared by the cameras. [render]
#pragma once

#include <cmath>

#include "openrt/openrts.h"

namespace vrml97 {

// Returns the height of the view on the plane z = -1. fovy: vertical field of view, degrees.
inline double planeHeight(float fovy) {
  return 2.0 * std::tan(static_cast<double>(fovy) * (3.14159265358979323846 / 360.0));
}

// Places farther from the picture than this, in pixels, are not told.
inline constexpr float farthest = 1e6f;

// A point as a camera projects it to the picture.
struct Projected {
  double right, up; // pixels from the middle of the picture, also outside of it
  double weight;    // pixels per unit of area, as in RtsProjection; 0: the point is not seen
  float toEye[3];
};

// Writes the projection of point i. Its weight is 0 if the point is outside the picture or not a
// number; its place is then beside the picture, or the corner if it has none.
inline void writeProjection(RtsProjection* out, uint32_t i, const float size[2],
                            const Projected& at) {
  const float px = static_cast<float>(0.5 * static_cast<double>(size[0]) + at.right),
              py = static_cast<float>(0.5 * static_cast<double>(size[1]) - at.up),
              w = static_cast<float>(at.weight);
  const bool placed = px > -farthest && px < farthest && py > -farthest && py < farthest;
  const bool seen =
      px >= 0 && px < size[0] && py >= 0 && py < size[1] && w > 0 && w <= 3.402823e38f;
  out->xy[0][i] = placed ? px : 0.0f;
  out->xy[1][i] = placed ? py : 0.0f;
  out->weight[i] = seen ? w : 0.0f;
  for (int k = 0; k < 3; k++) out->toEye[k][i] = at.toEye[k];
}

// Implements RtsClass::project point by point. A Projection is made from the camera's parameters
// and the size of the picture. Its project() gets a point in local space and a point of the unit
// square that selects one of the lens.
template <class Projection> void projectEach(const RtsHost*, RtsBatch*, const void* params,
                                             uint32_t n, const float* const local[3],
                                             const float* const lens[2], const float size[2],
                                             RtsProjection* out) {
  const Projection projection(*static_cast<const typename Projection::Params*>(params), size);
  for (uint32_t i = 0; i < n; i++) {
    const float point[3] = {local[0][i], local[1][i], local[2][i]};
    const float onLens[2] = {lens[0][i], lens[1][i]};
    writeProjection(out, i, size, projection.project(point, onLens));
  }
  out->parallel = Projection::parallel;
}

template <class Projection, uint32_t count>
constexpr RtsClass cameraClass(const char* name, const char* text, const RtsParam (&params)[count],
                               decltype(RtsClass::generate) generate) {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_CAMERA;
  c.name = name;
  c.text = text;
  c.paramSize = sizeof(typename Projection::Params);
  c.paramCount = count;
  c.params = params;
  c.generate = generate;
  c.project = projectEach<Projection>;
  return c;
}

} // namespace vrml97
