/* light_facts.c: a light that asks the host for facts about the hits it lights, and a surface that
 * adds up its lights. The light knows the scene of light_facts.cpp, so it can judge the facts. */
#include <openrt/openrts.h>

#include <math.h>
#include <stddef.h>

enum { VECTORS = 5, FLOATS = 3 * VECTORS + 2, NUMBERS = 5 };

static int near(float a, float b) { return fabsf(a - b) < 1e-3f; }

/* The light stands at (0, 0, 3). The hits are on a square of two triangles in the plane z = 0: 0
 * where x > y, else 1. The texture coordinates are x and y. The object is moved by (0.5, 0, 0). A
 * wall at x = 2 stands where y < 0. Red counts wrong facts, green is 1. */
static void illuminate(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                       const float* const local[3], RtsIllumination* out) {
  float* f[FLOATS];
  uint32_t* u[NUMBERS];
  float* ray[6];
  (void)params;
  for (int a = 0; a < FLOATS; a++) {
    f[a] = host->scratch(batch, n);
    for (uint32_t i = 0; i < n; i++) f[a][i] = 7;
  }
  for (int a = 0; a < NUMBERS; a++) {
    u[a] = (uint32_t*)host->scratch(batch, n);
    for (uint32_t i = 0; i < n; i++) u[a][i] = 7;
  }
  for (int k = 0; k < 3; k++) {
    ray[k] = host->scratch(batch, n);
    ray[3 + k] = host->scratch(batch, n);
  }
  uint32_t* hit = (uint32_t*)host->scratch(batch, n);
  for (uint32_t i = 0; i < n; i++) {
    hit[i] = i;
    ray[0][i] = 0.6f;
    ray[1][i] = 0;
    ray[2][i] = 0.8f;
  }
  host->local(batch, f, f + 3);
  host->derivatives(batch, f + 6, f + 9);
  host->path(batch, u[0], f + 12);
  host->error(batch, f[15]);
  host->ids(batch, u[1], u[2], u[3]);
  const RtsRequest rays = {.count = n, .hit = hit, .direction = {ray[0], ray[1], ray[2]}};
  RtsFound found = {.distance = f[16], .name = u[4]};
  host->findHit(batch, &rays, &found);
  host->occluded(batch, &rays, ray + 3);
  for (uint32_t i = 0; i < n; i++) {
    const float x = local[0][i], y = local[1][i];
    float wrong = 0;
    for (int k = 0; k < 3; k++) {
      const float position[3] = {x - 0.5f, y, 0};
      wrong += !near(f[k][i], position[k]);
      wrong += !near(f[3 + k][i], k == 2);
      wrong += !near(f[6 + k][i], k == 0);
      wrong += !near(f[9 + k][i], k == 1);
      wrong += f[12 + k][i] != 1;
    }
    wrong += !(f[15][i] > 0 && f[15][i] < 1e-3f);
    wrong += u[0][i] != 0;
    wrong += u[1][i] != 77;
    wrong += u[2][i] == 0 || u[2][i] == 7;
    if (!near(x, y)) wrong += u[3][i] != (x > y ? 0u : 1u);
    if (!near(y, 0)) {
      const int blocked = y < 0;
      wrong += blocked ? !near(f[16][i], (2 - x) / 0.6f) || u[4][i] != 78 : f[16][i] < 100;
      for (int k = 0; k < 3; k++) wrong += ray[3 + k][i] != (blocked ? 0.0f : 1.0f);
    }
    for (int k = 0; k < 3; k++) out->toLight[k][i] = -local[k][i];
    out->color[0][i] = wrong;
    out->color[1][i] = 1;
    out->color[2][i] = 0;
  }
}

static int extent(const RtsHost* host, const void* params, RtsExtent* out) {
  (void)host;
  (void)params;
  *out = (RtsExtent){.direction = {0, 0, -1}, .cosine = -1, .power = 1, .radius = INFINITY};
  return 1;
}

static void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  const uint32_t count = host->lights(batch);
  for (uint32_t l = 0; l < count; l++) {
    RtsIllumination light;
    host->illuminate(batch, l, hits, &light);
    for (uint32_t i = 0; i < hits->count; i++)
      for (int k = 0; k < 3; k++) out->radiance[k][i] += light.color[k][i];
  }
}

static const RtsClass light = {.size = sizeof(RtsClass),
                               .kind = RTS_LIGHT,
                               .name = "LightFacts",
                               .text = "",
                               .illuminate = illuminate,
                               .extent = extent};
static const RtsClass surface = {.size = sizeof(RtsClass),
                                 .kind = RTS_SURFACE,
                                 .name = "SumOfLights",
                                 .text = "",
                                 .shade = shade};
static const RtsClass* const classes[] = {&light, &surface};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        2,         classes};
