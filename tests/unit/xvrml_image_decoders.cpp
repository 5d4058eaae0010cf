// xvrml_image_decoders.cpp: Tests the decoders of PNG, JPEG and GIF against pictures made here.
// Damaged, truncated and oversized files end in an exception that says so.
#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image/image.h"
#include "unit/picture_files.h"

namespace xvrml::test {
namespace {

const Limits limits;

Image decode(const Bytes& bytes, const Limits& with = limits) {
  return decodeImage(bytes.data(), bytes.size(), with);
}

std::string refusal(const Bytes& bytes, const Limits& with = limits) {
  try {
    decode(bytes, with);
  } catch (const std::runtime_error& error) { return error.what(); }
  return "";
}

// Returns a component of a pixel with y counted from the top, as in the encoders; rows of images
// run from the bottom.
int pixel(const Image& image, int x, int yFromTop, int c) {
  return image
      .pixels[size_t(((image.height - 1 - yFromTop) * image.width + x) * image.components + c)];
}

uint16_t pattern(int x, int y, int c) { return uint16_t((x * 7 + y * 31 + c * 85) & 255); }

void expectPattern(const Image& image, int width, int height, int components, int tolerance = 0) {
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  ASSERT_EQ(image.components, components);
  ASSERT_EQ(image.pixels.size(), size_t(width * height * components));
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < components; c++)
        ASSERT_NEAR(pixel(image, x, y, c), pattern(x, y, c), tolerance)
            << x << " " << y << " " << c;
}

TEST(ImagePng, OneToFourComponents) {
  const int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                       PNG_COLOR_TYPE_RGB_ALPHA};
  for (int components = 1; components <= 4; components++)
    for (bool interlaced : {false, true})
      for (auto [width, height] : {std::pair{13, 9}, {1, 1}, {1, 20}, {20, 1}})
        expectPattern(
            decode(makePng(width, height, {types[components - 1], 8, interlaced}, pattern)), width,
            height, components);
}

TEST(ImagePng, SixteenBitsAreRounded) {
  Image image = decode(makePng(256, 1, {PNG_COLOR_TYPE_GRAY, 16}, [](int x, int, int) {
    return uint16_t(x * 257 + (x < 255 ? 100 : 0));
  }));
  for (int x = 0; x < 256; x++) EXPECT_EQ(pixel(image, x, 0, 0), x);
  image = decode(makePng(2, 1, {PNG_COLOR_TYPE_GRAY, 16},
                         [](int x, int, int) { return uint16_t(x ? 257 * 5 + 200 : 0); }));
  EXPECT_EQ(pixel(image, 1, 0, 0), 6);
}

TEST(ImagePng, FewBitsAndPalettesExpand) {
  for (int bits : {1, 2, 4}) {
    int most = (1 << bits) - 1;
    Image image = decode(makePng(most + 1, 2, {PNG_COLOR_TYPE_GRAY, bits},
                                 [](int x, int, int) { return uint16_t(x); }));
    ASSERT_EQ(image.components, 1);
    for (int x = 0; x <= most; x++) EXPECT_EQ(pixel(image, x, 1, 0), 255 * x / most);
    image = decode(makePng(most + 1, 2, {PNG_COLOR_TYPE_PALETTE, bits},
                           [](int x, int, int) { return uint16_t(x); }));
    ASSERT_EQ(image.components, 3);
    for (int x = 0; x <= most; x++) EXPECT_EQ(pixel(image, x, 0, 1), 2 * x);
  }
  Image image = decode(makePng(4, 1, {PNG_COLOR_TYPE_PALETTE, 8, false, {0, 128}},
                               [](int x, int, int) { return uint16_t(x); }));
  ASSERT_EQ(image.components, 4);
  EXPECT_EQ(pixel(image, 0, 0, 3), 0);
  EXPECT_EQ(pixel(image, 1, 0, 3), 128);
  EXPECT_EQ(pixel(image, 2, 0, 3), 255);
  image = decode(makePng(4, 1, {PNG_COLOR_TYPE_GRAY, 8, false, {}, 2},
                         [](int x, int, int) { return uint16_t(x); }));
  ASSERT_EQ(image.components, 2);
  EXPECT_EQ(pixel(image, 2, 0, 1), 0);
  EXPECT_EQ(pixel(image, 3, 0, 1), 255);
}

