// dds.cpp: decodes cube maps and volumes in DDS files (Microsoft, "Programming Guide for DDS"):
// uncompressed pixels of 8 to 32 bits, half and single floats, and the blocks BC1, BC2 and BC3
// (DXT1, DXT3, DXT5). Everything is compared with the length of the file before memory is taken.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "image/cube_faces.h"
#include "image/decoders.h"
#include "image/volume.h"

namespace xvrml {
namespace {

using Bytes = std::span<const uint8_t>;

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error("DDS picture: " + why);
}

uint32_t word(Bytes bytes, size_t at) {
  if (at + 4 > bytes.size()) refuse("the header does not end");
  return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 |
         uint32_t(bytes[at + 3]) << 24;
}

constexpr uint32_t fourCc(const char (&name)[5]) {
  return uint32_t(uint8_t(name[0])) | uint32_t(uint8_t(name[1])) << 8 |
         uint32_t(uint8_t(name[2])) << 16 | uint32_t(uint8_t(name[3])) << 24;
}

enum class Coding : uint8_t { masks, halves, floats, bc1, bc2, bc3 };

struct Format {
  Coding coding = Coding::masks;
  uint32_t bits = 0;     // bits of a pixel; 0 for blocks
  uint32_t mask[4] = {}; // red, green, blue, alpha
  int components = 3;    // components of the result, or of the file's floats
  bool isFloat() const { return coding == Coding::halves || coding == Coding::floats; }
  bool isBlocks() const { return coding >= Coding::bc1; }
};

struct Header {
  uint32_t width = 0, height = 0, depth = 1, levels = 1;
  bool cube = false; // with all faces
  Format format;
  size_t data = 128;
};

constexpr Format bytesOf(uint32_t red, uint32_t blue, uint32_t alpha) {
  return {Coding::masks, 32, {red, 0xff00, blue, alpha}, alpha ? 4 : 3};
}

// The formats of the extended header, by DXGI_FORMAT.
Format dxgiFormat(uint32_t number) {
  switch (number) {
  case 2: return {Coding::floats, 128, {}, 4};
  case 6: return {Coding::floats, 96, {}, 3};
  case 10: return {Coding::halves, 64, {}, 4};
  case 28:
  case 29: return bytesOf(0xff, 0xff0000, 0xff000000);
  case 71:
  case 72: return {Coding::bc1, 0, {}, 4};
  case 74:
  case 75: return {Coding::bc2, 0, {}, 4};
  case 77:
  case 78: return {Coding::bc3, 0, {}, 4};
  case 87:
  case 91: return bytesOf(0xff0000, 0xff, 0xff000000);
  case 88:
  case 93: return bytesOf(0xff0000, 0xff, 0);
  default: refuse(fmt::format("its pixels have DXGI format {}, which is not read", number));
  }
}

Format legacyFormat(Bytes bytes) {
  const uint32_t flags = word(bytes, 80), code = word(bytes, 84), bits = word(bytes, 88);
  if (flags & 4) {
    if (code == fourCc("DXT1")) return {Coding::bc1, 0, {}, 4};
    if (code == fourCc("DXT3")) return {Coding::bc2, 0, {}, 4};
    if (code == fourCc("DXT5")) return {Coding::bc3, 0, {}, 4};
    if (code == 113) return {Coding::halves, 64, {}, 4};  // D3DFMT_A16B16G16R16F
    if (code == 116) return {Coding::floats, 128, {}, 4}; // D3DFMT_A32B32G32R32F
    refuse(fmt::format("its pixels have the code {:#x}, which is not read", code));
  }
  Format format;
  format.bits = bits;
  if (bits != 8 && bits != 16 && bits != 24 && bits != 32)
    refuse(fmt::format("{} bits of a pixel are not read", bits));
  for (int c = 0; c < 3; ++c) format.mask[c] = word(bytes, size_t(92 + 4 * c));
  if (flags & 1) format.mask[3] = word(bytes, 104);
  const bool grey = flags & 0x20000;
  if (!grey && !(flags & 0x40)) refuse("its pixels have no colours");
  format.components = (grey ? 1 : 3) + (format.mask[3] ? 1 : 0);
  return format;
}

Header readHeader(Bytes bytes) {
  Header header;
  if (word(bytes, 4) != 124 || word(bytes, 76) != 32) refuse("the header is damaged");
  header.height = word(bytes, 12);
  header.width = word(bytes, 16);
  if (word(bytes, 8) & 0x20000) header.levels = std::max(1u, word(bytes, 28));
  if (header.levels > 32) refuse("it has too many levels of detail");
  header.cube = (word(bytes, 112) & 0xfe00) == 0xfe00;
  bool volume = word(bytes, 112) & 0x200000;
  if ((word(bytes, 80) & 4) && word(bytes, 84) == fourCc("DX10")) {
    header.data = 148;
    header.format = dxgiFormat(word(bytes, 128));
    header.cube = header.cube || (word(bytes, 136) & 4);
    volume = volume || word(bytes, 132) == 4;
    if (word(bytes, 140) > 1) refuse("it is a list of pictures");
  } else {
    header.format = legacyFormat(bytes);
  }
  if (volume) header.depth = word(bytes, 24);
  return header;
}

uint64_t bytesOfLevel(const Format& format, uint64_t width, uint64_t height) {
  if (!format.isBlocks()) return height * ((width * format.bits + 7) / 8);
  return ((width + 3) / 4) * ((height + 3) / 4) * (format.coding == Coding::bc1 ? 8 : 16);
}

// Returns the bits of a mask as a number of 0..255.
uint8_t channel(uint32_t pixel, uint32_t mask) {
  if (mask == 0) return 0;
  const uint64_t most = mask >> std::countr_zero(mask);
  return uint8_t(((uint64_t(pixel & mask) >> std::countr_zero(mask)) * 255 + most / 2) / most);
}

void decodeMasks(Bytes data, const Format& format, Image& image) {
  const size_t bytes = format.bits / 8, pixels = size_t(image.width) * size_t(image.height);
  const int colours = image.components >= 3 ? 3 : 1;
  for (size_t i = 0; i < pixels; ++i) {
    uint32_t pixel = 0;
    for (size_t b = 0; b < bytes; ++b) pixel |= uint32_t(data[i * bytes + b]) << (8 * b);
    for (int c = 0; c < colours; ++c) image.pixels.push_back(channel(pixel, format.mask[c]));
    if (image.components > colours) image.pixels.push_back(channel(pixel, format.mask[3]));
  }
}

// Writes the 16 pixels (RGBA) of a block of colours. opaque: BC2 and BC3, which have no transparent
// colour.
void colourBlock(const uint8_t* block, bool opaque, uint8_t (&pixels)[16][4]) {
  uint8_t palette[4][4];
  const uint32_t ends[2] = {uint32_t(block[0] | block[1] << 8), uint32_t(block[2] | block[3] << 8)};
  for (int e = 0; e < 2; ++e) {
    palette[e][0] = channel(ends[e], 0xf800);
    palette[e][1] = channel(ends[e], 0x07e0);
    palette[e][2] = channel(ends[e], 0x001f);
    palette[e][3] = 255;
  }
  const bool four = opaque || ends[0] > ends[1];
  for (int c = 0; c < 3; ++c) {
    const int a = palette[0][c], b = palette[1][c];
    palette[2][c] = uint8_t(four ? (2 * a + b + 1) / 3 : (a + b) / 2);
    palette[3][c] = uint8_t(four ? (a + 2 * b + 1) / 3 : 0);
  }
  palette[2][3] = 255;
  palette[3][3] = four ? 255 : 0;
  for (int i = 0; i < 16; ++i)
    std::memcpy(pixels[i], palette[block[4 + i / 4] >> (2 * (i % 4)) & 3], 4);
}

void alphaBlock(const uint8_t* block, Coding coding, uint8_t (&pixels)[16][4]) {
  if (coding == Coding::bc2) {
    for (int i = 0; i < 16; ++i) pixels[i][3] = uint8_t((block[i / 2] >> (4 * (i % 2)) & 15) * 17);
    return;
  }
  int palette[8] = {block[0], block[1], 0, 0, 0, 0, 0, 255};
  const int steps = block[0] > block[1] ? 7 : 5;
  for (int i = 1; i < steps; ++i)
    palette[1 + i] = ((steps - i) * palette[0] + i * palette[1] + steps / 2) / steps;
  uint64_t indices = 0;
  for (int b = 0; b < 6; ++b) indices |= uint64_t(block[2 + b]) << (8 * b);
  for (int i = 0; i < 16; ++i) pixels[i][3] = uint8_t(palette[indices >> (3 * i) & 7]);
}

void decodeBlocks(Bytes data, const Format& format, Image& image) {
  const size_t size = format.coding == Coding::bc1 ? 8 : 16;
  const size_t width = size_t(image.width), height = size_t(image.height);
  const size_t across = (width + 3) / 4, down = (height + 3) / 4;
  image.pixels.resize(width * height * 4);
  for (size_t by = 0; by < down; ++by)
    for (size_t bx = 0; bx < across; ++bx) {
      const uint8_t* block = data.data() + (by * across + bx) * size;
      uint8_t pixels[16][4];
      colourBlock(block + (size - 8), size == 16, pixels);
      if (size == 16) alphaBlock(block, format.coding, pixels);
      for (size_t i = 0; i < 16; ++i)
        if (const size_t x = 4 * bx + i % 4, y = 4 * by + i / 4; x < width && y < height)
          std::memcpy(&image.pixels[(y * width + x) * 4], pixels[i], 4);
    }
}

float half(uint32_t bits) {
  const int exponent = int(bits >> 10 & 31), mantissa = int(bits & 1023);
  const float sign = bits & 0x8000 ? -1.0f : 1.0f;
  if (exponent == 31) return NAN;
  return sign * (exponent == 0 ? std::ldexp(float(mantissa), -24)
                               : std::ldexp(float(1024 + mantissa), exponent - 25));
}

void decodeFloats(Bytes data, const Format& format, RadianceImage& image) {
  const size_t n = size_t(format.components), pixels = size_t(image.width) * size_t(image.height);
  const size_t bytes = format.bits / 8 / n;
  image.rgb.reserve(3 * pixels);
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < 3; ++c) {
      const uint8_t* from = data.data() + (i * n + c) * bytes;
      const uint32_t bits =
          bytes == 2 ? uint32_t(from[0] | from[1] << 8) : word(data, (i * n + c) * 4);
      const float value = bytes == 2 ? half(bits) : std::bit_cast<float>(bits);
      if (!(value >= 0 && value <= 1e30f)) refuse("a pixel is negative, too large or not finite");
      image.rgb.push_back(value);
    }
}

