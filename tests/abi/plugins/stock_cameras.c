/* stock_cameras.c: the stock library of a test folder, with the two camera classes that
 * rtPerspective and rtOrtho use. */
#include <openrt/openrts.h>

typedef struct Parameters {
  float size;
} Parameters;

static const RtsParam fovy[] = {
    {"fovy", RTS_FLOAT, 0, {45}, 0, 180, "vertical field of view in degrees"}};
static const RtsParam height[] = {{"height", RTS_FLOAT, 0, {2}, 0, 1e30f, "height of the view"}};

static void generate(const RtsHost* host, RtsBatch* batch, const void* params, uint32_t n,
                     const float* const xy[2], const float size[2], RtsRays* out) {
  (void)host;
  (void)batch;
  (void)params;
  (void)xy;
  (void)size;
  for (uint32_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      out->origin[k][i] = 0;
      out->direction[k][i] = k == 2 ? -1.0f : 0.0f;
    }
}

static const RtsClass perspective = {.size = sizeof(RtsClass),
                                     .kind = RTS_CAMERA,
                                     .name = "PerspectiveCamera",
                                     .paramSize = sizeof(Parameters),
                                     .paramCount = 1,
                                     .params = fovy,
                                     .generate = generate};
static const RtsClass orthographic = {.size = sizeof(RtsClass),
                                      .kind = RTS_CAMERA,
                                      .name = "OrthographicCamera",
                                      .paramSize = sizeof(Parameters),
                                      .paramCount = 1,
                                      .params = height,
                                      .generate = generate};
static const RtsClass* const classes[] = {&perspective, &orthographic};
RTS_EXPORT const RtsPlugin rtsPlugin = {RTS_MAGIC, RTS_ABI_MAJOR, RTS_ABI_MINOR, sizeof(RtsPlugin),
                                        2,         classes};