uint16_t smooth(int x, int y, int c) { return uint16_t(40 + 3 * x + 2 * y + 20 * c); }

TEST(ImageJpeg, GreyAndColour) {
  for (int components : {1, 3})
    for (bool progressive : {false, true}) {
      Image image = decode(makeJpeg(21, 17, components, progressive, smooth));
      ASSERT_EQ(image.components, components);
      ASSERT_EQ(image.width, 21);
      ASSERT_EQ(image.height, 17);
      for (int y = 0; y < 17; y++)
        for (int x = 0; x < 21; x++)
          for (int c = 0; c < components; c++)
            EXPECT_NEAR(pixel(image, x, y, c), smooth(x, y, c), 5);
    }
}

TEST(ImageJpeg, InksBecomeLight) {
  // Adobe writes CMYK inverted: 255 means no ink. Light is paper minus ink, minus black.
  Image image = decode(makeJpeg(16, 16, 4, false, [](int, int, int c) {
    return uint16_t(c == 0 ? 200 : c == 3 ? 128 : 255);
  }));
  ASSERT_EQ(image.components, 3);
  EXPECT_NEAR(pixel(image, 8, 8, 0), 200 * 128 / 255, 3);
  EXPECT_NEAR(pixel(image, 8, 8, 1), 128, 3);
}

uint16_t paletteIndex(int x, int y, int) { return uint16_t((x + 5 * y) & 63); }

TEST(ImageGif, PaletteInterlacedAndPlain) {
  for (bool interlaced : {false, true})
    for (bool own : {false, true})
      for (auto [width, height] : {std::pair{11, 19}, {1, 1}, {3, 2}}) {
        Image image =
            decode(makeGif(width, height, {{0, 0, 0, 0, interlaced, -1, own}}, paletteIndex));
        ASSERT_EQ(image.components, 3);
        ASSERT_EQ(image.width, width);
        ASSERT_EQ(image.height, height);
        for (int y = 0; y < height; y++)
          for (int x = 0; x < width; x++) {
            int i = paletteIndex(x, y, 0);
            EXPECT_EQ(pixel(image, x, y, 0), own ? 255 - i : i);
            EXPECT_EQ(pixel(image, x, y, 2), own ? 0 : 3 * i);
          }
      }
}

TEST(ImageGif, TransparentColourAndFirstFrameOnly) {
  Image image =
      decode(makeGif(8, 4, {{0, 0, 0, 0, false, 7}, {0, 0, 0, 0, false, 3}}, paletteIndex));
  ASSERT_EQ(image.components, 4);
  for (int x = 0; x < 8; x++) EXPECT_EQ(pixel(image, x, 0, 3), x == 7 ? 0 : 255);
  // A transparent colour that no pixel uses adds no alpha.
  EXPECT_EQ(decode(makeGif(4, 1, {{0, 0, 0, 0, false, 60}}, paletteIndex)).components, 3);
}

TEST(ImageGif, FrameSmallerThanTheScreen) {
  Image image = decode(makeGif(10, 8, {{3, 2, 4, 5}}, paletteIndex));
  ASSERT_EQ(image.components, 4);
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 10; x++) {
      bool inside = x >= 3 && x < 7 && y >= 2 && y < 7;
      EXPECT_EQ(pixel(image, x, y, 3), inside ? 255 : 0);
      if (inside) { EXPECT_EQ(pixel(image, x, y, 0), paletteIndex(x - 3, y - 2, 0)); }
    }
}

std::vector<std::pair<const char*, Bytes>> samples() {
  return {{"PNG", makePng(9, 7, {PNG_COLOR_TYPE_RGB_ALPHA}, pattern)},
          {"PNG", makePng(9, 7, {PNG_COLOR_TYPE_PALETTE, 4, true, {1, 2}},
                          [](int x, int, int) { return uint16_t(x & 15); })},
          {"JPEG", makeJpeg(20, 20, 3, false, smooth)},
          {"JPEG", makeJpeg(20, 20, 1, true, smooth)},
          {"GIF", makeGif(12, 9, {{0, 0, 0, 0, true, 7}}, paletteIndex)}};
}

