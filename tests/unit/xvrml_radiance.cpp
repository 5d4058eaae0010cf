// xvrml_radiance.cpp: HDR pictures used by worlds: PFM, Radiance and OpenEXR from bytes made here,
// and files that must be refused.
#include <gtest/gtest.h>
#include <zlib.h>

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
void append(Bytes& to, const std::string& more) { to.insert(to.end(), more.begin(), more.end()); }
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

enum { none, rle, zips, zip, piz };
struct Exr {
  int width = 8, height = 20, compression = none;
  uint32_t kind = 1; // 0: unsigned integers, 1: half, 2: float
  uint32_t flags = 0;
  bool grey = false, upwards = false;
  int x0 = -3, y0 = 7;
  std::string more = {}; // channels besides the colours, sorted after them
};

uint16_t halfOf(float v) { // exact for the values used here
  const auto bits = std::bit_cast<uint32_t>(v);
  return uint16_t(((bits >> 23) - 112) << 10 | ((bits >> 13) & 1023));
}

Bytes pack(const Bytes& plain, int compression) {
  if (compression == none) return plain;
  Bytes split, out;
  for (size_t i = 0; i < plain.size(); i += 2) split.push_back(plain[i]);
  for (size_t i = 1; i < plain.size(); i += 2) split.push_back(plain[i]);
  for (size_t i = split.size() - 1; i > 0; i--) split[i] = uint8_t(split[i] - split[i - 1] + 128);
  if (compression == rle) {
    for (size_t i = 0; i < split.size();) {
      size_t n = 1;
      while (i + n < split.size() && split[i + n] == split[i] && n < 128) n++;
      if (n > 2) {
        out.push_back(uint8_t(n - 1));
        out.push_back(split[i]);
      } else {
        out.push_back(uint8_t(-int(n)));
        out.insert(out.end(), split.begin() + ptrdiff_t(i), split.begin() + ptrdiff_t(i + n));
      }
      i += n;
    }
  } else {
    uLongf size = compressBound(uLong(split.size()));
    out.resize(size);
    compress(out.data(), &size, split.data(), uLong(split.size()));
    out.resize(size);
  }
  return out.size() < plain.size() ? out : plain;
}

void attribute(Bytes& out, const std::string& name, const std::string& type, const Bytes& value) {
  append(out, name + '\0' + type + '\0');
  word(out, uint32_t(value.size()));
  append(out, value);
}

