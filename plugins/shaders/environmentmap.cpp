// environmentmap.cpp: the environment EnvironmentMap, an equirectangular environment map: columns
// of equal longitude, rows of equal latitude. In local space +y is up; the middle of the picture is
// towards -z, its right half towards +x. [render]
#include <cstddef>

#include "openrt/openrts.h"
#include "vrml97/batch.h"

namespace {

using vrml97::angleOf;
using vrml97::squareRoot;
using vrml97::wholeLanes;

struct Params {
  RtsTexture texture;
  float color[3];
  float intensity;
  float rotation;
};

const RtsParam params[] = {
    {"texture",
     RTS_TEXTURE,
     offsetof(Params, texture),
     {},
     0.0f,
     0.0f,
     "radiance all around, top row at +y; wrapping: repeat, clamp"},
    {"color",
     RTS_COLOR,
     offsetof(Params, color),
     {1.0f, 1.0f, 1.0f},
     0.0f,
     0.0f,
     "multiplies the picture"},
    {"intensity",
     RTS_FLOAT,
     offsetof(Params, intensity),
     {1.0f},
     0.0f,
     1e9f,
     "multiplies the picture"},
    {"rotation",
     RTS_FLOAT,
     offsetof(Params, rotation),
     {0.0f},
     0.0f,
     0.0f,
     "rotation of the picture about +y, counter-clockwise seen from above, radians"},
};

VRML97_CLONES void places(float rotation, uint32_t n, const float* __restrict x,
                          const float* __restrict y, const float* __restrict z, float* __restrict u,
                          float* __restrict v) {
  constexpr float pi = 3.14159265358979f;
  for (uint32_t i = 0; i < n; i++) {
    const float across = x[i] < 0.0f ? -x[i] : x[i];
    const float turn = angleOf(-z[i], across); // from -z
    const float side = x[i] < 0.0f ? -turn : turn;
    u[i] = 0.5f + (side + rotation) * (0.5f / pi);
    v[i] = 1.0f - angleOf(y[i], squareRoot(x[i] * x[i] + z[i] * z[i])) * (1.0f / pi);
  }
}

VRML97_CLONES void scale(float factor, uint32_t n, float* __restrict c) {
  for (uint32_t i = 0; i < n; i++) c[i] = c[i] * factor;
}

void miss(const RtsHost* host, RtsBatch* batch, const void* values, uint32_t n,
          const float* const d[3], float* const rgba[4]) {
  if (n == 0) return;
  const auto& p = *static_cast<const Params*>(values);
  const uint32_t lanes = wholeLanes(n);
  float *u = host->scratch(batch, lanes), *v = host->scratch(batch, lanes);
  places(p.rotation, lanes, d[0], d[1], d[2], u, v);
  const float* const uv[2] = {u, v};
  host->sample(batch, p.texture, n, uv, rgba);
  for (int c = 0; c < 3; c++) scale(p.color[c] * p.intensity, lanes, rgba[c]);
  for (uint32_t i = 0; i < n; i++) rgba[3][i] = 1.0f;
}

constexpr RtsClass makeClass() {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_ENVIRONMENT;
  c.name = "EnvironmentMap";
  c.text = "light from all around, from one picture";
  c.paramSize = sizeof(Params);
  c.paramCount = sizeof(params) / sizeof(params[0]);
  c.params = params;
  c.miss = miss;
  return c;
}

const RtsClass environmentMap = makeClass();
const RtsClass* const classes[] = {&environmentMap};

} // namespace

extern "C" {
extern RTS_EXPORT const RtsPlugin rtsPlugin;
const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                             1,         classes};
}
