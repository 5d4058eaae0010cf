/* custom_shader.c: Uses the plug-in stripes.c: queries the parameters of its class, sets them,
 * and draws two squares with it. usage: custom_shader --rt-shaderpath=FOLDER [picture.ppm]
 * FOLDER contains stripes.so. */
#include "picture.h"

enum { width = 200, height = 100 };
static float rgba[width * height * 4];

static RTid square(RTid shader) {
  RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  rtTexCoord2f(0, 0);
  rtVertex3f(-0.9f, -0.9f, 0);
  rtTexCoord2f(1, 0);
  rtVertex3f(0.9f, -0.9f, 0);
  rtTexCoord2f(1, 1);
  rtVertex3f(0.9f, 0.9f, 0);
  rtTexCoord2f(0, 1);
  rtVertex3f(-0.9f, 0.9f, 0);
  rtEnd();
  rtEndObject();
  return object;
}

int main(int argc, char** argv) {
  int failed, count = 0;
  if (!start(&argc, argv, &failed)) return 1;
  RTid stripes = rtNewShaderClass("Stripes", "stripes");
  rtGetShaderClass(stripes, NULL, &count);
  for (int i = 0; i < count; i++) {
    RTparameterInfo info;
    rtGetParameterInfo(stripes, i, &info);
    printf("%s (%g .. %g): %s\n", info.name, info.minimum, info.maximum, info.text);
  }
  RTid few = rtNewShader(stripes), many = rtNewShader(stripes);
  rtBindShader(few);
  rtParameter1f(rtParameterHandle("count"), 2);
  rtParameter3f(rtParameterHandle("color"), 1, 0.5f, 0);
  rtBindShader(many);
  rtParameter3f(rtParameterHandle("color"), 0, 0.5f, 1);

  RTid left = square(few), right = square(many);
  rtTranslated(-1, 0, 0);
  rtInstantiateObject(left);
  rtTranslated(2, 0, 0);
  rtInstantiateObject(right);
  rtLoadIdentity();
  rtTranslated(0, 0, 5);
  rtOrtho(2);
  rtFrameBuffer(width, height, RT_RGBA);
  rtRender();
  rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
  rtExit();
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  /* Two pixels of the left square: on a stripe, and between stripes. */
  const float *first = rgba + 4 * (height / 2 * width + 10), *second = first + 4 * 22;
  return !failed && count == 2 && first[0] == 1 && first[1] == 0.5f && second[0] == 0.25f ? 0 : 2;
}
