// world.cpp: draws a world with the installed libraries. Exit code 0 if the box is in the expected
// place.
#include <cmath>
#include <cstdio>
#include <openrt/openrt.h>
#include <vector>
#include <xvrml/mapper.h>

int main() {
  auto world = xvrml::loadWorldFromMemory(
      "#VRML V2.0 utf8\nViewpoint { position 0 0 6 }\nShape { geometry Box { } }\n", "memory");
  const RTcontext context = rtNewContext("threads=1");
  if (!context) return 1;
  const int width = 32, height = 24;
  std::vector<float> depth(static_cast<size_t>(width) * height);
  {
    xvrml::OpenRTMapper mapper(*world, xvrml::MapOptions{});
    mapper.map(mapper.viewpointCamera(0));
    rtFrameBuffer(width, height, RT_DEPTH);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtRender();
    rtReadPixels(RT_DEPTH, depth.data(), depth.size());
  }
  const RTenum error = rtGetError();
  if (error) std::fprintf(stderr, "world: %s\n", rtGetErrorMessage());
  rtDeleteContext(context);
  if (error || std::fabs(depth[depth.size() / 2 + width / 2] - 5) > 1e-4F || !std::isinf(depth[0]))
    return 1;
  std::puts("world: as it must be");
  return 0;
}
