/* nested_objects.c: Builds objects from objects: a ball, a row of balls, a square of rows and a
 * cube of squares, 5^3 balls from one definition. Then it redefines the row, and every copy
 * changes. usage: nested_objects [picture.ppm] */
#include <openrt/openrt.h>

#include <stdio.h>

#include "picture.h"

enum { width = 320, height = 240, side = 5 };
static float rgba[width * height * 4];

/* Defines an object of `side` instances of another one, one unit apart along an axis. */
static RTid rowOf(RTid object, RTid id, int x, int y, int z) {
  RTid row = rtBeginObject(id);
  for (int i = 0; i < side; i++) {
    rtLoadIdentity();
    rtTranslatef((float)(i * x), (float)(i * y), (float)(i * z));
    rtInstantiateObject(object);
  }
  rtEndObject();
  return row;
}

static RTid makeBall(RTid surfaceClass, float radius, float r, float g, float b) {
  RTid surface = rtNewShader(surfaceClass);
  rtBindShader(surface);
  rtParameter3f(rtParameterHandle("diffuseColor"), r, g, b);
  RTid ball = rtBeginObject(0);
  rtSphere(radius);
  rtEndObject();
  rtBindShader(0);
  return ball;
}

static float brightness(void) {
  rtRender();
  rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
  double sum = 0;
  for (int i = 0; i < width * height; i++) sum += rgba[4 * i + 1];
  return (float)(sum / (width * height));
}

int main(int argc, char** argv) {
  int failed;
  if (!start(&argc, argv, &failed)) return 1;
  RTid surfaceClass = rtNewShaderClass("VRML97", NULL);
  RTid small = makeBall(surfaceClass, 0.2f, 0.8f, 0.3f, 0.1f);

  RTid row = rowOf(small, 0, 1, 0, 0);
  RTid square = rowOf(row, 0, 0, 1, 0);
  RTid cube = rowOf(square, 0, 0, 0, 1);
  rtLoadIdentity();
  rtTranslatef(-2, -2, -2);
  rtInstantiateObject(cube);

  rtLoadIdentity();
  rtLookAt(7, 5, 9, 0, 0, 0, 0, 1, 0);
  rtUseLight(rtNewShader(
      rtNewShaderClass("VRML97DirectionalLight", NULL))); /* shines in the view direction */
  rtPerspective(35);
  rtFrameBuffer(width, height, RT_RGBA);

  float before = brightness();
  RTid large = makeBall(surfaceClass, 0.4f, 0.2f, 0.7f, 0.9f);
  rowOf(large, row, 1, 0, 0); /* the same id: all 25 rows change */
  float after = brightness();

  RTstats stats;
  stats.size = sizeof(stats);
  rtGetStats(&stats);
  rtExit();
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  printf("%d balls from %d instances\n", side * side * side, (int)stats.scene.instances);
  return !failed && stats.scene.instances == 3 * side + 1 && after > 1.5f * before ? 0 : 2;
}
