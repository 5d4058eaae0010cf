// cube_lookup.cpp: places in a picture of the whole sphere. [render]
#include "vrml97/cube_lookup.h"

namespace vrml97 {
namespace {

VRML97_CLONES void places(uint32_t n, const float* __restrict x, const float* __restrict y,
                          const float* __restrict z, float* __restrict u, float* __restrict v) {
  constexpr float pi = 3.14159265358979f;
  for (uint32_t i = 0; i < n; i++) {
    const float turn = angleOf(-z[i], x[i] < 0.0f ? -x[i] : x[i]); // from -z
    u[i] = 0.5f + (x[i] < 0.0f ? -turn : turn) * (0.5f / pi);
    v[i] = 1.0f - angleOf(y[i], squareRoot(x[i] * x[i] + z[i] * z[i])) * (1.0f / pi);
  }
}

} // namespace

void mapPlaces(uint32_t n, const float* x, const float* y, const float* z, float* u, float* v) {
  places(n, x, y, z, u, v);
}

} // namespace vrml97
