/* everything.c: a shader plug-in for tests, with a class of each kind and one parameter of each
 * type. */
#include <openrt/openrts.h>

#include <stddef.h>

typedef struct Parameters {
  int32_t count;
  float strength;
  float pair[2];
  float triple[3];
  float quad[4];
  float color[3];
  float matrix[16];
  RtsFloats list;
  const char* text;
  RtsTexture texture;
} Parameters;

static const RtsParam parameters[] = {
    {"count", RTS_INT, offsetof(Parameters, count), {3}, 0, 10, "a number of things"},
    {"strength", RTS_FLOAT, offsetof(Parameters, strength), {0.5f}, 0, 1, "a fraction"},
    {"pair", RTS_VEC2, offsetof(Parameters, pair), {1, 2}, 0, 0, "two numbers"},
    {"triple", RTS_VEC3, offsetof(Parameters, triple), {1, 2, 3}, 0, 0, "three numbers"},
    {"quad", RTS_VEC4, offsetof(Parameters, quad), {1, 2, 3, 4}, 0, 0, "four numbers"},
    {"color", RTS_COLOR, offsetof(Parameters, color), {0.1f, 0.2f, 0.3f}, 0, 1, "a colour"},
    {"matrix",
     RTS_MATRIX,
     offsetof(Parameters, matrix),
     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
     0,
     0,
     "a matrix"},
    {"list", RTS_FLOATS, offsetof(Parameters, list), {0}, -1, 1, "any number of numbers"},
    {"text", RTS_STRING, offsetof(Parameters, text), {0}, 0, 0, NULL},
    {"texture", RTS_TEXTURE, offsetof(Parameters, texture), {0}, 0, 0, "a texture"},
};

static void shade(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, RtsShading* out) {
  (void)host;
  (void)batch;
  for (uint32_t i = 0; i < hits->count; i++) {
    const Parameters* p = (const Parameters*)hits->params[i];
    for (int k = 0; k < 3; k++) out->radiance[k][i] = p->color[k] * p->strength;
  }
}

static void illuminate(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                       const float* const local[3], RtsIllumination* out) {
  (void)host;
  (void)batch;
  (void)params;
  for (uint32_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      out->toLight[k][i] = -local[k][i];
      out->color[k][i] = 1;
      out->ambient[k][i] = 0;
    }
  out->directional = 0;
}

static void generate(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                     const float* const xy[2], const float size[2], RtsRays* out) {
  (void)host;
  (void)batch;
  (void)params;
  for (uint32_t i = 0; i < n; i++) {
    out->origin[0][i] = xy[0][i] / size[0] - 0.5f;
    out->origin[1][i] = 0.5f - xy[1][i] / size[1];
    out->origin[2][i] = 0;
    out->direction[0][i] = 0;
    out->direction[1][i] = 0;
    out->direction[2][i] = -1;
  }
}

static const RtsClass surface = {.size = sizeof(RtsClass),
                                 .kind = RTS_SURFACE,
                                 .name = "Everything",
                                 .text = "one parameter of each type",
                                 .paramSize = sizeof(Parameters),
                                 .paramCount = sizeof(parameters) / sizeof(*parameters),
                                 .params = parameters,
                                 .shade = shade};
static const RtsClass plain = {
    .size = sizeof(RtsClass), .kind = RTS_SURFACE, .name = "Plain", .shade = shade};
static const RtsClass lamp = {
    .size = sizeof(RtsClass), .kind = RTS_LIGHT, .name = "Lamp", .illuminate = illuminate};
static const RtsClass eye = {
    .size = sizeof(RtsClass), .kind = RTS_CAMERA, .name = "Eye", .generate = generate};
static const RtsClass sky = {.size = sizeof(RtsClass), .kind = RTS_ENVIRONMENT, .name = "Sky"};

static const RtsClass* const classes[] = {&surface, &plain, &lamp, &eye, &sky};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        5,         classes};
