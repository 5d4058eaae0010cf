/* triangle.c: The smallest picture: one object with one triangle in three colours, a lamp and a
 * camera. usage: triangle [picture.ppm] */
#include <openrt/openrt.h>

#include <stdio.h>

#include "picture.h"

enum { width = 320, height = 240 };
static float rgba[width * height * 4];

int main(int argc, char** argv) {
  int failed;
  if (!start(&argc, argv, &failed)) return 1;

  /* The scene: an object, and an instance of it. */
  RTid triangle = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtColor3f(1, 0, 0);
  rtVertex3f(-1, -1, 0);
  rtColor3f(0, 1, 0);
  rtVertex3f(1, -1, 0);
  rtColor3f(0, 0, 1);
  rtVertex3f(0, 1, 0);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(triangle);

  /* A lamp that shines along -z, of the stock class VRML97DirectionalLight. */
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", NULL)));

  /* The camera is at z = 4 and looks at the origin. */
  rtLookAt(0, 0, 4, 0, 0, 0, 0, 1, 0);
  rtPerspective(40);

  rtFrameBuffer(width, height, RT_RGBA);
  rtRender();
  rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
  rtExit();

  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  /* The centre of the picture is inside the triangle and lit; the corner is empty. */
  const float* middle = rgba + 4 * (height / 2 * width + width / 2);
  return !failed && middle[0] > 0.1f && middle[1] > 0.1f && middle[2] > 0.1f && rgba[0] == 0 ? 0
                                                                                             : 2;
}
