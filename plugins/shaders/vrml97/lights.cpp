// lights.cpp: the lights of ISO/IEC 14772-1 clauses 6.16 (DirectionalLight), 6.35 (PointLight) and
// 6.45 (SpotLight). Distances, angles and the radius are measured in the light's local space, as
// the standard requires. [render]
#include <cmath>

#include "vrml97/batch.h"
#include "vrml97/classes.h"

namespace vrml97 {
namespace {

constexpr float pi = 3.14159265358979f;

// The parameters of all three lights. They come first in each struct, so that lightTraits() works
// for every light.
struct LightParams {
  float ambientIntensity;
  float color[3];
  float intensity;
  int32_t shadows;
  int32_t irradiance;
};
struct DirectionalParams {
  LightParams light;
  float direction[3];
};
struct PointParams {
  LightParams light;
  float attenuation[3];
  float location[3];
  float radius;
};
struct SpotParams {
  PointParams point;
  float beamWidth;
  float cutOffAngle;
  float direction[3];
};

#define VRML97_LIGHT_PARAMS                                                                        \
  {"ambientIntensity",                                                                             \
   RTS_FLOAT,                                                                                      \
   offsetof(LightParams, ambientIntensity),                                                        \
   {0.0f},                                                                                         \
   0.0f,                                                                                           \
   noLimit,                                                                                        \
   "strength of the ambient part"},                                                                \
      {"color", RTS_COLOR, offsetof(LightParams, color), {1.0f, 1.0f, 1.0f},                       \
       0.0f,    0.0f,      "colour of the light"},                                                 \
      {"intensity", RTS_FLOAT, offsetof(LightParams, intensity), {1.0f},                           \
       0.0f,        noLimit,   "strength of the direct part"},                                     \
      {"shadows",                                                                                  \
       RTS_INT,                                                                                    \
       offsetof(LightParams, shadows),                                                             \
       {1.0f},                                                                                     \
       0.0f,                                                                                       \
       1.0f,                                                                                       \
       "1: casts shadows, 0: shines through everything"},                                          \
  {                                                                                                \
    "irradiance", RTS_INT, offsetof(LightParams, irradiance), {1.0f}, 0.0f, 1.0f,                  \
        "1: color x intensity is the irradiance of surfaces whose irradiance is 1"                 \
  }
#define VRML97_POINT_PARAMS                                                                        \
  {"attenuation",                                                                                  \
   RTS_VEC3,                                                                                       \
   offsetof(PointParams, attenuation),                                                             \
   {1.0f, 0.0f, 0.0f},                                                                             \
   0.0f,                                                                                           \
   noLimit,                                                                                        \
   "coefficients a b c of 1 / max(a + b d + c d^2, 1) at distance d"},                             \
      {"location",          RTS_VEC3, offsetof(PointParams, location),                             \
       {0.0f, 0.0f, 0.0f},  0.0f,     0.0f,                                                        \
       "place of the light"},                                                                      \
  {                                                                                                \
    "radius", RTS_FLOAT, offsetof(PointParams, radius), {100.0f}, 0.0f, noLimit,                   \
        "distance beyond which nothing is lit"                                                     \
  }

const RtsParam directionalParams[] = {VRML97_LIGHT_PARAMS,
                                      {"direction",
                                       RTS_VEC3,
                                       offsetof(DirectionalParams, direction),
                                       {0.0f, 0.0f, -1.0f},
                                       0.0f,
                                       0.0f,
                                       "direction in which the light travels"}};
const RtsParam pointParams[] = {VRML97_LIGHT_PARAMS, VRML97_POINT_PARAMS};
const RtsParam spotParams[] = {
    VRML97_LIGHT_PARAMS,
    VRML97_POINT_PARAMS,
    {"beamWidth",
     RTS_FLOAT,
     offsetof(SpotParams, beamWidth),
     {1.570796f},
     0.0f,
     3.1415927f,
     "angle from the axis up to which the light is full, radians"},
    {"cutOffAngle",
     RTS_FLOAT,
     offsetof(SpotParams, cutOffAngle),
     {0.785398f},
     0.0f,
     3.1415927f,
     "angle from the axis at which the light ends, radians"},
    {"direction",
     RTS_VEC3,
     offsetof(SpotParams, direction),
     {0.0f, 0.0f, -1.0f},
     0.0f,
     0.0f,
     "axis of the cone"},
};

uint32_t lightTraits(const RtsHost*, const void* params) {
  const auto& light = *static_cast<const LightParams*>(params);
  return (light.shadows ? 0u : uint32_t(RTS_NO_SHADOW)) |
         (light.irradiance ? uint32_t(RTS_IRRADIANCE) : 0u);
}

struct Outgoing { // colour of the direct and the ambient part before attenuation
  float direct[3], ambient[3];
};

Outgoing outgoing(const LightParams& light) {
  Outgoing o;
  for (int c = 0; c < 3; c++) {
    o.direct[c] = light.color[c] * light.intensity;
    o.ambient[c] = light.color[c] * light.ambientIntensity;
  }
  return o;
}

VRML97_CLONES void fill(float value, uint32_t n, float* __restrict out) {
  for (uint32_t i = 0; i < n; i++) out[i] = value;
}

void illuminateDirectional(const RtsHost*, RtsBatch*, const void* params, uint32_t n,
                           const float* const[3], RtsIllumination* out) {
  const auto& p = *static_cast<const DirectionalParams*>(params);
  const Outgoing o = outgoing(p.light);
  for (int c = 0; c < 3; c++) {
    fill(-p.direction[c], wholeLanes(n), out->toLight[c]);
    fill(o.direct[c], wholeLanes(n), out->color[c]);
    fill(o.ambient[c], wholeLanes(n), out->ambient[c]);
  }
  out->directional = 1;
}

// Writes the vectors to the light, and the attenuation to `factor`: 0 beyond the radius.
VRML97_CLONES void attenuation(const PointParams p, uint32_t n, const ConstVectorArrays point,
                               const VectorArrays toLight, float* __restrict factor) {
  for (uint32_t i = 0; i < n; i++) {
    const float x = p.location[0] - point.x[i], y = p.location[1] - point.y[i],
                z = p.location[2] - point.z[i];
    const float d = squareRoot(x * x + y * y + z * z);
    const float f =
        1.0f / larger(p.attenuation[0] + d * (p.attenuation[1] + d * p.attenuation[2]), 1.0f);
    toLight.x[i] = x;
    toLight.y[i] = y;
    toLight.z[i] = z;
    factor[i] = d <= p.radius ? f : 0.0f;
  }
}

VRML97_CLONES void scaled(float value, uint32_t n, const float* __restrict factor,
                          float* __restrict out) {
  for (uint32_t i = 0; i < n; i++) out[i] = value * factor[i];
}

void colour(const LightParams& light, uint32_t n, const float* factor, RtsIllumination* out) {
  const Outgoing o = outgoing(light);
  for (int c = 0; c < 3; c++) {
    scaled(o.direct[c], n, factor, out->color[c]);
    scaled(o.ambient[c], n, factor, out->ambient[c]);
  }
  out->directional = 0;
}

void illuminatePoint(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                     const float* const local[3], RtsIllumination* out) {
  const auto& p = *static_cast<const PointParams*>(params);
  float* factor = host->scratch(batch, wholeLanes(n));
  attenuation(p, wholeLanes(n), constArraysOf(local), arraysOf(out->toLight), factor);
  colour(p.light, wholeLanes(n), factor, out);
}

struct Cone {
  float axis[3]; // unit; 0 if the direction is 0
  float cosCut;
  float cut, slope; // factor between the angles: (cut - angle) * slope
};

Cone coneOf(const SpotParams& p) {
  Cone cone{};
  const float* d = p.direction;
  const double length = std::sqrt(double(d[0]) * d[0] + double(d[1]) * d[1] + double(d[2]) * d[2]);
  for (int c = 0; c < 3 && length > 0; c++) cone.axis[c] = static_cast<float>(d[c] / length);
  cone.cut = p.cutOffAngle;
  // A beam wider than the cut-off angle gives a uniform cone (clause 6.45).
  const float beam = smaller(p.beamWidth, p.cutOffAngle);
  cone.slope = beam < cone.cut ? 1.0f / (cone.cut - beam) : 0.0f;
  cone.cosCut = static_cast<float>(std::cos(double(cone.cut)));
  return cone;
}

// Applies a uniform cone, which needs only the cosine.
VRML97_CLONES void hardCone(const Cone cone, uint32_t n, const ConstVectorArrays toLight,
                            float* __restrict factor) {
  for (uint32_t i = 0; i < n; i++) {
    const float x = toLight.x[i], y = toLight.y[i], z = toLight.z[i];
    const float along = -(x * cone.axis[0] + y * cone.axis[1] + z * cone.axis[2]);
    const float length = squareRoot(x * x + y * y + z * z);
    factor[i] = along > cone.cosCut * length ? factor[i] : 0.0f;
  }
}

// Applies a cone with a soft edge. The angle is computed from the dot and the cross product,
// because the cosine alone loses half of the digits near the axis.
VRML97_CLONES void softCone(const Cone cone, uint32_t n, const ConstVectorArrays toLight,
                            float* __restrict factor) {
  for (uint32_t i = 0; i < n; i++) {
    const float x = toLight.x[i], y = toLight.y[i], z = toLight.z[i];
    const float along = -(x * cone.axis[0] + y * cone.axis[1] + z * cone.axis[2]);
    const float cx = y * cone.axis[2] - z * cone.axis[1];
    const float cy = z * cone.axis[0] - x * cone.axis[2];
    const float cz = x * cone.axis[1] - y * cone.axis[0];
    const float angle = angleOf(along, squareRoot(cx * cx + cy * cy + cz * cz));
    const float f = (cone.cut - angle) * cone.slope;
    factor[i] = factor[i] * smaller(larger(f, 0.0f), 1.0f);
  }
}

void illuminateSpot(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                    const float* const local[3], RtsIllumination* out) {
  const auto& p = *static_cast<const SpotParams*>(params);
  float* factor = host->scratch(batch, wholeLanes(n));
  attenuation(p.point, wholeLanes(n), constArraysOf(local), arraysOf(out->toLight), factor);
  const Cone cone = coneOf(p);
  (cone.slope > 0 ? softCone : hardCone)(cone, wholeLanes(n), constArraysOf(out->toLight), factor);
  colour(p.point.light, wholeLanes(n), factor, out);
}

float mean(const LightParams& light) {
  return light.intensity * (light.color[0] + light.color[1] + light.color[2]) / 3.0f;
}

void putVector(const float from[3], float to[3]) {
  for (int c = 0; c < 3; c++) to[c] = from[c];
}

// A light's colour is the radiance of a white Lambertian surface that faces it, so the irradiance
// is pi times the colour.
int directionalExtent(const RtsHost*, const void* params, RtsExtent* out) {
  const auto& p = *static_cast<const DirectionalParams*>(params);
  const float* d = p.direction;
  const double length = std::sqrt(double(d[0]) * d[0] + double(d[1]) * d[1] + double(d[2]) * d[2]);
  if (!(length > 0)) return 0;
  out->parallel = 1;
  for (int c = 0; c < 3; c++) out->direction[c] = static_cast<float>(d[c] / length);
  out->cosine = 1.0f;
  out->power = pi * mean(p.light);
  out->radius = INFINITY;
  return 1;
}

// Estimates the flux from the irradiance at distance 10 (or at the radius, if smaller), where the
// attenuation is effective. The estimate is exact for light that falls off with the square of the
// distance.
float flux(const PointParams& p, float solidAngle) {
  const float* a = p.attenuation;
  const double d = std::fmin(10.0, double(p.radius)),
               f = std::fmax(a[0] + d * (a[1] + d * a[2]), 1.0);
  return static_cast<float>(double(pi) * double(mean(p.light)) * d * d / f * double(solidAngle));
}

int pointExtent(const RtsHost*, const void* params, RtsExtent* out) {
  const auto& p = *static_cast<const PointParams*>(params);
  putVector(p.location, out->position);
  out->direction[2] = -1.0f;
  out->cosine = -1.0f;
  out->power = flux(p, 4.0f * pi);
  out->radius = p.radius;
  return 1;
}

int spotExtent(const RtsHost* host, const void* params, RtsExtent* out) {
  const auto& p = *static_cast<const SpotParams*>(params);
  pointExtent(host, params, out);
  const Cone cone = coneOf(p);
  putVector(cone.axis, out->direction);
  if (!(cone.axis[0] != 0.0f || cone.axis[1] != 0.0f || cone.axis[2] != 0.0f)) return 0;
  out->cosine = cone.cosCut;
  out->power = flux(p.point, 2.0f * pi * (1.0f - cone.cosCut));
  return 1;
}

template <class Params, uint32_t count>
constexpr RtsClass lightClass(const char* name, const char* text, const RtsParam (&params)[count],
                              decltype(RtsClass::illuminate) illuminate,
                              decltype(RtsClass::extent) extent) {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_LIGHT;
  c.name = name;
  c.text = text;
  c.paramSize = sizeof(Params);
  c.paramCount = count;
  c.params = params;
  c.traits = lightTraits;
  c.illuminate = illuminate;
  c.extent = extent;
  return c;
}

} // namespace

const RtsClass directionalLightClass = lightClass<DirectionalParams>(
    "VRML97DirectionalLight", "parallel light from infinitely far away", directionalParams,
    illuminateDirectional, directionalExtent);
const RtsClass pointLightClass =
    lightClass<PointParams>("VRML97PointLight", "light from one point into all directions",
                            pointParams, illuminatePoint, pointExtent);
const RtsClass spotLightClass = lightClass<SpotParams>(
    "VRML97SpotLight", "light from one point into a cone", spotParams, illuminateSpot, spotExtent);

} // namespace vrml97
