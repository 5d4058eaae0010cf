/* animation.c: a turning wheel of six balls. Frames overlap: rtSwapBuffers hands over the next
 * positions and gives back the picture of those before, which is written while the next one is
 * being made. usage: animation [picture.ppm] */
#include "picture.h"

enum { width = 160, height = 120, balls = 6, frames = 12 };
static float rgba[width * height * 4];

int main(int argc, char** argv) {
  int failed;
  if (!start(&argc, argv, &failed)) return 1;
  RTid ball = rtBeginObject(0);
  rtSphere(0.3f);
  rtEndObject();
  RTid wheel = rtBeginObject(0);
  for (int i = 0; i < balls; i++) {
    rtLoadIdentity();
    rtRotated(360.0 * i / balls, 0, 0, 1);
    rtTranslated(1, 0, 0);
    rtInstantiateObject(ball);
  }
  rtEndObject();
  RTid turning = rtInstantiateObject(wheel);
  rtInstanceHint(turning,
                 RT_DYNAMIC); /* its matrix will change: then a change costs next to nothing */

  rtTranslated(0, 0, 4);
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", NULL)));
  rtPerspective(45);
  rtFrameBuffer(width, height, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4);

  float seen[frames];
  for (int frame = 0; frame <= frames; frame++) {
    double m[16];
    rtLoadIdentity();
    rtRotated(60.0 * frame / frames, 0, 0, 1);
    rtGetMatrixd(m);
    rtInstanceMatrix(turning, m);
    rtSwapBuffers();          /* commits this matrix, starts this frame ... */
    if (frame == 0) continue; /* ... and waits for the one before, if there was one */
    rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
    seen[frame - 1] = rgba[4 * (height / 2 * width + width / 2 + 36)]; /* where a ball begins */
  }
  RTstats stats = {.size = sizeof(stats)};
  rtGetStats(&stats);
  rtExit();
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  printf("%d frames, %d structures built\n", frames, (int)stats.objectBuilds);
  /* A ball was there in the first frame and not halfway to the next one's place; nothing was built
   * for the later frames. */
  return !failed && seen[0] > 0.1f && seen[frames / 2] == 0 && stats.objectBuilds <= 2 ? 0 : 2;
}
