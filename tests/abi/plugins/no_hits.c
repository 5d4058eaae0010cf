/* no_hits.c: a transport, a camera and an environment that ask the host for facts about hits, which
 * their batches do not have. They show whether the host writes what openrts.h promises. */
#include <openrt/openrts.h>

#include <stddef.h>

enum { VECTORS = 5, FLOATS = 3 * VECTORS + 1, NUMBERS = 4 };

/* Returns an array of n floats: 1 where every fact about the lane has its promised value, else 0.
 * All arrays are filled with other values before the host writes to them. */
static const float* check(const RtsHost* host, RtsBatch* batch, uint32_t n) {
  float* f[FLOATS];
  uint32_t* u[NUMBERS];
  float* good = host->scratch(batch, n);
  for (int a = 0; a < FLOATS; a++) {
    f[a] = host->scratch(batch, n);
    for (uint32_t i = 0; i < n; i++) f[a][i] = 7;
  }
  for (int a = 0; a < NUMBERS; a++) {
    u[a] = (uint32_t*)host->scratch(batch, n);
    for (uint32_t i = 0; i < n; i++) u[a][i] = 7;
  }
  host->local(batch, f, f + 3);
  host->local(batch, NULL, NULL);
  host->derivatives(batch, f + 6, f + 9);
  host->path(batch, u[3], f + 12);
  host->path(batch, NULL, NULL);
  host->error(batch, f[15]);
  host->ids(batch, u[0], u[1], u[2]);
  host->ids(batch, NULL, NULL, NULL);
  for (uint32_t i = 0; i < n; i++) {
    good[i] = 1;
    for (int a = 0; a < FLOATS; a++)
      if (f[a][i] != (a / 3 == 4 ? 1.0f : 0.0f)) good[i] = 0;
    for (int a = 0; a < NUMBERS; a++)
      if (u[a][i] != 0) good[i] = 0;
  }
  return good;
}

static void radiance(const RtsHost* host, RtsBatch* batch, const void* params,
                     const RtsRequest* rays, float* const rgba[4]) {
  const float* good = check(host, batch, rays->count);
  (void)params;
  for (uint32_t i = 0; i < rays->count; i++)
    for (int k = 0; k < 4; k++) rgba[k][i] = good[i];
}

/* Looks along -z where the facts are right, else along +z. */
static void generate(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                     const float* const xy[2], const float size[2], RtsRays* out) {
  const float* good = check(host, batch, n);
  (void)params;
  (void)xy;
  (void)size;
  for (uint32_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      out->origin[k][i] = 0;
      out->direction[k][i] = k == 2 ? 1 - 2 * good[i] : 0.0f;
    }
}

/* Red is 1 where the facts are right; green is 1 where the camera looks along -z. Blue is 1 where a
 * random point is the middle of the square. */
static void miss(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                 const float* const direction[3], float* const rgba[4]) {
  const float* good = check(host, batch, n);
  float* square[2];
  (void)params;
  for (int k = 0; k < 2; k++) {
    square[k] = host->scratch(batch, n);
    for (uint32_t i = 0; i < n; i++) square[k][i] = 7;
  }
  host->random(batch, 0, square);
  for (uint32_t i = 0; i < n; i++) {
    rgba[0][i] = good[i];
    rgba[1][i] = direction[2][i] < 0 ? 1.0f : 0.0f;
    rgba[2][i] = square[0][i] == 0.5f && square[1][i] == 0.5f ? 1.0f : 0.0f;
    rgba[3][i] = 1;
  }
}

static const RtsClass transport = {.size = sizeof(RtsClass),
                                   .kind = RTS_TRANSPORT,
                                   .name = "NoHitsTransport",
                                   .text = "",
                                   .radiance = radiance};
static const RtsClass camera = {.size = sizeof(RtsClass),
                                .kind = RTS_CAMERA,
                                .name = "NoHitsCamera",
                                .text = "",
                                .generate = generate};
static const RtsClass environment = {.size = sizeof(RtsClass),
                                     .kind = RTS_ENVIRONMENT,
                                     .name = "NoHitsEnvironment",
                                     .text = "",
                                     .miss = miss};
static const RtsClass* const classes[] = {&transport, &camera, &environment};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        3,         classes};
