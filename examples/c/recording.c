/* recording.c: Records the scene edits of a program while it renders. `openrt-replay FILE -o
 * DIR` renders the same pictures later or elsewhere, without the program. Recording the same
 * scene twice gives the same bytes. usage: recording FILE.rec [picture.ppm] */
#include "picture.h"

#include <stdlib.h>
#include <string.h>

enum { width = 80, height = 60 };
static float rgba[width * height * 4];

static int draw(const char* path) {
  char config[4096];
  snprintf(config, sizeof(config), "record=\"%s\"", path);
  if (!rtNewContext(config)) return 0;
  RTid object = rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  RTid ball = rtInstantiateObject(object);
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", NULL)));
  rtTranslated(0, 0, 4);
  rtPerspective(40);
  rtFrameBuffer(width, height, RT_RGBA);
  rtRender();
  const double aside[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1};
  rtInstanceMatrix(ball, aside);
  rtRender(); /* a second frame: only the matrix is recorded */
  rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
  RTenum error = rtGetError();
  if (error != RT_NO_ERROR) fprintf(stderr, "%s\n", rtGetErrorMessage());
  rtDeleteContext(rtGetCurrent()); /* closes the file */
  return error == RT_NO_ERROR;
}

static char* contents(const char* path, long* size) {
  FILE* file = fopen(path, "rb");
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  *size = ftell(file);
  rewind(file);
  char* bytes = malloc((size_t)*size);
  if (bytes && fread(bytes, 1, (size_t)*size, file) != (size_t)*size) *size = 0;
  fclose(file);
  return bytes;
}

int main(int argc, char** argv) {
  if (argc < 2) {
    fprintf(stderr, "usage: recording FILE.rec [picture.ppm]\n");
    return 1;
  }
  long first = 0, second = 0;
  if (!draw(argv[1])) return 1;
  char* before = contents(argv[1], &first);
  if (!draw(argv[1])) return 1;
  char* after = contents(argv[1], &second);
  if (argc > 2 && !writePicture(argv[2], width, height, rgba)) return 1;
  int same =
      before && after && first == second && first > 0 && memcmp(before, after, (size_t)first) == 0;
  printf("two frames in %ld bytes, %s\n", first,
         same ? "the same each time" : "not the same each time");
  free(before);
  free(after);
  return same && first < 4096 ? 0 : 2;
}