// A file truncated anywhere gives the whole picture (if only trailing markers are missing) or an
// exception that names the format.
TEST(ImageDamage, CutAtEveryByte) {
  for (auto& [format, bytes] : samples()) {
    Image whole = decode(bytes);
    size_t refused = 0;
    for (size_t size = 0; size < bytes.size(); size++) {
      Bytes cut(bytes.begin(), bytes.begin() + ptrdiff_t(size));
      try {
        EXPECT_EQ(decode(cut), whole) << format << " of " << size << " bytes";
      } catch (const std::runtime_error& error) {
        refused++;
        if (size >= 8) {
          EXPECT_NE(std::string(error.what()).find(format), std::string::npos) << error.what();
        }
      }
    }
    EXPECT_GT(refused + 20, bytes.size()) << format;
  }
}

TEST(ImageDamage, AnyByteChanged) {
  std::mt19937 random(7);
  Limits small;
  small.imagePixels = 1 << 20;
  for (auto& [format, bytes] : samples())
    for (int round = 0; round < 1500; round++) {
      Bytes changed = bytes;
      for (unsigned n = 1 + random() % 3; n; n--)
        changed[random() % changed.size()] = uint8_t(random());
      try {
        Image image = decode(changed, small);
        EXPECT_EQ(image.pixels.size(),
                  size_t(image.width) * size_t(image.height) * size_t(image.components));
        EXPECT_TRUE(image.components >= 1 && image.components <= 4);
      } catch (const std::runtime_error& error) { EXPECT_STRNE(error.what(), ""); }
    }
}

TEST(ImageDamage, PixelLimitIsCheckedFirst) {
  Limits small;
  small.imagePixels = 100;
  for (auto& [format, bytes] : {std::pair{"PNG", makePng(11, 10, {PNG_COLOR_TYPE_RGB}, pattern)},
                                {"JPEG", makeJpeg(11, 10, 3, false, smooth)},
                                {"GIF", makeGif(11, 10, {{}}, paletteIndex)}}) {
    std::string text = refusal(bytes, small);
    EXPECT_NE(text.find("imagePixels"), std::string::npos) << text;
    EXPECT_NE(text.find("11 x 10"), std::string::npos) << text;
    small.imagePixels = 110;
    EXPECT_EQ(refusal(bytes, small), "");
    small.imagePixels = 100;
  }
  // A header of 65535 x 65535 without data.
  Bytes gif = makeGif(2, 2, {{}}, paletteIndex);
  gif[6] = gif[7] = gif[8] = gif[9] = 0xff;
  EXPECT_NE(refusal(gif).find("imagePixels"), std::string::npos);
}

// A file of less than 100 bytes that announces a large picture. The chunk's checksum is left out,
// because the decoder reads it later.
Bytes pngHeader(uint32_t width, uint32_t height, uint8_t depth, uint8_t type) {
  Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const auto chunk = [&](const char* name, const Bytes& content) {
    Bytes part(name, name + 4);
    part.insert(part.end(), content.begin(), content.end());
    const auto big = [&](uint32_t v) {
      for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(uint8_t(v >> shift));
    };
    big(uint32_t(content.size()));
    bytes.insert(bytes.end(), part.begin(), part.end());
    uint32_t sum = 0xffffffff; // ISO/IEC 15948 annex D
    for (const uint8_t byte : part) {
      sum ^= byte;
      for (int i = 0; i < 8; i++) sum = sum & 1 ? 0xedb88320 ^ (sum >> 1) : sum >> 1;
    }
    big(~sum);
  };
  Bytes header;
  for (const uint32_t v : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) header.push_back(uint8_t(v >> shift));
  header.insert(header.end(), {depth, type, 0, 0, 0});
  chunk("IHDR", header);
  chunk("IDAT", {0x78, 0x9c, 0x63, 0, 0, 0, 1, 0, 1});
  chunk("IEND", {});
  return bytes;
}

