/* animation.c: Animates a turning wheel of six balls with overlapping frames. rtSwapBuffers
 * commits the new positions and returns the previous picture, which the program writes while the
 * next frame renders. usage: animation [picture.ppm] */
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
  rtInstanceHint(turning, RT_DYNAMIC); /* the matrix will change; this hint makes changes cheap */

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
    rtSwapBuffers();          /* commits this matrix, starts this frame */
    if (frame == 0) continue; /* and waits for the previous one, if there is one */
    rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
    seen[frame - 1] = rgba[4 * (height / 2 * width + width / 2 + 36)]; /* at the edge of a ball */
  }
  RTstats stats = {.size = sizeof(stats)};
  rtGetStats(&stats);
  rtExit();
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  printf("%d frames, %d structures built\n", frames, (int)stats.bvh.objectBuilds);
  /* A ball was there in the first frame, but not half a step later, and no structures were built
   * for the later frames. */
  return !failed && seen[0] > 0.1f && seen[frames / 2] == 0 && stats.bvh.objectBuilds <= 2 ? 0 : 2;
}
