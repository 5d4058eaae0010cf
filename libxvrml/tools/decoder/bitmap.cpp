// bitmap.cpp: decodes BMP and TGA pictures with stb_image.
#include <limits>
#include <memory>
#include <stdexcept>

#if __has_include(<stb/stb_image.h>)
#define WITH_STB
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>
#endif

#include "answer.h"

namespace xvrml::decoding {

#ifdef WITH_STB
void decodeBitmap(std::span<const uint8_t> file, Answer& answer) {
  if (file.size() > size_t(std::numeric_limits<int>::max()))
    throw std::runtime_error("it is too large");
  const auto refuse = [] {
    const char* const why = stbi_failure_reason();
    throw std::runtime_error(why ? why : "it is damaged");
  };
  const int size = int(file.size());
  int width = 0, height = 0, components = 0;
  if (!stbi_info_from_memory(file.data(), size, &width, &height, &components)) refuse();
  answer.contents({uint64_t(width), uint64_t(height), uint32_t(components), 1, 0});
  const std::unique_ptr<uint8_t, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(file.data(), size, &width, &height, nullptr, components),
      stbi_image_free);
  if (!pixels) refuse();
  answer.add(pixels.get(), size_t(width) * size_t(height) * size_t(components));
}
#else
void decodeBitmap(std::span<const uint8_t>, Answer&) {
  throw std::runtime_error("this build has no stb_image, which reads BMP and TGA");
}
#endif

} // namespace xvrml::decoding
