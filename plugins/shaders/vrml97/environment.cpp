// environment.cpp: Background (ISO/IEC 14772-1 clause 6.5), Fog (clause 6.19), and the light of an
// EnvironmentLight (ISO/IEC 19775-1:2023 17.4.2) that shines from behind a Background. Local space
// is that of the background. Only directions matter there, because a background ignores
// translation; the fog has its own matrix. [render]
#include <algorithm>
#include <iterator>

#include "vrml97/batch.h"
#include "vrml97/classes.h"
#include "vrml97/cube_lookup.h"
#include "vrml97/texture_groups.h"

namespace vrml97 {
namespace {

enum FogType : int32_t {
  noFog = 0,
  linearFog = 1,
  exponentialFog = 2,
  expFog = 3, // OpenGL's GL_EXP and GL_EXP2
  exp2Fog = 4
};

struct EnvironmentParams {
  RtsFloats skyColor, skyAngle, groundColor, groundAngle;
  RtsTexture panorama[6]; // front, back, left, right, top, bottom
  int32_t fogType;
  float fogColor[3];
  float fogRange;
  float fogMatrix[16];
  float transparency;
  RtsTexture light[6]; // as `panorama`
  RtsTexture lightMap;
  float lightColor[3];
  float lightMatrix[16];
  float fogStart;
};

#define VRML97_PANORAMA(name, index, text)                                                         \
  {                                                                                                \
    name, RTS_TEXTURE, offsetof(EnvironmentParams, panorama) + (index) * sizeof(RtsTexture), {},   \
        0.0f, 0.0f, text                                                                           \
  }

#define VRML97_LIGHT(name, index, text)                                                            \
  {                                                                                                \
    name, RTS_TEXTURE, offsetof(EnvironmentParams, light) + (index) * sizeof(RtsTexture), {},      \
        0.0f, 0.0f, text                                                                           \
  }

const RtsParam environmentParams[] = {
    {"skyColor",
     RTS_FLOATS,
     offsetof(EnvironmentParams, skyColor),
     {},
     0.0f,
     0.0f,
     "three numbers a colour, from the zenith down"},
    {"skyAngle",
     RTS_FLOATS,
     offsetof(EnvironmentParams, skyAngle),
     {},
     0.0f,
     0.0f,
     "angles from the zenith of the second and later sky colours, radians"},
    {"groundColor",
     RTS_FLOATS,
     offsetof(EnvironmentParams, groundColor),
     {},
     0.0f,
     0.0f,
     "three numbers a colour, from the nadir up"},
    {"groundAngle",
     RTS_FLOATS,
     offsetof(EnvironmentParams, groundAngle),
     {},
     0.0f,
     0.0f,
     "angles from the nadir of the second and later ground colours, radians; the ground ends at "
     "the last"},
    VRML97_PANORAMA("frontTexture", 0, "picture seen along -z"),
    VRML97_PANORAMA("backTexture", 1, "picture seen along +z"),
    VRML97_PANORAMA("leftTexture", 2, "picture seen along -x"),
    VRML97_PANORAMA("rightTexture", 3, "picture seen along +x"),
    VRML97_PANORAMA("topTexture", 4, "picture seen along +y, its upper edge towards +z"),
    VRML97_PANORAMA("bottomTexture", 5, "picture seen along -y, its upper edge towards -z"),
    {"fogType",
     RTS_INT,
     offsetof(EnvironmentParams, fogType),
     {0.0f},
     0.0f,
     4.0f,
     "0: clear air, 1: linear, 2: exponential; OpenGL's, for a distance d: 3: exp(-d / fogRange), "
     "4: exp(-(d / fogRange)^2)"},
    {"fogColor",
     RTS_COLOR,
     offsetof(EnvironmentParams, fogColor),
     {1.0f, 1.0f, 1.0f},
     0.0f,
     0.0f,
     "colour of the fog"},
    {"fogRange",
     RTS_FLOAT,
     offsetof(EnvironmentParams, fogRange),
     {0.0f},
     0.0f,
     noLimit,
     "distance at which only fog is seen, units of the fog's space; 0: clear air"},
    {"fogMatrix",
     RTS_MATRIX,
     offsetof(EnvironmentParams, fogMatrix),
     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
     0.0f,
     0.0f,
     "matrix from local vectors to the fog's space; only its 3x3 part counts"},
    {"transparency",
     RTS_FLOAT,
     offsetof(EnvironmentParams, transparency),
     {0.0f},
     0.0f,
     1.0f,
     "transparency of sky and ground colours"},
    VRML97_LIGHT("lightFront", 0, "picture along -z of a light from all around"),
    VRML97_LIGHT("lightBack", 1, "picture along +z of that light"),
    VRML97_LIGHT("lightLeft", 2, "picture along -x of that light"),
    VRML97_LIGHT("lightRight", 3, "picture along +x of that light"),
    VRML97_LIGHT("lightTop", 4, "picture along +y of that light, its upper edge towards +z"),
    VRML97_LIGHT("lightBottom", 5, "picture along -y of that light, its upper edge towards -z"),
    {"lightMap",
     RTS_TEXTURE,
     offsetof(EnvironmentParams, lightMap),
     {},
     0.0f,
     0.0f,
     "instead of the six pictures: one of all longitudes and latitudes, its middle along -z"},
    {"lightColor",
     RTS_COLOR,
     offsetof(EnvironmentParams, lightColor),
     {0.0f, 0.0f, 0.0f},
     0.0f,
     0.0f,
     "radiance of the light from all around; multiplies its pictures; 0 0 0: the sky shines"},
    {"lightMatrix",
     RTS_MATRIX,
     offsetof(EnvironmentParams, lightMatrix),
     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
     0.0f,
     0.0f,
     "matrix from local directions to those of the light; only its 3x3 part counts"},
    {"fogStart",
     RTS_FLOAT,
     offsetof(EnvironmentParams, fogStart),
     {0.0f},
     -noLimit,
     noLimit,
     "distance at which linear fog begins"},
};

// Colours at angles from a pole. The first angle is 0; angles are clamped to 0..limit and never
// decrease.
struct Gradient {
  const float* color; // 3 floats for each stop
  float* angle;       // angle of each stop, radians
  uint32_t stops;
};

Gradient gradientOf(const RtsHost* host, RtsBatch* batch, const RtsFloats& color,
                    const RtsFloats& angle, float limit) {
  Gradient g{color.data, nullptr, std::min(color.count / 3, angle.count + 1)};
  if (g.stops == 0) return g;
  g.angle = host->scratch(batch, wholeLanes(g.stops));
  g.angle[0] = 0.0f;
  for (uint32_t i = 1; i < g.stops; i++)
    g.angle[i] = std::max(g.angle[i - 1], smaller(larger(angle.data[i - 1], 0.0f), limit));
  return g;
}

// Writes the interpolated colour at an angle; beyond the last angle it is the last colour.
void lookUp(const Gradient& g, float angle, float rgb[3]) {
  const auto above =
      static_cast<uint32_t>(std::upper_bound(g.angle, g.angle + g.stops, angle) - g.angle);
  const uint32_t last = above > 0 ? above - 1 : 0;
  const float* a = g.color + 3 * size_t(last);
  if (above == g.stops) {
    for (int c = 0; c < 3; c++) rgb[c] = a[c];
    return;
  }
  // The two angles differ, because upper_bound() returned `above`.
  const float t = (angle - g.angle[last]) / (g.angle[above] - g.angle[last]);
  const float* b = g.color + 3 * size_t(above);
  for (int c = 0; c < 3; c++) rgb[c] = a[c] + t * (b[c] - a[c]);
}

VRML97_CLONES void zenithAngles(uint32_t n, const float* __restrict x, const float* __restrict y,
                                const float* __restrict z, float* __restrict angle) {
  for (uint32_t i = 0; i < n; i++) angle[i] = angleOf(y[i], squareRoot(x[i] * x[i] + z[i] * z[i]));
}

VRML97_CLONES void constant(float value, uint32_t n, float* __restrict out) {
  for (uint32_t i = 0; i < n; i++) out[i] = value;
}

// Writes the colours of sky and ground. Without any colours the result is black with opacity 0.
void sky(const RtsHost* host, RtsBatch* batch, const EnvironmentParams& p, uint32_t n,
         const float* const d[3], float* const rgba[4]) {
  constexpr float pi = 3.14159265358979f;
  const Gradient sky = gradientOf(host, batch, p.skyColor, p.skyAngle, pi);
  const Gradient ground = gradientOf(host, batch, p.groundColor, p.groundAngle, pi / 2);
  const float opaque = 1.0f - p.transparency; // colours are premultiplied
  const uint32_t lanes = wholeLanes(n);
  if (sky.stops <= 1 && ground.stops <= 1) {
    // One colour in all directions: ground with a single colour has no extent.
    for (int c = 0; c < 3; c++) constant(sky.stops ? opaque * sky.color[c] : 0.0f, lanes, rgba[c]);
    constant(sky.stops ? opaque : 0.0f, lanes, rgba[3]);
    return;
  }
  float* angle = host->scratch(batch, lanes);
  zenithAngles(lanes, d[0], d[1], d[2], angle);
  const float groundEnd = ground.stops > 1 ? ground.angle[ground.stops - 1] : -1.0f;
  for (uint32_t i = 0; i < n; i++) {
    float rgb[3] = {0, 0, 0};
    const bool below = pi - angle[i] <= groundEnd;
    if (below)
      lookUp(ground, std::max(pi - angle[i], 0.0f), rgb);
    else if (sky.stops)
      lookUp(sky, angle[i], rgb);
    for (int c = 0; c < 3; c++) rgba[c][i] = opaque * rgb[c];
    rgba[3][i] = below || sky.stops ? opaque : 0.0f;
  }
}

// Composites the pictures on the six faces over the colours by their alpha.
void panorama(const RtsHost* host, RtsBatch* batch, const RtsTexture (&faces)[6], uint32_t n,
              const float* const d[3], float* const rgba[4]) {
  const uint32_t lanes = wholeLanes(n);
  float *s = host->scratch(batch, lanes), *t = host->scratch(batch, lanes);
  auto* texture = reinterpret_cast<RtsTexture*>(host->scratch(batch, lanes));
  auto* components = reinterpret_cast<uint32_t*>(host->scratch(batch, lanes));
  float* picture[4];
  for (float*& c : picture) c = host->scratch(batch, lanes);
  for (uint32_t i = 0; i < lanes; i++) {
    const uint32_t from = std::min(i, n - 1);
    const FaceCoords look = faceCoordsOf(d[0][from], d[1][from], d[2][from]);
    texture[i] = faces[look.face];
    s[i] = look.s;
    t[i] = look.t;
  }
  sampleGroups(host, batch, {n, texture, {s, t}}, picture, components);
  for (uint32_t i = 0; i < n; i++) {
    if (texture[i] == 0) continue;
    const float a = picture[3][i];
    for (int c = 0; c < 3; c++) rgba[c][i] = rgba[c][i] * (1.0f - a) + picture[c][i] * a;
    rgba[3][i] = rgba[3][i] * (1.0f - a) + a;
  }
}

bool anyOf(const RtsTexture (&faces)[6]) {
  return std::any_of(std::begin(faces), std::end(faces), [](RtsTexture t) { return t != 0; });
}

// Writes what is seen of the background.
void background(const RtsHost* host, RtsBatch* batch, const EnvironmentParams& p, uint32_t n,
                const float* const direction[3], float* const rgba[4]) {
  sky(host, batch, p, n, direction, rgba);
  if (anyOf(p.panorama)) panorama(host, batch, p.panorama, n, direction, rgba);
}

bool lights(const EnvironmentParams& p) {
  return p.lightColor[0] > 0.0f || p.lightColor[1] > 0.0f || p.lightColor[2] > 0.0f;
}

// Writes the radiance of an EnvironmentLight (ISO/IEC 19775-1:2023 17.4.2). Without pictures it is
// the same all around.
void environmentLight(const RtsHost* host, RtsBatch* batch, const EnvironmentParams& p, uint32_t n,
                      const float* const direction[3], float* const rgba[4]) {
  const uint32_t lanes = wholeLanes(n);
  const float* m = p.lightMatrix;
  float* d[3];
  for (int c = 0; c < 3; c++) {
    d[c] = host->scratch(batch, lanes);
    for (uint32_t i = 0; i < lanes; i++) {
      const uint32_t from = std::min(i, n - 1);
      d[c][i] =
          m[c] * direction[0][from] + m[4 + c] * direction[1][from] + m[8 + c] * direction[2][from];
    }
  }
  if (p.lightMap != 0) {
    float *u = host->scratch(batch, lanes), *v = host->scratch(batch, lanes);
    mapPlaces(lanes, d[0], d[1], d[2], u, v);
    const float* const uv[2] = {u, v};
    host->sample(batch, p.lightMap, n, uv, rgba);
  } else {
    const bool pictures = anyOf(p.light);
    for (int c = 0; c < 3; c++) constant(pictures ? 0.0f : 1.0f, lanes, rgba[c]);
    if (pictures) panorama(host, batch, p.light, n, d, rgba);
  }
  for (int c = 0; c < 3; c++)
    for (uint32_t i = 0; i < n; i++) rgba[c][i] *= p.lightColor[c];
  constant(1.0f, lanes, rgba[3]);
}

// An EnvironmentLight stands in for the background, except where the camera looks straight at it.
void miss(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
          const float* const direction[3], float* const rgba[4]) {
  if (n == 0) return;
  const auto& p = *static_cast<const EnvironmentParams*>(params);
  if (!lights(p)) return background(host, batch, p, n, direction, rgba);
  auto* seen = reinterpret_cast<uint32_t*>(host->scratch(batch, wholeLanes(n)));
  host->backdrop(batch, seen);
  const bool any = std::any_of(seen, seen + n, [](uint32_t s) { return s != 0; });
  const bool all = std::all_of(seen, seen + n, [](uint32_t s) { return s != 0; });
  if (all) return background(host, batch, p, n, direction, rgba);
  environmentLight(host, batch, p, n, direction, rgba);
  if (!any) return;
  float* behind[4];
  for (float*& c : behind) c = host->scratch(batch, wholeLanes(n));
  background(host, batch, p, n, direction, behind);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < n; i++)
      if (seen[i]) rgba[c][i] = behind[c][i];
}

VRML97_CLONES void fogDistances(const float* __restrict m, uint32_t n, const float* __restrict x,
                                const float* __restrict y, const float* __restrict z,
                                float* __restrict distance) {
  for (uint32_t i = 0; i < n; i++) {
    const float fx = m[0] * x[i] + m[4] * y[i] + m[8] * z[i];
    const float fy = m[1] * x[i] + m[5] * y[i] + m[9] * z[i];
    const float fz = m[2] * x[i] + m[6] * y[i] + m[10] * z[i];
    distance[i] = squareRoot(fx * fx + fy * fy + fz * fz);
  }
}

// Linear fog, clause 4.14.4: (v - d) / (v - start) between start and range, 0 beyond. The start is
// 0 in VRML97.
VRML97_CLONES void linearFraction(float start, float range, uint32_t n,
                                  const float* __restrict distance, float* __restrict fraction) {
  const float width = larger(range - start, 1e-37f);
  for (uint32_t i = 0; i < n; i++) {
    const float f = (range - distance[i]) / width;
    fraction[i] = smaller(larger(f, 0.0f), 1.0f);
  }
}

// Exponential fog, clause 4.14.4: exp(-d / (v - d)) within the range, 0 beyond.
VRML97_CLONES void exponentialFraction(float range, uint32_t n, const float* __restrict distance,
                                       float* __restrict fraction) {
  for (uint32_t i = 0; i < n; i++) {
    const float left = range - distance[i];
    const float power = -distance[i] / larger(left, 1e-37f);
    fraction[i] = expNegative(left > 0.0f ? power : vanishing);
  }
}

// The fog of OpenGL 1.1 (section 3.10): exp(-d / v), or exp(-(d / v)^2) if squared.
VRML97_CLONES void expFraction(bool squared, float range, uint32_t n,
                               const float* __restrict distance, float* __restrict fraction) {
  for (uint32_t i = 0; i < n; i++) {
    const float x = distance[i] / range;
    fraction[i] = expNegative(squared ? -x * x : -x);
  }
}

void attenuate(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
               const float* const fromEye[3], float* const color[3], float* fraction) {
  const auto& p = *static_cast<const EnvironmentParams*>(params);
  const uint32_t lanes = wholeLanes(n);
  for (int c = 0; c < 3; c++) constant(p.fogColor[c], lanes, color[c]);
  if (p.fogType == noFog || !(p.fogRange > 0.0f)) return constant(1.0f, lanes, fraction);
  float* distance = host->scratch(batch, lanes);
  fogDistances(p.fogMatrix, lanes, fromEye[0], fromEye[1], fromEye[2], distance);
  switch (p.fogType) {
  case exponentialFog: return exponentialFraction(p.fogRange, lanes, distance, fraction);
  case expFog:
  case exp2Fog: return expFraction(p.fogType == exp2Fog, p.fogRange, lanes, distance, fraction);
  default: return linearFraction(p.fogStart, p.fogRange, lanes, distance, fraction);
  }
}

// A Background is visible but lights nothing (clause 6.5); an EnvironmentLight does.
uint32_t environmentTraits(const RtsHost*, const void* params) {
  return lights(*static_cast<const EnvironmentParams*>(params)) ? 0 : RTS_BACKDROP;
}

constexpr RtsClass makeEnvironmentClass() {
  RtsClass c{};
  c.size = sizeof(RtsClass);
  c.kind = RTS_ENVIRONMENT;
  c.name = "VRML97Environment";
  c.text = "sky and ground of coloured bands, six pictures around, fog";
  c.paramSize = sizeof(EnvironmentParams);
  c.paramCount = sizeof(environmentParams) / sizeof(environmentParams[0]);
  c.params = environmentParams;
  c.traits = environmentTraits;
  c.miss = miss;
  c.attenuate = attenuate;
  return c;
}

} // namespace

const RtsClass environmentClass = makeEnvironmentClass();

} // namespace vrml97
