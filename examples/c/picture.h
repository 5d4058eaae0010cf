/* picture.h: Shared by the C examples: creates a context that prints its messages on stderr, and
 * writes a rendered frame as a PPM file (linear colour to sRGB, 8 bits). */
#ifndef EXAMPLES_PICTURE_H
#define EXAMPLES_PICTURE_H

#include <openrt/openrt.h>

#include <math.h>
#include <stdio.h>

static void printMessage(int level, const char* message, void* user) {
  (void)user;
  if (level >= 2) fprintf(stderr, "%s\n", message);
}
static void printError(RTenum error, const char* message, void* user) {
  *(int*)user = (int)error;
  fprintf(stderr, "%s\n", message);
}

/* Creates a context. Options such as --rt-threads=1 or --rt-backend=debug:local are removed from
 * argv. Errors set *failed. */
static inline int start(int* argc, char** argv, int* failed) {
  *failed = 0;
  rtInit(argc, argv);
  if (rtGetError() != RT_NO_ERROR) {
    fprintf(stderr, "%s\n", rtGetErrorMessage());
    return 0;
  }
  rtErrorCallback(printError, failed);
  rtLogCallback(printMessage, NULL);
  return 1;
}

static unsigned char toByte(float linear) {
  float c = linear < 0 ? 0 : linear > 1 ? 1 : linear;
  c = c <= 0.0031308f ? 12.92f * c : 1.055f * powf(c, 1 / 2.4f) - 0.055f;
  return (unsigned char)(255 * c + 0.5f);
}

/* rgba: four floats per pixel, first row at the top. Returns 0 if the file cannot be written. */
static int writePicture(const char* path, int width, int height, const float* rgba) {
  FILE* file = fopen(path, "wb");
  if (!file) return 0;
  fprintf(file, "P6\n%d %d\n255\n", width, height);
  for (int i = 0; i < width * height; i++)
    for (int k = 0; k < 3; k++) fputc(toByte(rgba[4 * i + k]), file);
  return fclose(file) == 0;
}

#endif
