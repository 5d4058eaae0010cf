// xvrml_decoder_bitmaps.cpp: BMP and TGA files that stb_image alone would read wrongly, or show
// with what its memory held before.
#include "unit/decoder_world.h"

namespace xvrml::test {
namespace {

TEST(DecoderBitmaps, RowsFromTheTopAndFromTheRight) {
  World world;
  for (const int components : {3, 4}) {
    Image picture = image(with(makeBmp(5, 4, components), 22, uint32_t(-4)), world);
    flipRows(picture); // the rows of the file are those of a picture from the bottom
    expectBytes(picture, 5, 4, components, true);
  }
  for (const int width : {1, 4, 5})
    for (const TgaKind& kind : {TgaKind{}, TgaKind{.fromTop = true}, TgaKind{1, true}}) {
      const Bytes file = makeTga(width, 3, kind);
      const Image plain = image(file, world),
                  turned = image(with(file, 17, file[17] | 0x10u, 1), world);
      ASSERT_EQ(turned.pixels.size(), plain.pixels.size());
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < width; ++x)
          for (int c = 0; c < kind.components; ++c)
            EXPECT_EQ(turned.pixels[size_t((y * width + x) * kind.components + c)],
                      plain.pixels[size_t((y * width + width - 1 - x) * kind.components + c)]);
    }
}

TEST(DecoderBitmaps, FilesThatEndTooEarlyAreRefused) {
  World world;
  const auto cutAnywhere = [&](Bytes file, size_t header, const std::string& format) {
    EXPECT_EQ(whyNot(file, world), "");
    while (file.size() > header) {
      file.pop_back();
      EXPECT_EQ(whyNot(file, world), format + " picture: it ends too early") << file.size();
    }
  };
  cutAnywhere(makeBmp(4, 3, 3), 54, "BMP");
  cutAnywhere(makeBmp(3, 3, 4), 54, "BMP");
  for (const int components : {1, 3, 4})
    for (const bool runs : {false, true})
      cutAnywhere(makeTga(4, 3, {components, runs, false}), 18, "TGA");
  EXPECT_NE(whyNot(with(makeTga(4, 3, {}), 12, 0x03e803e8), world), "") << "1000 x 1000";
}

// Makes a BMP file of one row of 32 bits.
Bytes withPalette(uint8_t depth, uint8_t colors, const Bytes& row) {
  const uint8_t offset = uint8_t(54 + 4 * colors);
  Bytes file = {'B', 'M', uint8_t(offset + 4), 0, 0, 0, 0, 0, 0, 0, offset, 0, 0, 0, 40};
  file.resize(offset);
  file[18] = uint8_t(32 / depth); // width
  file[22] = file[26] = 1;        // height, planes
  file[28] = depth;
  for (uint8_t i = 0; i < colors; ++i) file[54u + 4 * i] = uint8_t(10 * (i + 1)); // blue
  file.insert(file.end(), row.begin(), row.end());
  return file;
}

TEST(DecoderBitmaps, PixelsBeyondThePaletteAreRefused) {
  World world;
  const std::string refused =
      "BMP picture: a pixel is beyond the colours that are read of its palette";
  const Image picture = image(withPalette(8, 3, {0, 2, 1, 0}), world);
  EXPECT_EQ(picture.pixels, (Bytes{0, 0, 10, 0, 0, 30, 0, 0, 20, 0, 0, 10}));
  EXPECT_EQ(whyNot(withPalette(8, 3, {0, 2, 3, 0}), world), refused);
  EXPECT_EQ(whyNot(withPalette(4, 3, {0x01, 0x20, 0x02, 0x11}), world), "");
  EXPECT_EQ(whyNot(withPalette(4, 3, {0x01, 0x20, 0x03, 0x11}), world), refused);
  EXPECT_EQ(whyNot(withPalette(4, 3, {0x01, 0x30, 0x02, 0x11}), world), refused);
  EXPECT_EQ(whyNot(withPalette(1, 2, {255, 255, 0, 1}), world), "");
  EXPECT_EQ(whyNot(withPalette(1, 1, {0, 0, 0, 0}), world), "");
  EXPECT_EQ(whyNot(withPalette(1, 1, {0, 0, 0, 1}), world), refused);
}

TEST(DecoderBitmaps, MapsOfTgaBeginWithTheFirstColour) {
  World world;
  const Bytes file = {0, 1, 1, 0, 0, 2, 0, 24, 0, 0, 0, 0, 2,
                      0, 1, 0, 8, 0, 1, 2, 3,  4, 5, 6, 1, 0};
  EXPECT_EQ(image(file, world).pixels, (Bytes{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(whyNot(with(file, 3, 1, 2), world),
            "TGA picture: its colour map does not begin with colour 0, which is not read");
}

// The lowest bits of byte 17 say how many bits are alpha.
TEST(DecoderBitmaps, AlphaOfTgaThatNobodyWroteIsOpaque) {
  World world;
  const Bytes said = makeTga(2, 1, {.components = 4}), unsaid = with(said, 17, 0, 1);
  expectBytes(image(said, world), 2, 1, 4);
  expectBytes(image(unsaid, world), 2, 1, 4);
  const auto clear = [](const Bytes& file) { return with(with(file, 21, 0, 1), 25, 0, 1); };
  for (const size_t alpha : {3, 7}) {
    EXPECT_EQ(image(clear(said), world).pixels[alpha], 0);
    EXPECT_EQ(image(clear(unsaid), world).pixels[alpha], 255);
    EXPECT_NE(image(clear(unsaid), world).pixels[alpha - 1], 255);
  }
}

} // namespace
} // namespace xvrml::test
