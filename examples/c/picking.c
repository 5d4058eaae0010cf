/* picking.c: Finds what is under a pixel: names of primitives, instances, barycentric
 * coordinates. The picture shows the channel of names. usage: picking [picture.ppm] */
#include "picture.h"

enum { width = 160, height = 120 };
static float names[width * height], rgba[width * height * 4];

int main(int argc, char** argv) {
  int failed;
  if (!start(&argc, argv, &failed)) return 1;
  RTid object = rtBeginObject(0);
  rtLoadName(1);
  rtTranslated(-0.8, 0, 0);
  rtSphere(0.7f);
  rtLoadName(2);
  rtTranslated(1.6, 0, 0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(-0.7f, -0.7f, 0);
  rtVertex3f(0.7f, -0.7f, 0);
  rtVertex3f(0, 0.7f, 0);
  rtEnd();
  rtEndObject();
  RTid instance = rtInstantiateObject(object);
  rtInstanceUserData(instance, 4711);
  rtTranslated(0, 0, 5);
  rtPerspective(30);
  rtFrameBuffer(width, height, RT_RGBA | RT_NAME);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtRender();
  rtReadPixels(RT_NAME, names, width * height);

  int wrong = 0;
  for (int y = 2; y < height; y += 7)
    for (int x = 3; x < width; x += 7) {
      RThit hit;
      rtPick(x + 0.5, y + 0.5, &hit); /* the centre of the pixel */
      wrong += hit.name != (uint32_t)names[y * width + x];
    }
  RThit hit;
  int met = rtPick(116, 62, &hit);
  printf("instance %u, name %u, primitive %u, user data %u, at %g, corner weights %g %g %g\n",
         hit.instance, hit.name, hit.primitive, (unsigned)hit.userData, hit.t, 1 - hit.u - hit.v,
         hit.u, hit.v);
  int right = met && hit.instance == instance && hit.name == 2 && hit.userData == 4711 &&
              fabsf(hit.t - 5) < 0.2f;
  int nothing = rtPick(1, 1, &hit) == 0 && isinf(hit.t);
  rtExit();
  for (int i = 0; i < width * height; i++)
    for (int k = 0; k < 3; k++) rgba[4 * i + k] = names[i] == (float)(k + 1) ? 0.8f : 0.05f;
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  return !failed && wrong == 0 && right && nothing ? 0 : 2;
}
