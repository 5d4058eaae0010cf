/* flat.c: the smallest surface shader in C: one colour, no light. Built as a plug-in with only the
 * installed SDK. */
#include <openrt/openrts.h>

typedef struct Flat {
  float color[3];
} Flat;

static uint32_t traits(const RtsHost* host, const void* params) {
  (void)host;
  (void)params;
  return RTS_UNLIT;
}

static void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; ++i) {
    const Flat* flat = (const Flat*)hits->params[i];
    for (int c = 0; c < 3; ++c) out->radiance[c][i] = flat->color[c];
  }
}

static const RtsParam params[] = {{.name = "color",
                                   .type = RTS_COLOR,
                                   .offset = offsetof(Flat, color),
                                   .defaultValue = {1, 1, 1},
                                   .text = "radiance in every direction"}};
static const RtsClass flat = {.size = sizeof(RtsClass),
                              .kind = RTS_SURFACE,
                              .name = "Flat",
                              .text = "one colour, unlit",
                              .paramSize = sizeof(Flat),
                              .paramCount = 1,
                              .params = params,
                              .traits = traits,
                              .shade = shade};
static const RtsClass* const classes[] = {&flat};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        1,         classes};
