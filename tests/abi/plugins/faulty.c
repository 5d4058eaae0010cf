/* faulty.c: shaders that go wrong: one that crashes, one with NaN in its radiance, one with NaN in
 * a lobe, and some whose traits omit what they do. */
#include <openrt/openrts.h>

#include <math.h>
#include <stddef.h>

static void crash(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  volatile uintptr_t place = 16; /* an unmapped page */
  volatile float* const nowhere = (volatile float*)place;
  (void)host;
  (void)batch;
  (void)hits;
  (void)out;
  *nowhere = 1;
}

/* Does not return if x is above 0. */
static void hang(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  static volatile int sink;
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) {
    while (hits->position[0][i] > 0) sink++;
    out->radiance[0][i] = 0.5f;
  }
}

static void notANumber(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) {
    out->radiance[0][i] = hits->position[0][i] < 0 ? sqrtf(hits->position[0][i]) : 0.5f;
    out->radiance[1][i] = hits->position[0][i] < 0 ? INFINITY : 0.5f;
    out->radiance[2][i] = 0.5f;
  }
}

static void nanLobe(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  RtsLobe* const lobe = host->lobe(batch, RTS_LOBE_DIFFUSE);
  for (uint32_t i = 0; i < hits->count; i++) {
    for (int k = 0; k < 3; k++) {
      out->emission[k][i] = 0.25f;
      lobe->weight[k][i] = 0.5f;
    }
    lobe->normal[1][i] = NAN;
  }
}

static void emission(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) out->emission[0][i] = 1;
}

static uint32_t isTransparent(const RtsHost* host, const void* params) {
  (void)host;
  (void)params;
  return RTS_TRANSPARENT;
}
static uint32_t emitsUniformly(const RtsHost* host, const void* params) {
  (void)host;
  (void)params;
  return RTS_EMISSIVE | RTS_UNIFORM_EMISSION;
}
static void uneven(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++)
    out->emission[0][i] = hits->position[0][i] < 0 ? 1.0f : 2.0f;
}

static void veil(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  RtsLobe* const lobe = host->lobe(batch, RTS_LOBE_TRANSPARENT);
  (void)out;
  for (uint32_t i = 0; i < hits->count; i++) lobe->weight[0][i] = 0.5f;
}

static void gloss(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  RtsLobe* const lobe = host->lobe(batch, RTS_LOBE_GLOSSY);
  (void)out;
  for (uint32_t i = 0; i < hits->count; i++) {
    lobe->weight[0][i] = 0.5f;
    lobe->parameter[0][i] = 0.3f;
  }
}

/* A custom lobe whose functions go wrong. */
static void badEvaluate(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                        const float* const direction[3], float* const value[3], float* density) {
  (void)lobe;
  (void)hits;
  (void)hit;
  (void)direction;
  for (uint32_t i = 0; i < n; i++) {
    value[0][i] = NAN;
    value[1][i] = value[2][i] = 0.25f;
    density[i] = 1;
  }
}
static void badSample(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
                      const float* const square[2], float* const direction[3],
                      float* const quotient[3], float* density) {
  volatile uintptr_t place = 16;
  (void)lobe;
  (void)hits;
  (void)hit;
  (void)square;
  (void)direction;
  (void)quotient;
  for (uint32_t i = 0; i < n; i++) density[i] = *(volatile float*)place;
}
static const RtsLobeFunctions badFunctions = {sizeof(RtsLobeFunctions), 0, badEvaluate, badSample};
static void badLobe(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  RtsLobe* const lobe = host->customLobe(batch, &badFunctions, 0);
  (void)out;
  for (uint32_t i = 0; i < hits->count; i++)
    for (int k = 0; k < 3; k++) lobe->weight[k][i] = 0.5f;
}

static uint32_t nothingScatters(const RtsHost* host, const void* params) {
  (void)host;
  (void)params;
  return RTS_NO_SCATTER;
}
static void scatter(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsSurface* out) {
  RtsLobe* const lobe = host->lobe(batch, RTS_LOBE_DIFFUSE);
  (void)out;
  for (uint32_t i = 0; i < hits->count; i++)
    for (int k = 0; k < 3; k++) lobe->weight[k][i] = 0.5f;
}

#define SURFACE .size = sizeof(RtsClass), .kind = RTS_SURFACE
static const RtsClass crashes = {SURFACE, .name = "Crash", .shade = crash};
static const RtsClass hangs = {SURFACE, .name = "Hang", .shade = hang};
static const RtsClass nans = {SURFACE, .name = "Nan", .shade = notANumber};
static const RtsClass nanLobes = {SURFACE, .name = "NanLobe", .surface = nanLobe};
static const RtsClass lamps = {SURFACE, .name = "SilentLamp", .surface = emission};
static const RtsClass unevens = {SURFACE, .name = "UnevenLamp", .traits = emitsUniformly,
                                 .surface = uneven};
static const RtsClass veils = {SURFACE, .name = "SilentVeil", .surface = veil};
/* Lets paths pass straight on, and says so, but has no `transmit` for light samples. */
static const RtsClass blindVeils = {SURFACE, .name = "BlindVeil", .traits = isTransparent,
                                    .surface = veil};
static const RtsClass glosses = {SURFACE, .name = "SilentGloss", .surface = gloss};
static const RtsClass scatters = {SURFACE, .name = "SilentScatter", .traits = nothingScatters,
                                  .surface = scatter};
static const RtsClass badLobes = {SURFACE, .name = "BadLobe", .surface = badLobe};
static const RtsClass* const classes[] = {&crashes,  &hangs,   &nans,      &nanLobes,
                                          &lamps,    &veils,   &glosses,   &badLobes,
                                          &scatters, &unevens, &blindVeils};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        11,        classes};
