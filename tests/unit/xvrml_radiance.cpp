// xvrml_radiance.cpp: HDR pictures used by worlds: PFM and Radiance from bytes made here, and files
// that must be refused. OpenEXR is in xvrml_decoder.cpp.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "image/image.h"
#include "xvrml/radiance.h"

using namespace xvrml;

namespace {

using Bytes = std::vector<uint8_t>;

Bytes bytesOf(const std::string& text) { return {text.begin(), text.end()}; }
void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }
void word(Bytes& to, uint32_t v, int count = 4) {
  for (int i = 0; i < count; i++) to.push_back(uint8_t(v >> 8 * i));
}

RadianceImage decode(const Bytes& bytes, uint64_t imagePixels = 1 << 20) {
  Limits limits;
  limits.imagePixels = imagePixels;
  return decodeRadiance(bytes.data(), bytes.size(), limits);
}
std::string whyNot(const Bytes& bytes, uint64_t imagePixels = 1 << 20) {
  try {
    decode(bytes, imagePixels);
  } catch (const std::runtime_error& error) { return error.what(); }
  return "";
}

// Returns the value of a pixel of the test picture, x from the left and y from the top. It is exact
// as half and nearly exact as RGBE.
float valueAt(int x, int y, int c) {
  return float(1 + x + 8 * y) * (c == 0 ? 1.0f : c == 1 ? 0.5f : 64.0f);
}
void expectPattern(const RadianceImage& image, int width, int height, double tolerance = 0) {
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  ASSERT_EQ(image.rgb.size(), size_t(3 * width * height));
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) {
        const float expected = valueAt(x, y, c),
                    got = image.rgb[size_t(3 * ((height - 1 - y) * width + x) + c)];
        ASSERT_NEAR(got, expected, tolerance * 64 * expected) << x << " " << y << " " << c;
      }
}

Bytes makePfm(int width, int height, bool little) {
  Bytes out = bytesOf("PF\n" + std::to_string(width) + " " + std::to_string(height) +
                      (little ? "\n-1.0\n" : "\n1.0\n"));
  for (int y = height - 1; y >= 0; y--)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) {
        const auto bits = std::bit_cast<uint32_t>(valueAt(x, y, c));
        word(out, little ? bits : __builtin_bswap32(bits));
      }
  return out;
}

Bytes makeHdr(int width, int height, bool runs) {
  Bytes out = bytesOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) +
                      " +X " + std::to_string(width) + "\n");
  for (int y = 0; y < height; y++) {
    Bytes planes[4];
    for (int x = 0; x < width; x++) {
      int exponent;
      std::frexp(valueAt(x, y, 2), &exponent); // blue is the largest component
      for (int c = 0; c < 3; c++)
        planes[c].push_back(uint8_t(std::ldexp(valueAt(x, y, c), 8 - exponent)));
      planes[3].push_back(uint8_t(exponent + 128));
    }
    if (!runs) {
      for (int x = 0; x < width; x++)
        for (const Bytes& p : planes) out.push_back(p[size_t(x)]);
      continue;
    }
    append(out, Bytes{2, 2, uint8_t(width >> 8), uint8_t(width)});
    for (const Bytes& p : planes) {
      out.push_back(uint8_t(width - 2));
      out.insert(out.end(), p.begin(), p.end() - 2); // literal bytes
      out.push_back(130);
      out.push_back(p.back()); // a run of two
    }
  }
  return out;
}

TEST(Radiance, PfmOfEitherEnd) {
  expectPattern(decode(makePfm(5, 4, true)), 5, 4);
  expectPattern(decode(makePfm(5, 4, false)), 5, 4);
}

TEST(Radiance, RadianceFilesWithAndWithoutRuns) {
  expectPattern(decode(makeHdr(9, 3, true)), 9, 3, 0x1p-7);
  expectPattern(decode(makeHdr(9, 3, false)), 9, 3, 0x1p-7);
  expectPattern(decode(makeHdr(3, 2, false)), 3, 2, 0x1p-7);
}

TEST(Radiance, NumbersThatAreNoRadiance) {
  for (const float bad : {-1.0f, NAN, INFINITY, 1e31f}) {
    Bytes bytes = makePfm(2, 2, true);
    std::memcpy(bytes.data() + bytes.size() - 4, &bad, 4);
    EXPECT_NE(whyNot(bytes).find("no radiance"), std::string::npos) << bad;
  }
}

TEST(Radiance, AnEndThatComesTooEarlyIsRefusedEverywhere) {
  for (const Bytes& whole : {makePfm(3, 3, true), makeHdr(9, 3, true)})
    for (size_t size = 0; size < whole.size(); size++)
      ASSERT_NE(whyNot({whole.begin(), whole.begin() + ptrdiff_t(size)}), "") << size;
}

// Run under sanitizers. Here: the result is a picture of the right size, or a message.
TEST(Radiance, ADamagedByteNeverLeadsAstray) {
  const Bytes whole = makeHdr(9, 3, true);
  for (size_t at = 0; at < whole.size(); at++)
    for (const uint8_t value : {0, 1, 127, 128, 255}) {
      Bytes bytes = whole;
      bytes[at] = value;
      try {
        const RadianceImage image = decode(bytes);
        ASSERT_EQ(image.rgb.size(), size_t(image.width) * size_t(image.height) * 3);
      } catch (const std::runtime_error&) {}
    }
}

TEST(Radiance, SizesBeyondTheLimit) {
  EXPECT_NE(whyNot(makePfm(8, 8, true), 255).find("imagePixels"), std::string::npos);
  EXPECT_EQ(whyNot(makePfm(8, 8, true), 256), "");
  EXPECT_NE(whyNot(makeHdr(9, 9, true), 255).find("imagePixels"), std::string::npos);
  for (const std::string size : {"0 4", "-1 4", "4 99999999999999999999", "x 4", "65537 1"})
    EXPECT_NE(whyNot(bytesOf("PF\n" + size + "\n-1\n")), "") << size;
}

TEST(Radiance, FilesAreFoundByContent) {
  const auto path = std::filesystem::temp_directory_path() / "xvrml_radiance_test.png";
  const Bytes bytes = makePfm(3, 2, true);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  expectPattern(readRadiance(path.string()), 3, 2);
  EXPECT_THROW(readImage(path.string(), {}), std::runtime_error);
  std::filesystem::remove(path);
  EXPECT_THROW(readRadiance(path.string()), std::runtime_error);
  EXPECT_NE(whyNot(bytesOf("hello")), "");
}

} // namespace
