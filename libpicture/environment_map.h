// environment_map.h: Makes OpenRT's shader EnvironmentMap from a picture. The caller owns the
// shader and its texture. [main thread of a context]
#pragma once

#include "openrt/openrt.h"

namespace picture {

// Returns the shader of a picture in latitude and longitude, and its texture. rgb: width * height *
// 3 floats. The shader stays bound, so that its other parameters can be set.
RTid makeEnvironmentMap(int width, int height, const float* rgb, RTid& texture);

} // namespace picture