Bytes makeExr(const Exr& e) {
  Bytes out, channels, window, blocks;
  word(out, 20000630);
  word(out, 2 | e.flags);
  const std::string names = (e.grey ? "Y" : "BGR") + e.more;
  for (const char name : names) {
    append(channels, std::string(1, name) + '\0');
    word(channels, e.kind);
    word(channels, 0);
    word(channels, 1);
    word(channels, 1);
  }
  channels.push_back(0);
  for (const int v : {e.x0, e.y0, e.x0 + e.width - 1, e.y0 + e.height - 1})
    word(window, uint32_t(v));
  attribute(out, "channels", "chlist", channels);
  attribute(out, "compression", "compression", {uint8_t(e.compression)});
  attribute(out, "dataWindow", "box2i", window);
  attribute(out, "lineOrder", "lineOrder", {uint8_t(e.upwards)});
  out.push_back(0);
  const int lines = e.compression == zip ? 16 : 1, count = (e.height + lines - 1) / lines;
  std::vector<Bytes> made;
  for (int b = 0; b < count; b++) {
    Bytes plain, block;
    for (int y = b * lines; y < std::min(e.height, (b + 1) * lines); y++)
      for (const char name : names)
        for (int x = 0; x < e.width; x++) {
          const float v = name == 'A' ? 99
                                      : valueAt(x, y,
                                                name == 'R'   ? 0
                                                : name == 'G' ? 1
                                                : name == 'Y' ? 0
                                                              : 2);
          if (e.kind == 1)
            word(plain, halfOf(v), 2);
          else
            word(plain, e.kind ? std::bit_cast<uint32_t>(v) : uint32_t(v));
        }
    const Bytes packed = pack(plain, e.compression);
    word(block, uint32_t(e.y0 + b * lines));
    word(block, uint32_t(packed.size()));
    append(block, packed);
    made.push_back(block);
  }
  std::vector<uint64_t> offsets(made.size());
  uint64_t at = out.size() + 8 * made.size();
  for (int i = 0; i < count; i++) {
    const size_t b = size_t(e.upwards ? count - 1 - i : i);
    offsets[b] = at;
    at += made[b].size();
    append(blocks, made[b]);
  }
  for (const uint64_t o : offsets) {
    word(out, uint32_t(o));
    word(out, uint32_t(o >> 32));
  }
  append(out, blocks);
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

TEST(Radiance, OpenExrOfEachCompressionAndType) {
  for (const int compression : {none, rle, zips, zip})
    for (const uint32_t kind : {1u, 2u})
      for (const bool upwards : {false, true}) {
        SCOPED_TRACE(std::to_string(compression) + " " + std::to_string(kind) + " " +
                     std::to_string(upwards));
        expectPattern(
            decode(makeExr({.compression = compression, .kind = kind, .upwards = upwards})), 8, 20);
        expectPattern(
            decode(makeExr({.width = 1, .height = 1, .compression = compression, .kind = kind})), 1,
            1);
      }
}

TEST(Radiance, OpenExrOfGreyAndOfMoreChannels) {
  const RadianceImage grey = decode(makeExr({.width = 3, .height = 2, .kind = 2, .grey = true}));
  for (int c = 0; c < 3; c++)
    EXPECT_EQ(grey.rgb[size_t(c)], valueAt(0, 1, 0)) << "bottom row first";
  expectPattern(decode(makeExr({.compression = zip, .more = "Z"})), 8, 20);
  const RadianceImage whole = decode(makeExr({.width = 2, .height = 1, .kind = 0}));
  EXPECT_EQ(whole.rgb[0], 1);
  EXPECT_EQ(whole.rgb[5], 128);
}

TEST(Radiance, WhatOurReaderLeavesOutIsNamed) {
  EXPECT_NE(whyNot(makeExr({.compression = piz})).find("PIZ"), std::string::npos);
  for (const uint32_t flag : {0x200u, 0x800u, 0x1000u}) // tiles, deep pixels, several parts
    EXPECT_NE(whyNot(makeExr({.flags = flag})).find("scan lines"), std::string::npos) << flag;
  EXPECT_EQ(whyNot(makeExr({.flags = 0x400})), "") << "long names";
}

TEST(Radiance, NumbersThatAreNoRadiance) {
  for (const float bad : {-1.0f, NAN, INFINITY, 1e31f}) {
    Bytes bytes = makePfm(2, 2, true);
    std::memcpy(bytes.data() + bytes.size() - 4, &bad, 4);
    EXPECT_NE(whyNot(bytes).find("no radiance"), std::string::npos) << bad;
  }
}

TEST(Radiance, AnEndThatComesTooEarlyIsRefusedEverywhere) {
  for (const Bytes& whole :
       {makePfm(3, 3, true), makeHdr(9, 3, true), makeExr({.height = 3, .compression = zips}),
        makeExr({.width = 3, .height = 3, .compression = rle})})
    for (size_t size = 0; size < whole.size(); size++)
      ASSERT_NE(whyNot({whole.begin(), whole.begin() + ptrdiff_t(size)}), "") << size;
}

// Run under sanitizers. Here: the result is a picture of the right size, or a message.
TEST(Radiance, ADamagedByteNeverLeadsAstray) {
  for (const Bytes& whole : {makeHdr(9, 3, true), makeExr({.height = 3, .compression = zip}),
                             makeExr({.width = 3, .height = 3, .compression = rle})})
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
  EXPECT_NE(whyNot(makeExr({}), 255).find("imagePixels"), std::string::npos);
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