// Mirrors the rows, from left to right.
template <class Number> void mirror(std::vector<Number>& numbers, size_t side, size_t perPixel) {
  for (size_t y = 0; y < side; ++y)
    for (size_t x = 0; x < side / 2; ++x)
      std::swap_ranges(&numbers[(y * side + x) * perPixel],
                       &numbers[(y * side + x) * perPixel] + perPixel,
                       &numbers[(y * side + side - 1 - x) * perPixel]);
}

} // namespace

bool looksLikeDds(Bytes bytes) { return bytes.size() >= 4 && word(bytes, 0) == fourCc("DDS "); }

// The faces are those that a lookup in OpenGL and Direct3D finds in the directions of the world's
// axes (OpenGL 4.6, table 8.19). Such faces are seen from outside: the sides are mirrored, and top
// and bottom are the other way up.
CubePictures decodeDds(Bytes bytes, const ImageRoom& room) {
  constexpr CubeFace order[cubeFaces] = {CubeFace::right,  CubeFace::left, CubeFace::top,
                                         CubeFace::bottom, CubeFace::back, CubeFace::front};
  const Header header = readHeader(bytes);
  const Format& format = header.format;
  if (!header.cube) refuse("it is no cube map with six faces");
  if (header.width != header.height) refuse("the faces of a cube map are square");
  const uint64_t side = header.width;
  checkImageSize(side, 6 * side, uint64_t(format.isFloat() ? 12 : 4), 0, room, "DDS");
  if (format.isFloat()) checkRadianceSize(int64_t(side), int64_t(6 * side), room.limits);
  uint64_t faceBytes = 0;
  for (uint32_t level = 0; level < header.levels; ++level)
    faceBytes += bytesOfLevel(format, std::max<uint64_t>(1, side >> level),
                              std::max<uint64_t>(1, side >> level));
  if (header.data > bytes.size() || faceBytes * cubeFaces > bytes.size() - header.data)
    refuse("it ends too early");
  CubePictures pictures;
  if (format.isFloat())
    pictures.radiance.resize(cubeFaces);
  else
    pictures.images.resize(cubeFaces);
  for (size_t i = 0; i < cubeFaces; ++i) {
    const Bytes data = bytes.subspan(header.data + size_t(faceBytes) * i, size_t(faceBytes));
    const bool upright = order[i] != CubeFace::top && order[i] != CubeFace::bottom;
    // Rows are stored from the top and wanted from the bottom, but those of top and bottom are the
    // other way up.
    const auto turn = [&](auto& picture, auto& numbers, size_t perPixel) {
      if (!upright) return;
      flipRows(picture);
      mirror(numbers, size_t(side), perPixel);
    };
    if (format.isFloat()) {
      RadianceImage& face = pictures.radiance[size_t(order[i])];
      face.width = face.height = int(side);
      decodeFloats(data, format, face);
      turn(face, face.rgb, 3);
      continue;
    }
    Image& face = pictures.images[size_t(order[i])];
    face.width = face.height = int(side);
    face.components = format.components;
    if (format.isBlocks())
      decodeBlocks(data, format, face);
    else
      decodeMasks(data, format, face);
    turn(face, face.pixels, size_t(face.components));
  }
  return pictures;
}

