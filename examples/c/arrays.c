/* arrays.c: Draws a hilly surface of 80,000 triangles from indexed arrays, and moves it between
 * two frames without sending it again. usage: arrays [picture.ppm] */
#include <openrt/openrt.h>

#include <stdio.h>
#include <stdlib.h>

#include "picture.h"

enum { width = 320, height = 240, side = 201 };
static float rgba[width * height * 4];

typedef struct Vertex {
  float position[3], normal[3], color[3];
} Vertex;

static Vertex hill(int column, int row) {
  const float pi = 3.14159265f;
  float x = 2.0f * (float)column / (side - 1) - 1, z = 2.0f * (float)row / (side - 1) - 1;
  float y = 0.2f * sinf(pi * 2 * x) * cosf(pi * z);
  float dx = 0.2f * pi * 2 * cosf(pi * 2 * x) * cosf(pi * z),
        dz = -0.2f * pi * sinf(pi * 2 * x) * sinf(pi * z);
  Vertex v = {{x, y, z}, {-dx, 1, -dz}, {0.5f + y, 0.8f, 0.3f - y}};
  return v;
}

int main(int argc, char** argv) {
  Vertex* vertices = malloc(sizeof(Vertex) * side * side);
  uint32_t* indices = malloc(sizeof(uint32_t) * 6 * (side - 1) * (side - 1));
  int failed;
  if (!vertices || !indices || !start(&argc, argv, &failed)) return 1;
  for (int row = 0; row < side; row++)
    for (int column = 0; column < side; column++) vertices[row * side + column] = hill(column, row);
  uint32_t* out = indices;
  for (uint32_t row = 0; row + 1 < side; row++)
    for (uint32_t column = 0; column + 1 < side; column++) {
      uint32_t a = row * side + column, b = a + 1, c = a + side, d = c + 1;
      *out++ = a, *out++ = c, *out++ = b;
      *out++ = b, *out++ = c, *out++ = d;
    }

  /* rtDrawElements copies the arrays. */
  RTid surface = rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, sizeof(Vertex), vertices->position);
  rtNormalPointer(RT_FLOAT, sizeof(Vertex), vertices->normal);
  rtColorPointer(3, RT_FLOAT, sizeof(Vertex), vertices->color);
  rtDrawElements(RT_TRIANGLES, (size_t)(out - indices), indices, side * side);
  rtEndObject();
  free(vertices);
  free(indices);
  RTid instance = rtInstantiateObject(surface);

  rtLookAt(0, 1.5, 3, 0, 0, 0, 0, 1, 0);
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", NULL)));
  rtPerspective(45);
  rtFrameBuffer(width, height, RT_RGBA | RT_DEPTH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4);
  rtRender();
  static float depth[width * height];
  rtReadPixels(RT_DEPTH, depth, width * height);
  float before = depth[height / 2 * width + width / 2];

  /* The next frame needs a single edit: the instance's matrix moves the surface one unit away
   * from the camera. */
  const double further[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.447214, -0.894427, 1};
  rtInstanceMatrix(instance, further);
  rtRender();
  rtReadPixels(RT_DEPTH, depth, width * height);
  rtReadPixels(RT_RGBA, rgba, sizeof(rgba) / sizeof(*rgba));
  float after = depth[height / 2 * width + width / 2];

  rtExit();
  if (argc > 1 && !writePicture(argv[1], width, height, rgba)) return 1;
  printf("the surface was %g away, now %g\n", before, after);
  return !failed && fabsf(after - before - 1) < 0.05f ? 0 : 2;
}
