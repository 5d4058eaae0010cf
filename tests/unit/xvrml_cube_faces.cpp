// xvrml_cube_faces.cpp: cube maps from bytes made here: DDS in every format that is read, unfolded
// cubes, and files that must be refused.
#include <gtest/gtest.h>

#include <bit>

#include "image/cube_faces.h"

using namespace xvrml;

namespace {

using Bytes = std::vector<uint8_t>;

void word(Bytes& to, uint32_t v, int count = 4) {
  for (int i = 0; i < count; i++) to.push_back(uint8_t(v >> 8 * i));
}

// How a pixel is stored: flags, code, bits and masks of a DDS_PIXELFORMAT.
struct Pixels {
  uint32_t flags, code = 0, bits = 0, red = 0, green = 0, blue = 0, alpha = 0;
};
constexpr Pixels rgb{0x40, 0, 24, 0xff0000, 0xff00, 0xff}; // stored blue, green, red

Bytes header(uint32_t side, const Pixels& p, uint32_t levels = 0, uint32_t caps2 = 0xfe00) {
  Bytes b{'D', 'D', 'S', ' '};
  for (const uint32_t v : {124u, levels ? 0x21007u : 0x1007u, side, side, 0u, 0u, levels})
    word(b, v);
  b.resize(76);
  for (const uint32_t v : {32u, p.flags, p.code, p.bits, p.red, p.green, p.blue, p.alpha})
    word(b, v);
  for (const uint32_t v : {0x1008u, caps2, 0u, 0u, 0u}) word(b, v);
  return b;
}
CubePictures decode(const Bytes& bytes, uint64_t imagePixels = 1 << 20) {
  Limits limits;
  limits.imagePixels = imagePixels;
  return decodeCube(bytes, ImageRoom{limits});
}
std::string whyNot(const Bytes& bytes, uint64_t imagePixels = 1 << 20) {
  try {
    decode(bytes, imagePixels);
  } catch (const std::runtime_error& error) { return error.what(); }
  return "";
}
const Image& face(const CubePictures& cube, CubeFace which) { return cube.images[size_t(which)]; }
uint8_t red(const CubePictures& cube, CubeFace which, int x, int y) {
  const Image& image = face(cube, which);
  return image.pixels[size_t((y * image.width + x) * image.components)];
}

// The place of a direction on a face as OpenGL looks it up (4.6, table 8.19) is the place that a
// Background has there.
TEST(CubeFaces, FacesOfDdsLieWhereOpenGlFindsThem) {
  Bytes b = header(2, rgb);
  for (int f = 0; f < 6; f++) // row from the top, column from the left
    for (int y = 0; y < 2; y++)
      for (int x = 0; x < 2; x++) word(b, uint32_t(10 * f + 2 * y + x) << 16, 3);
  const CubePictures cube = decode(b);
  ASSERT_EQ(cube.images.size(), cubeFaces);
  ASSERT_EQ(face(cube, CubeFace::front).components, 3);
  // Direction +x +y +z (near +x): sc = -z, tc = -y: column 0, row 0 of face +x. A Background has +z
  // on the right of its right picture, and +y at the top, where y is 1.
  EXPECT_EQ(red(cube, CubeFace::right, 1, 1), 0);
  EXPECT_EQ(red(cube, CubeFace::right, 0, 0), 3);
  // -x, with +y +z: sc = z, tc = -y: column 1, row 0; +z is on the left of the left picture.
  EXPECT_EQ(red(cube, CubeFace::left, 0, 1), 11);
  // +y, with +x +z: sc = x, tc = z: column 1, row 1; +z is up in the top picture.
  EXPECT_EQ(red(cube, CubeFace::top, 1, 1), 23);
  // -y, with +x +z: sc = x, tc = -z: column 1, row 0; -z is up in the bottom picture.
  EXPECT_EQ(red(cube, CubeFace::bottom, 1, 0), 31);
  // +z, with +x +y: sc = x, tc = -y: column 1, row 0; +x is on the left of the back picture.
  EXPECT_EQ(red(cube, CubeFace::back, 0, 1), 41);
  // -z, with +x +y: sc = -x, tc = -y: column 0, row 0; +x is on the right of the front picture.
  EXPECT_EQ(red(cube, CubeFace::front, 1, 1), 50);
}

TEST(CubeFaces, LevelsOfDetailArePassedOver) {
  Bytes b = header(2, rgb, 2);
  for (uint32_t f = 0; f < 6; f++)
    for (int i = 0; i < 5; i++) word(b, (i < 4 ? f : 99u) << 16, 3);
  EXPECT_EQ(red(decode(b), CubeFace::front, 0, 0), 5);
}

TEST(CubeFaces, BlocksAreDecoded) {
  Bytes b = header(4, {4, 0x31545844}); // DXT1
  for (int f = 0; f < 6; f++) {
    word(b, 0xf800 | 0x001f << 16); // red and blue; the larger first: four colours
    word(b, 0xe4e4e4e4);            // columns: red, blue, 2/3 red, 1/3 red
  }
  const CubePictures one = decode(b);
  const int columns[] = {255, 0, 170, 85};
  for (int x = 0; x < 4; x++) EXPECT_EQ(red(one, CubeFace::top, x, 0), columns[x]);
  EXPECT_EQ(face(one, CubeFace::top).pixels[3], 255);
  b = header(4, {4, 0x35545844}); // DXT5
  for (int f = 0; f < 6; f++) {
    word(b, 255 | 0 << 8, 2); // alpha 255 and 0
    word(b, 0x249249);        // 1 1 1 ...
    word(b, 0x249249, 3);
    b.resize(b.size() - 1); // six bytes of indices
    word(b, 0xf800 | 0x001f << 16);
    word(b, 0);
  }
  const CubePictures five = decode(b);
  EXPECT_EQ(red(five, CubeFace::top, 2, 2), 255);
  EXPECT_EQ(face(five, CubeFace::top).pixels[3], 0);
}

TEST(CubeFaces, HalvesAndFloatsAreRadiance) {
  Bytes b = header(1, {4, 113});
  for (int i = 0; i < 6; i++)
    for (const uint32_t h : {0x4900u, 0x3800u, 0x0000u, 0x3c00u}) word(b, h, 2); // 10 .5 0 1
  CubePictures cube = decode(b);
  ASSERT_EQ(cube.radiance.size(), cubeFaces);
  EXPECT_EQ(cube.radiance[0].rgb, (std::vector<float>{10, 0.5f, 0}));
  b = header(1, {4, 116});
  for (int i = 0; i < 24; i++) word(b, 0x42c80000); // 100
  EXPECT_EQ(decode(b).radiance[5].rgb, (std::vector<float>{100, 100, 100}));
  b[128] = 0x00; // the first number becomes infinite
  b[129] = 0x00;
  b[130] = 0x80;
  b[131] = 0x7f;
  EXPECT_NE(whyNot(b).find("not finite"), std::string::npos);
}

// The extended header: DXGI_FORMAT, dimension, flags (4: a cube), number of cubes, alpha mode.
Bytes extended(uint32_t side, uint32_t format, uint32_t flags = 4, uint32_t cubes = 1,
               uint32_t caps2 = 0) {
  Bytes b = header(side, {4, 0x30315844}, 0, caps2); // DX10
  for (const uint32_t v : {format, 3u, flags, cubes, 0u}) word(b, v);
  return b;
}

TEST(CubeFaces, ExtendedHeadersAreRead) {
  for (const uint32_t format : {28u, 29u, 87u, 91u, 88u, 93u}) { // RGBA, BGRA, BGRX; also sRGB
    SCOPED_TRACE(format);
    Bytes b = extended(1, format);
    for (int f = 0; f < 6; f++) word(b, format < 80 ? 0x40302010u : 0x40102030u);
    const CubePictures cube = decode(b);
    ASSERT_EQ(cube.images.size(), cubeFaces);
    const Image& image = face(cube, CubeFace::back);
    EXPECT_EQ(image.components, format == 88 || format == 93 ? 3 : 4);
    const std::vector<uint8_t> rgba{0x10, 0x20, 0x30, 0x40};
    EXPECT_EQ(image.pixels, std::vector<uint8_t>(rgba.begin(), rgba.begin() + image.components));
  }
  for (const auto& [format, numbers] : {std::pair{2u, 4}, {6u, 3}}) { // floats
    Bytes b = extended(1, format);
    for (int i = 0; i < 6 * numbers; i++) word(b, 0x42c80000); // 100
    EXPECT_EQ(decode(b).radiance.at(5).rgb, (std::vector<float>{100, 100, 100})) << format;
  }
  Bytes halves = extended(1, 10);
  for (int i = 0; i < 24; i++) word(halves, 0x3800, 2);
  EXPECT_EQ(decode(halves).radiance.at(0).rgb, (std::vector<float>{.5f, .5f, .5f}));
  for (const auto& [format, bytes] :
       {std::pair{71u, 8}, {72u, 8}, {74u, 16}, {75u, 16}, {77u, 16}, {78u, 16}}) { // BC1 to BC3
    Bytes b = extended(3, format);
    for (int f = 0; f < 6; f++) {
      for (int i = 8; i < bytes; i++) b.push_back(0xff); // the alpha
      word(b, 0xf800 | 0x001f << 16);
      word(b, 0);
    }
    const CubePictures cube = decode(b);
    EXPECT_EQ(red(cube, CubeFace::left, 2, 2), 255) << format;
    EXPECT_EQ(face(cube, CubeFace::left).pixels.size(), 36u) << format;
  }
  Bytes old = extended(1, 28, 0, 1, 0xfe00); // only the old part says that it is a cube
  for (int f = 0; f < 6; f++) word(old, 0);
  EXPECT_EQ(whyNot(old), "");
}

TEST(CubeFaces, DamagedExtendedHeadersAreRefused) {
  Bytes b = extended(2, 28);
  const size_t whole = b.size() + 96;
  b.resize(whole);
  EXPECT_EQ(whyNot(b), "");
  for (size_t size = 4; size < whole; size++)
    EXPECT_NE(whyNot(Bytes(b.begin(), b.begin() + ptrdiff_t(size))), "") << size;
  for (const uint32_t format : {0u, 1u, 98u, 1000u, ~0u}) {
    Bytes other = extended(2, format);
    other.resize(whole);
    EXPECT_NE(whyNot(other).find("DXGI format"), std::string::npos) << format;
  }
  for (const uint32_t cubes : {2u, ~0u}) {
    Bytes list = extended(2, 28, 4, cubes);
    list.resize(6 * whole);
    EXPECT_NE(whyNot(list).find("list"), std::string::npos) << cubes;
  }
  Bytes flat = extended(2, 28, 0);
  flat.resize(whole);
  EXPECT_NE(whyNot(flat).find("six faces"), std::string::npos);
  EXPECT_NE(whyNot(extended(~0u, 71)), "");
  EXPECT_NE(whyNot(extended(0, 71)), "");
  EXPECT_NE(whyNot(b, 10), "");
}

TEST(CubeFaces, DamagedFilesAreRefused) {
  Bytes b = header(2, rgb);
  b.resize(128 + 72);
  EXPECT_EQ(whyNot(b), "");
  for (size_t size = 4; size < b.size(); size++)
    EXPECT_NE(whyNot(Bytes(b.begin(), b.begin() + ptrdiff_t(size))), "") << size;
  EXPECT_NE(whyNot(header(2, rgb, 0, 0x200)).find("six faces"), std::string::npos);
  EXPECT_NE(whyNot(header(0, rgb)), "");
  EXPECT_NE(whyNot(header(~0u, rgb)), "");
  EXPECT_NE(whyNot(header(60000, rgb, ~0u)), "");
  EXPECT_NE(whyNot(header(2, {0x40, 0, 17})), "");
  EXPECT_NE(whyNot(header(2, {4, 0x12345678})), "");
  EXPECT_NE(whyNot(b, 10), "") << "the limit 'imagePixels'";
}

TEST(CubeFaces, CrossesAreCut) {
  const auto pfm = [](int width, int height) {
    const std::string head =
        "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    Bytes b(head.begin(), head.end());
    for (int y = 0; y < height; y++) // PFM has its rows from the bottom up
      for (int x = 0; x < width; x++)
        for (int c = 0; c < 3; c++) {
          const float value = float(10 * (height - 1 - y) + x); // row from the top
          word(b, std::bit_cast<uint32_t>(value));
        }
    return b;
  };
  const auto values = [](const CubePictures& cube) {
    std::vector<float> all;
    for (const RadianceImage& image : cube.radiance) all.push_back(image.rgb[0]);
    return all;
  };
  // In the order front, back, left, right, top, bottom.
  EXPECT_EQ(values(decode(pfm(4, 3))), (std::vector<float>{11, 13, 10, 12, 1, 21}));
  EXPECT_EQ(values(decode(pfm(3, 4))), (std::vector<float>{11, 31, 10, 12, 1, 21}));
  const CubePictures turned = decode(pfm(6, 8));
  EXPECT_EQ(turned.radiance[1].rgb[0], 63) << "the back is upside down";
  EXPECT_EQ(decode(pfm(4, 2)).radiance.size(), 1u) << "the whole sphere";
}

} // namespace