// The first level of detail has all its slices before those of the next one.
Volume decodeDdsVolume(Bytes bytes, const ImageRoom& room) {
  const Header header = readHeader(bytes);
  const Format& format = header.format;
  if (header.cube) refuse("it is a cube map, not a volume");
  if (format.isFloat()) refuse("a volume of floats is not read");
  checkVolumeSize({header.width, header.height, header.depth}, uint64_t(format.components), 0, room,
                  "DDS picture");
  const uint64_t sliceBytes = bytesOfLevel(format, header.width, header.height);
  if (header.data > bytes.size() || sliceBytes * header.depth > bytes.size() - header.data)
    refuse("it ends too early");
  Volume volume{int(header.width), int(header.height), int(header.depth), format.components, {}};
  for (size_t i = 0; i < header.depth; ++i) {
    const Bytes data = bytes.subspan(header.data + size_t(sliceBytes) * i, size_t(sliceBytes));
    Image slice{volume.width, volume.height, volume.components, {}};
    if (format.isBlocks())
      decodeBlocks(data, format, slice);
    else
      decodeMasks(data, format, slice);
    flipRows(slice);
    volume.pixels.insert(volume.pixels.end(), slice.pixels.begin(), slice.pixels.end());
  }
  return volume;
}

} // namespace xvrml
