/* textures.c: Maps an image to a square and a ball by texture coordinates, with repeated and
 * with clamped edges. usage: textures [picture.ppm] */
#include "picture.h"

enum { width = 320, height = 160, size = 8 };
static float rgba[width * height * 4];

/* Creates a surface shader of the stock class VRML97 with a texture. */
static RTid textured(RTid image) {
  RTid surface = rtNewShader(rtNewShaderClass("VRML97", NULL));
  rtBindShader(surface);
  rtParameterTexture(rtParameterHandle("texture"), image);
  return surface;
}

int main(int argc, char** argv) {
  int failed;
  if (!start(&argc, argv, &failed)) return 1;

  /* A chessboard of 8 x 8 texels; rows run from the bottom up. */
  unsigned char texels[size][size][3];
  for (int t = 0; t < size; t++)
    for (int s = 0; s < size; s++)
      for (int k = 0; k < 3; k++)
        texels[t][s][k] = (unsigned char)((s + t) % 2 ? 230 : k == 0 ? 160 : 20);
  RTid board;
  rtGenTextures(1, &board);
  rtBindTexture(board);
  rtTexImage2D(3, size, size, RT_UNSIGNED_BYTE, texels);
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, RT_NEAREST);
  rtTexParameteri(RT_TEXTURE_SRGB, 1);
  rtTexParameteri(RT_TEXTURE_WRAP_T, RT_CLAMP_TO_EDGE);
  textured(board);

  RTid square = rtBeginObject(0);
  const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  rtBegin(RT_QUADS);
  rtNormal3f(0, 0, 1);
  for (int i = 0; i < 4; i++) {
    rtTexCoord2f(corners[i][0], corners[i][1]);
    rtVertex3f(2 * corners[i][0] - 1, 2 * corners[i][1] - 1, 0);
  }
  rtEnd();
  rtEndObject();
  RTid ball = rtBeginObject(0);
  rtSphere(0.9f); /* has texture coordinates of its own */
  rtEndObject();

  rtTranslated(-1.1, 0, 0);
  rtInstantiateObject(square);
  rtTranslated(2.2, 0, 0);
  rtInstantiateObject(ball);
  rtLoadIdentity();
  rtTranslated(0, 0, 8);
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", NULL)));
  rtOrtho(2.4);
  rtFrameBuffer(width, height, RT_RGBA);
  rtRender();
  rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
  rtExit();
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;

  /* Two neighbouring squares in the lower row: the left one is dark red, the right one bright. */
  const float *dark = rgba + 4 * (139 * width + 28), *bright = dark + 4 * 17;
  printf("dark %g %g, bright %g %g\n", dark[0], dark[1], bright[0], bright[1]);
  return !failed && dark[0] > 0.1f && dark[1] < 0.05f && bright[1] > 0.5f ? 0 : 2;
}
