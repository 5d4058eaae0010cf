/* ray_queries.c: Casts rays without rendering: computes the height of a terrain below a grid of
 * points, and which of these points a lamp reaches. The picture is a map: bright is high, red is
 * in shadow. usage: ray_queries [picture.ppm] */
#include "picture.h"

enum { side = 100, cells = 40 };
static RTray rays[side * side];
static RThit hits[side * side];
static uint8_t shadowed[side * side];
static float rgba[side * side * 4];

static float terrain(float x, float z) {
  return 0.15f * sinf(9 * x) * cosf(7 * z) + 0.3f * expf(-20 * (x * x + z * z));
}

int main(int argc, char** argv) {
  int failed;
  if (!start(&argc, argv, &failed)) return 1;
  RTid object = rtBeginObject(0);
  for (int j = 0; j < cells; j++) {
    rtBegin(RT_QUAD_STRIP);
    for (int i = 0; i <= cells; i++)
      for (int k = 0; k < 2; k++) {
        float x = 2.0f * (float)i / cells - 1, z = 2.0f * (float)(j + k) / cells - 1;
        rtVertex3f(x, terrain(x, z), z);
      }
    rtEnd();
  }
  rtEndObject();
  rtInstantiateObject(object);
  rtTranslated(0, 5, 0);
  rtRotated(-90, 1, 0, 0);
  rtOrtho(2); /* rays query the committed scene; a frame commits the scene */
  rtFrameBuffer(1, 1, RT_RGBA);
  rtRender();

  for (int i = 0; i < side * side; i++) {
    float x = 2 * ((float)(i % side) + 0.5f) / side - 1,
          z = 2 * ((float)(i / side) + 0.5f) / side - 1;
    RTray down = {{x, 2, z}, 0, {0, -1, 0}, INFINITY};
    rays[i] = down;
  }
  rtCastRays(side * side, rays, hits); /* one call for all rays, on all threads */
  double worst = 0;
  const float lamp[3] = {0.9f, 0.6f, 0};
  for (int i = 0; i < side * side; i++) {
    float height = 2 - hits[i].t;
    worst = fmax(worst, fabs(height - terrain(rays[i].origin[0], rays[i].origin[2])));
    rays[i].origin[1] = height;
    for (int k = 0; k < 3; k++) rays[i].direction[k] = lamp[k] - rays[i].origin[k];
    rays[i].tnear = 1e-3f;
    rays[i].tfar = 1; /* from the ground to the lamp: the direction's length is the unit of t */
  }
  rtOccludedRays(side * side, rays, shadowed);
  int dark = 0;
  for (int i = 0; i < side * side; i++) {
    dark += shadowed[i];
    float bright = 0.3f + 2 * (2 - hits[i].t > 0 ? 2 - hits[i].t : 0);
    rgba[4 * i] = bright;
    rgba[4 * i + 1] = rgba[4 * i + 2] = shadowed[i] ? 0.2f * bright : bright;
  }
  rtExit();
  if (argc > 1 && !writePicture(argv[1], side, side, rgba)) return 1;
  printf("heights are off by at most %.4f, %d of %d points lie in the shadow\n", worst, dark,
         side * side);
  return !failed && worst < 0.02 && dark > 50 && dark < side * side / 2 ? 0 : 2;
}
