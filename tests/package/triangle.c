/* triangle.c: draws a triangle with the installed library and, if a folder is given, with the
 * plug-in `flat` from there. Exit code 0 if the pixels are as expected. */
#include <math.h>
#include <openrt/openrt.h>
#include <stdio.h>
#include <stdlib.h>

static int failed(const char* what) {
  fprintf(stderr, "triangle: %s: %s\n", what, rtGetError() ? rtGetErrorMessage() : "wrong value");
  return 1;
}

int main(int argc, char** argv) {
  enum { width = 32, height = 24, center = (height / 2) * width + width / 2 };
  static float depth[width * height], rgba[4 * width * height];
  char config[4096];
  snprintf(config, sizeof config, argc > 1 ? "threads=1 shaderpath=\"%s\"" : "threads=1",
           argc > 1 ? argv[1] : "");
  if (!rtNewContext(config)) return failed("context");

  if (argc > 1) {
    RTid shader = rtNewShader(rtNewShaderClass("Flat", "flat"));
    rtBindShader(shader);
    rtParameter3f(rtParameterHandle("color"), 0.25f, 0.5f, 0.75f);
  }
  RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(-1, -1, 0);
  rtVertex3f(1, -1, 0);
  rtVertex3f(0, 1, 0);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);

  rtLookAt(0, 0, 5, 0, 0, 0, 0, 1, 0);
  rtPerspective(40);
  rtFrameBuffer(width, height, RT_RGBA | RT_DEPTH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4);
  rtRender();
  rtReadPixels(RT_DEPTH, depth, width * height);
  rtReadPixels(RT_RGBA, rgba, 4 * width * height);
  if (rtGetError()) return failed("render");
  if (fabsf(depth[center] - 5) > 1e-4f) return failed("depth of the triangle");
  if (!isinf(depth[0])) return failed("depth of nothing");
  const float* pixel = rgba + 4 * center;
  if (argc > 1 && (pixel[0] != 0.25f || pixel[1] != 0.5f || pixel[2] != 0.75f))
    return failed("colour of the plug-in");

  rtRender(); /* the second frame reuses everything */
  rtDeleteContext(rtGetCurrent());
  puts("triangle: as it must be");
  return 0;
}
