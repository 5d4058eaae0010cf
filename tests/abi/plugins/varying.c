/* varying.c: a surface with one parameter of each type that may vary by vertex and by triangle. It
 * shows one of them. */
#include <openrt/openrts.h>

#include <stddef.h>

typedef struct Parameters {
  int32_t show;
  float whole;
  float color[3];
  float weight;
  float pair[2];
  float triple[3];
  float quad[4];
  float matrix[16];
} Parameters;

static const RtsParam parameters[] = {
    {"show", RTS_INT, offsetof(Parameters, show), {0}, 0, 5, "which of them is seen"},
    {"whole", RTS_FLOAT, offsetof(Parameters, whole), {0.5f}, 0, 1, "of the whole shader"},
    {"color", RTS_COLOR, offsetof(Parameters, color), {0.25f, 0.5f, 0.75f}, 0, 1, "by vertex"},
    {"weight", RTS_FLOAT, offsetof(Parameters, weight), {0.125f}, 0, 0, "by vertex"},
    {"pair", RTS_VEC2, offsetof(Parameters, pair), {1, 2}, 0, 0, "by triangle"},
    {"triple", RTS_VEC3, offsetof(Parameters, triple), {1, 2, 3}, 0, 0, "by triangle"},
    {"quad", RTS_VEC4, offsetof(Parameters, quad), {1, 2, 3, 4}, 0, 0, "by vertex"},
    {"matrix",
     RTS_MATRIX,
     offsetof(Parameters, matrix),
     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
     0,
     0,
     "by triangle"},
};
static const uint8_t frequency[] = {RTS_PER_SHADER, RTS_PER_SHADER,   RTS_PER_VERTEX,
                                    RTS_PER_VERTEX, RTS_PER_TRIANGLE, RTS_PER_TRIANGLE,
                                    RTS_PER_VERTEX, RTS_PER_TRIANGLE};

static void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) {
    const Parameters* p = (const Parameters*)hits->params[i];
    const float one[3] = {p->weight, p->whole, 0}, two[3] = {p->pair[0], p->pair[1], p->whole};
    const float* const seen[] = {p->color, one, two, p->triple, p->quad, p->matrix + 12};
    for (int k = 0; k < 3; k++) out->radiance[k][i] = seen[p->show][k];
  }
}

static const RtsClass varying = {.size = sizeof(RtsClass),
                                 .kind = RTS_SURFACE,
                                 .name = "Varying",
                                 .text = "parameters by vertex and by triangle",
                                 .paramSize = sizeof(Parameters),
                                 .paramCount = sizeof(parameters) / sizeof(*parameters),
                                 .params = parameters,
                                 .shade = shade,
                                 .frequency = frequency};
static const RtsClass* const classes[] = {&varying};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        1,         classes};
