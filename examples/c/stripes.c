/* stripes.c: A shader plug-in that draws stripes across the texture coordinate s. Each vertex may
 * have its own colour. It includes one header and needs no library; custom_shader.c and
 * vertex_parameters.c use it. */
#include <openrt/openrts.h>

#include <math.h>
#include <stddef.h>

typedef struct Parameters {
  float color[3], count;
} Parameters;

static const RtsParam parameters[] = {
    {"color",
     RTS_COLOR,
     offsetof(Parameters, color),
     {1, 1, 1},
     0,
     1,
     "of the stripes; between them a quarter of it"},
    {"count", RTS_FLOAT, offsetof(Parameters, count), {8}, 1, 1000, "stripes from s = 0 to s = 1"},
};
static const uint8_t frequency[] = {RTS_PER_VERTEX, RTS_PER_SHADER};

/* Shades a batch of hits. */
static void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) {
    const Parameters* p = hits->params[i];
    const float at = hits->uv[0][i] * p->count, share = at - floorf(at) < 0.5f ? 1.0f : 0.25f;
    for (int k = 0; k < 3; k++) out->radiance[k][i] = share * p->color[k];
  }
}

static const RtsClass stripes = {.size = sizeof(RtsClass),
                                 .kind = RTS_SURFACE,
                                 .name = "Stripes",
                                 .text = "stripes that shine by themselves",
                                 .paramSize = sizeof(Parameters),
                                 .paramCount = 2,
                                 .params = parameters,
                                 .shade = shade,
                                 .frequency = frequency};
static const RtsClass* const classes[] = {&stripes};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        1,         classes};