long maxMemory() { // peak memory of the process in kB
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(ImageDamage, HeadersCostNoMemory) {
  std::vector<Bytes> files;
  for (const uint32_t width : {0x7fffffffu, 1u << 28, 65536u, 16384u})
    for (const uint32_t height : {1u, 16384u})
      for (const uint8_t type : {uint8_t(0), uint8_t(2), uint8_t(6)})
        files.push_back(pngHeader(width, height, 16, type));
  // progressive: all coefficients are kept in memory
  Bytes jpeg = makeJpeg(16, 16, 3, true, smooth);
  for (size_t i = 0; i + 8 < jpeg.size(); i++)
    if (jpeg[i] == 0xff && jpeg[i + 1] == 0xc2) {
      jpeg[i + 5] = jpeg[i + 7] = 0x40;
      jpeg[i + 6] = jpeg[i + 8] = 0;
    }
  files.push_back(jpeg);
  Bytes gif = makeGif(2, 2, {{}}, paletteIndex); // a small picture on a large logical screen
  gif[7] = gif[9] = 0x40;
  files.push_back(gif);
  for (size_t i = 0; i < files.size(); i++) {
    const long before = maxMemory();
    EXPECT_NE(refusal(files[i]), "") << i;
    EXPECT_LT(maxMemory() - before, 32 << 10)
        << "kB more for file " << i << " of " << files[i].size() << " bytes";
  }
}

TEST(ImageDamage, RoomIsCheckedFirst) {
  const Bytes png = makePng(100, 100, {PNG_COLOR_TYPE_RGB}, pattern),
              jpeg = makeJpeg(100, 100, 3, true, smooth),
              gif = makeGif(100, 100, {{}}, paletteIndex);
  for (const Bytes* bytes : {&png, &jpeg, &gif}) {
    const auto with = [&](const ImageRoom& room) -> std::string {
      try {
        decodeImage(bytes->data(), bytes->size(), room);
      } catch (const std::runtime_error& error) { return error.what(); }
      return "";
    };
    EXPECT_EQ(with({limits, 40'000}), "");
    EXPECT_NE(with({limits, 29'999}).find("all pictures of a world"), std::string::npos)
        << with({limits, 29'999});
    Budget wide(1 << 20), narrow(29'999);
    EXPECT_EQ(with({limits, 40'000, &wide}), "");
    EXPECT_NE(with({limits, 40'000, &narrow}).find("worldBytes=29999"), std::string::npos);
  }
}

TEST(ImageDamage, OtherFilesAreNoPictures) {
  EXPECT_NE(refusal({}).find("empty"), std::string::npos);
  std::string world = "#VRML V2.0 utf8\nShape {}\n";
  EXPECT_NE(refusal(Bytes(world.begin(), world.end())).find("not a PNG, JPEG, GIF"),
            std::string::npos);
  EXPECT_NE(refusal(Bytes(1000, 0)), "");
}

TEST(ImageFiles, ContentCountsNotTheName) {
  auto path = std::filesystem::temp_directory_path() /
              ("xvrml_image_" + std::to_string(::getpid()) + ".gif");
  Bytes bytes = makePng(5, 4, {PNG_COLOR_TYPE_RGB}, pattern);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  expectPattern(readImage(path.string(), limits), 5, 4, 3);
  Limits small;
  small.fileBytes = 10;
  EXPECT_THROW(readImage(path.string(), small), std::runtime_error);
  std::filesystem::remove(path);
  try {
    readImage(path.string(), limits);
    ADD_FAILURE() << "the file is gone";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "No such file or directory");
  }
  EXPECT_THROW(readImage(std::filesystem::temp_directory_path().string(), limits),
               std::runtime_error);
  EXPECT_THROW(readImage("/dev/null", limits), std::runtime_error);
}

TEST(ImageFiles, APipeDoesNotWait) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("xvrml_pipe_" + std::to_string(::getpid()) + ".png");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  try {
    readImage(path.string(), limits);
    ADD_FAILURE() << "a pipe is no picture";
  } catch (const std::runtime_error& error) { EXPECT_STREQ(error.what(), "not a regular file"); }
  std::filesystem::remove(path);
}

} // namespace
} // namespace xvrml::test
