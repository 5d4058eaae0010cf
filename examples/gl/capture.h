/* capture.h: lets the OpenGL builds of the examples write their pictures, as rtut does for the
 * others: OPENRT_UT_FRAMES=N renders N frames into the files OPENRT_UT_FILE (default
 * frame%04d.ppm) and ends. */
#ifndef EXAMPLES_CAPTURE_H
#define EXAMPLES_CAPTURE_H

#ifdef USE_GL
#include <GL/glut.h>
#include <stdio.h>
#include <stdlib.h>

/* Writes what has been drawn. Call it before glutSwapBuffers. */
static void capture(void) {
  static int frame = 0;
  const char *frames = getenv("OPENRT_UT_FRAMES"), *pattern = getenv("OPENRT_UT_FILE");
  const int width = glutGet(GLUT_WINDOW_WIDTH), height = glutGet(GLUT_WINDOW_HEIGHT);
  char name[4096];
  if (!frames) return;
  snprintf(name, sizeof(name), pattern ? pattern : "frame%04d.ppm", frame++);
  unsigned char* rgb = malloc((size_t)(3 * width * height));
  FILE* file = fopen(name, "wb");
  if (!rgb || !file) exit(2);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rgb);
  fprintf(file, "P6\n%d %d\n255\n", width, height);
  for (int y = height - 1; y >= 0; y--) fwrite(rgb + 3 * width * y, 3, (size_t)width, file);
  if (fclose(file)) exit(2);
  free(rgb);
  if (frame >= atoi(frames)) exit(0);
}
#else
#include <openrt/rtut.h>
static void capture(void) {} /* rtut writes the pictures */
#endif

#endif
