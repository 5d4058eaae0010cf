// foreign.cpp: recognises pictures of foreign formats, and checks what the other process says of
// them.
#include "image/foreign.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "decode/decoder.h"
#include "image/decoders.h"

namespace xvrml {

using namespace decoding;

namespace {

using Bytes = std::span<const uint8_t>;

constexpr ForeignFormat webp = {"WebP", "image/webp", Format::webp},
                        bmp = {"BMP", "image/bmp", Format::bitmap},
                        tga = {"TGA", "image/x-tga", Format::bitmap};

bool hasAt(Bytes bytes, size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() &&
         std::memcmp(bytes.data() + at, text.data(), text.size()) == 0;
}

// A TGA file has no magic number. The fields of its header of 18 bytes have few values each
// (Truevision TGA File Format Specification 2.0, C.2).
bool looksLikeTga(Bytes b) {
  if (b.size() < 18) return false;
  const int map = b[1], kind = b[2] & ~8, depth = b[16]; // kind without the bit for run lengths
  const bool oneOf = depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32;
  const bool plain = map == 0 && b[3] == 0 && b[4] == 0 && b[5] == 0 && b[6] == 0 && b[7] == 0;
  if (b[2] & ~11 || !oneOf || (b[12] | b[13]) == 0 || (b[14] | b[15]) == 0 || b[17] & 0xc0)
    return false;
  return kind == 1 ? map == 1 && depth == 8 : (kind == 2 || kind == 3) && (plain || map == 1);
}

// Decodes a picture. take: is called with what it holds and returns the bytes for its numbers.
template <class Number, class Take>
void decodePixels(Format format, const char* name, Bytes bytes, const ImageRoom& room,
                  std::vector<Number>& numbers, const Take& take) try {
  const uint64_t pixels = room.limits.imagePixels;
  const uint64_t most = std::min({room.bytes, room.budget ? room.budget->left() : ~uint64_t(0),
                                  pixels > ~uint64_t(0) / 4 ? ~uint64_t(0) : 4 * pixels});
  uint64_t wanted = 0;
  decoderOf(room.budget)
      ->decode(
          {format, bytes, most},
          [&](const Contents& contents) {
            if (contents.componentBytes != sizeof(Number))
              throw std::runtime_error("of a wrong kind");
            take(contents);
            wanted = contents.columns * contents.rows * contents.components * sizeof(Number);
            return true;
          },
          [&](std::span<const char> part) {
            const size_t at = numbers.size();
            if (part.size() % sizeof(Number) != 0) throw std::runtime_error("a number is cut");
            numbers.resize(at + part.size() / sizeof(Number));
            std::memcpy(numbers.data() + at, part.data(), part.size());
          });
  if (numbers.size() * sizeof(Number) != wanted) throw std::runtime_error("pixels are missing");
} catch (const TooManyPixels&) {
  throw; // callers tell it from damage
} catch (const std::runtime_error& error) {
  const std::string_view why = error.what();
  if (why.starts_with(name)) throw; // it names the format already
  throw std::runtime_error(fmt::format("{} picture: {}", name, why));
}

} // namespace

const ForeignFormat* foreignFormat(Bytes bytes) {
  if (hasAt(bytes, 0, "RIFF") && hasAt(bytes, 8, "WEBP")) return &webp;
  // Two letters are few: a BMP file also has zeros in its reserved bytes.
  if (hasAt(bytes, 0, "BM") && hasAt(bytes, 6, std::string_view("\0\0\0\0", 4))) return &bmp;
  return looksLikeTga(bytes) ? &tga : nullptr;
}

Image decodeForeign(const ForeignFormat& format, Bytes bytes, const ImageRoom& room) {
  Image image;
  decodePixels(format.format, format.name, bytes, room, image.pixels, [&](const Contents& found) {
    if (found.components < 1 || found.components > 4) throw std::runtime_error("of a wrong kind");
    checkImageSize(found.columns, found.rows, found.components, 0, room, format.name);
    image.width = int(found.columns);
    image.height = int(found.rows);
    image.components = int(found.components);
  });
  flipRows(image);
  return image;
}

RadianceImage decodeExr(Bytes bytes, const ImageRoom& room) {
  RadianceImage image;
  decodePixels(Format::exr, "OpenEXR", bytes, room, image.rgb, [&](const Contents& found) {
    if (found.components != 3) throw std::runtime_error("of a wrong kind");
    checkImageSize(found.columns, found.rows, 3 * sizeof(float), 0, room, "OpenEXR");
    checkRadianceSize(int64_t(found.columns), int64_t(found.rows), room.limits);
    image.width = int(found.columns);
    image.height = int(found.rows);
  });
  flipRows(image);
  return image;
}

} // namespace xvrml
