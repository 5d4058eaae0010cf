// film.h: functions shared by the cameras. [render]
#pragma once

#include "openrt/openrts.h"

namespace vrml97 {

// Writes the projection of point i: pixel coordinates x, y and the weight. The weight is 0 if the
// point is outside the picture or not a number.
inline void writeProjection(RtsProjection* out, uint32_t i, const float size[2], double x, double y,
                            double weight) {
  const float px = static_cast<float>(x), py = static_cast<float>(y),
              w = static_cast<float>(weight);
  const bool seen =
      px >= 0 && px < size[0] && py >= 0 && py < size[1] && w > 0 && w <= 3.402823e38f;
  out->xy[0][i] = seen ? px : 0.0f;
  out->xy[1][i] = seen ? py : 0.0f;
  out->weight[i] = seen ? w : 0.0f;
}

template <class Params, uint32_t count>
constexpr RtsClass cameraClass(const char* name, const char* text, const RtsParam (&params)[count],
                               decltype(RtsClass::generate) generate,
                               decltype(RtsClass::project) project) {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_CAMERA;
  c.name = name;
  c.text = text;
  c.paramSize = sizeof(Params);
  c.paramCount = count;
  c.params = params;
  c.generate = generate;
  c.project = project;
  return c;
}

} // namespace vrml97
