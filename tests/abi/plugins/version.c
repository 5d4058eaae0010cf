/* version.c: the same library in three versions, for tests that reload it. The second version moves
 * `color` behind a new parameter, changes one parameter's type and drops another. The third lacks
 * the class. */
#include <openrt/openrts.h>

#include <stddef.h>

typedef struct Parameters {
#if VERSION == 2
  float gain;
  float shift[2];
#else
  float shift;
  float gone;
#endif
  float color[3];
} Parameters;

static const RtsParam parameters[] = {
#if VERSION == 2
    {"gain", RTS_FLOAT, offsetof(Parameters, gain), {2}, 0, 0, "new"},
    {"color", RTS_COLOR, offsetof(Parameters, color), {0.1f, 0.1f, 0.1f}, 0, 1, "kept"},
    {"shift", RTS_VEC2, offsetof(Parameters, shift), {0.5f, 0}, 0, 0, "another type now"},
#else
    {"color", RTS_COLOR, offsetof(Parameters, color), {0.1f, 0.1f, 0.1f}, 0, 1, "kept"},
    {"gone", RTS_FLOAT, offsetof(Parameters, gone), {0}, 0, 0, "gone later"},
    {"shift", RTS_FLOAT, offsetof(Parameters, shift), {0}, 0, 0, "of another type later"},
#endif
};
static const uint8_t frequency[] = {VERSION == 2 ? RTS_PER_SHADER : RTS_PER_VERTEX,
                                    VERSION == 2 ? RTS_PER_VERTEX : RTS_PER_SHADER, RTS_PER_SHADER};

static void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) {
    const Parameters* p = (const Parameters*)hits->params[i];
#if VERSION == 2
    for (int k = 0; k < 3; k++) out->radiance[k][i] = p->gain * p->color[k] + p->shift[0];
#else
    for (int k = 0; k < 3; k++) out->radiance[k][i] = p->color[k] + p->shift + p->gone;
#endif
  }
}

static const RtsClass versioned = {.size = sizeof(RtsClass),
                                   .kind = RTS_SURFACE,
#if VERSION == 3
                                   .name = "SomethingElse",
#else
                                   .name = "Versioned",
#endif
                                   .paramSize = sizeof(Parameters),
                                   .paramCount = 3,
                                   .params = parameters,
                                   .shade = shade,
                                   .frequency = frequency};
static const RtsClass* const classes[] = {&versioned};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        1,         classes};
