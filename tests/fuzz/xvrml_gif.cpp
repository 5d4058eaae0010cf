// xvrml_gif.cpp: passes arbitrary bytes to the GIF decoder alone. libFuzzer calls this on one
// thread.
#include <stdexcept>

#include "image/decoders.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  xvrml::Limits limits;
  limits.imagePixels = 1 << 20;
  const xvrml::Image image = xvrml::decodeGif({data, size}, xvrml::ImageRoom{limits});
  if (image.pixels.size() != size_t(image.width) * size_t(image.height) * size_t(image.components))
    __builtin_trap();
  return 0;
} catch (const std::runtime_error&) { return 0; }
