// webp.cpp: decodes WebP pictures with libwebp.
#include <stdexcept>
#include <vector>

#include <webp/decode.h>

#include "answer.h"

namespace xvrml::decoding {

void decodeWebp(std::span<const uint8_t> file, Answer& answer) {
  WebPBitstreamFeatures features{};
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK)
    throw std::runtime_error("its header is damaged");
  if (features.has_animation) throw std::runtime_error("it is animated, which is not read");
  const int components = features.has_alpha ? 4 : 3, row = features.width * components;
  answer.contents(
      {uint64_t(features.width), uint64_t(features.height), uint32_t(components), 1, 0});
  std::vector<uint8_t> pixels(size_t(row) * size_t(features.height));
  const auto read = features.has_alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (!read(file.data(), file.size(), pixels.data(), pixels.size(), row))
    throw std::runtime_error("it is damaged, or ends too early");
  answer.add(pixels.data(), pixels.size());
}

} // namespace xvrml::decoding
