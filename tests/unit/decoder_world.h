// decoder_world.h: a world whose files are decoded, for the tests of libxvrml/decode.
#pragma once

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "image/decoders.h"
#include "unit/foreign_files.h"

namespace xvrml::test {

// The limits and the budget of a world.
struct World {
  explicit World(uint64_t imagePixels = 1 << 20) { limits.imagePixels = imagePixels; }
  ImageRoom room() { return {limits, ~uint64_t(0), &budget}; }
  Limits limits;
  Budget budget{uint64_t(1) << 30};
};

inline Image image(const Bytes& bytes, World& world) {
  return decodeImage(bytes.data(), bytes.size(), world.room());
}
// Decodes a file of any kind. Returns why that is not possible; "" if it is.
inline std::string whyNot(const Bytes& bytes, World& world) {
  try {
    const auto picture = decodePicture(bytes, world.room());
    if (const auto* i = std::get_if<Image>(&picture)) {
      EXPECT_EQ(i->pixels.size(), size_t(i->width) * size_t(i->height) * size_t(i->components));
    } else {
      const auto& r = std::get<RadianceImage>(picture);
      EXPECT_EQ(r.rgb.size(), size_t(r.width) * size_t(r.height) * 3);
    }
  } catch (const std::runtime_error& error) { return error.what(); }
  return "";
}

inline void expectBytes(const Image& image, int width, int height, int components,
                        bool seen = false) {
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  ASSERT_EQ(image.components, components);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < components; c++)
        ASSERT_EQ(int(image.pixels[size_t(((height - 1 - y) * width + x) * components + c)]),
                  c == 3 && seen ? alphaAt(x, y) : byteAt(x, y, c))
            << x << " " << y << " " << c;
}

// Sets a number of a file.
inline Bytes with(Bytes bytes, size_t at, uint32_t value, size_t count = 4) {
  for (size_t i = 0; i < count; ++i) bytes[at + i] = uint8_t(value >> 8 * i);
  return bytes;
}

} // namespace xvrml::test
