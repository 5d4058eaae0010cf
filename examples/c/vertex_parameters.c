/* vertex_parameters.c: Sets a shader parameter per vertex: between rtBegin and rtEnd, and from
 * an array. It uses the plug-in stripes.c. usage: vertex_parameters --rt-shaderpath=FOLDER
 * [picture.ppm] FOLDER contains stripes.so. */
#include "picture.h"

enum { width = 200, height = 100 };
static float rgba[width * height * 4];

int main(int argc, char** argv) {
  int failed;
  if (!start(&argc, argv, &failed)) return 1;
  const float corners[4][3] = {
      {-0.9f, -0.9f, 0}, {0.9f, -0.9f, 0}, {0.9f, 0.9f, 0}, {-0.9f, 0.9f, 0}};
  const float places[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const float colors[4][3] = {{1, 0, 0}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}};
  rtBindShader(rtNewShader(rtNewShaderClass("Stripes", "stripes")));
  int color = rtParameterHandle("color");
  rtParameter1f(rtParameterHandle("count"), 7); /* this parameter applies to the whole shader */

  /* Latched like a normal or a colour: each vertex gets the last value that was set. */
  RTid one = rtBeginObject(0);
  rtBegin(RT_QUADS);
  for (int i = 0; i < 4; i++) {
    rtTexCoord2f(places[i][0], places[i][1]);
    rtParameter3f(color, colors[i][0], colors[i][1], colors[i][2]);
    rtVertex3fv(corners[i]);
  }
  rtEnd();
  rtEndObject();

  /* The same, from arrays. */
  RTid other = rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, corners);
  rtTexCoordPointer(2, RT_FLOAT, 0, places);
  rtParameterPointer(color, 0, colors[0]);
  rtDrawArrays(RT_QUADS, 0, 4);
  rtEndObject();

  rtTranslated(-1, 0, 0);
  rtInstantiateObject(one);
  rtTranslated(2, 0, 0);
  rtInstantiateObject(other);
  rtLoadIdentity();
  rtTranslated(0, 0, 5);
  rtOrtho(2);
  rtFrameBuffer(width, height, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtRender();
  rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
  rtExit();
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  int same = 1;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width / 2; x++)
      same &= fabsf(rgba[4 * (y * width + x)] - rgba[4 * (y * width + x + width / 2)]) < 1e-5f;
  const float* quarter =
      rgba + 4 * (height / 2 * width + 28); /* a quarter of the way from red to blue */
  printf("a quarter of the way: %g 0 %g\n", quarter[0], quarter[2]);
  return !failed && same && quarter[0] > 2.5f * quarter[2] && quarter[2] > 0 ? 0 : 2;
}
