// exr.cpp: decodes simple OpenEXR pictures: one part of scan lines, uncompressed, run-length coded
// or deflated. OpenEXR's own library reads the whole format. But it has a long list of
// vulnerabilities, and distributions have old copies, so untrusted files are not passed to it
// (docs/decisions/0038). The format: "OpenEXR File Layout", openexr.com. [any thread]
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "image/decoders.h"

namespace xvrml {

namespace {

using Bytes = std::span<const uint8_t>;

constexpr size_t maxChannels = 64, maxBlockBytes = size_t(64) << 20;

[[noreturn]] void refuse(const std::string& why) { throw std::runtime_error("OpenEXR: " + why); }

class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}
  Bytes take(size_t count) {
    if (count > bytes_.size() - at_) refuse("the file ends too early");
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }
  uint8_t byte() { return take(1)[0]; }
  uint32_t word() {
    const Bytes b = take(4);
    return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
  }
  int32_t integer() { return int32_t(word()); }
  uint64_t offset() {
    const uint64_t low = word();
    return low | uint64_t(word()) << 32;
  }
  std::string_view text() { // text that ends with a zero byte
    const auto begin = bytes_.begin() + ptrdiff_t(at_),
               end = std::find(begin, bytes_.end(), uint8_t(0));
    if (end == bytes_.end() || end - begin > 255) refuse("a name in the header does not end");
    const Bytes found = take(size_t(end - begin) + 1);
    return {reinterpret_cast<const char*>(found.data()), found.size() - 1};
  }
  size_t left() const { return bytes_.size() - at_; }

 private:
  Bytes bytes_;
  size_t at_ = 0;
};

enum class Samples : uint32_t { whole = 0, half = 1, single = 2 };
enum class Compression : uint8_t { none = 0, runs = 1, deflatedLine = 2, deflated = 3 };

struct Channel {
  Samples samples;
  int colour; // 0 red, 1 green, 2 blue, 3 all three, -1 not a colour
  size_t bytes() const { return samples == Samples::half ? 2 : 4; }
};

struct Header {
  std::vector<Channel> channels;
  Compression compression = Compression::none;
  int64_t x0 = 0, y0 = 0, width = 0, height = 0;
};

std::vector<Channel> readChannels(Reader in) {
  std::vector<Channel> channels;
  while (true) {
    const std::string_view name = in.text();
    if (name.empty()) break;
    const uint32_t kind = in.word();
    in.take(4); // skips a flag for perceptual linearity, and reserved bytes
    const int32_t across = in.integer(), down = in.integer();
    if (kind > 2) refuse("a channel of an unknown type");
    if (across != 1 || down != 1) refuse("a channel with fewer samples than pixels");
    if (channels.size() == maxChannels) refuse(fmt::format("more than {} channels", maxChannels));
    const int colour = name == "R" ? 0 : name == "G" ? 1 : name == "B" ? 2 : name == "Y" ? 3 : -1;
    channels.push_back({Samples(kind), colour});
  }
  return channels;
}

Compression readCompression(uint8_t number) {
  static constexpr const char* names[] = {"NONE",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                          "PXR24", "B44", "B44A", "DWAA", "DWAB"};
  if (number > 3)
    refuse(fmt::format("compressed by {}; worlds read NONE, RLE, ZIPS and ZIP (convert it, or give "
                       "it with --environment)",
                       number < std::size(names) ? names[number] : "an unknown method"));
  return Compression(number);
}

Header readHeader(Reader& in) {
  in.take(4); // skips the magic number
  const uint32_t version = in.word();
  if ((version & 0xff) != 2 || (version & ~0x4ffu))
    refuse("has tiles, several parts or deep pixels; worlds read plain scan lines");
  Header header;
  bool compression = false, window = false;
  while (true) {
    const std::string_view name = in.text();
    if (name.empty()) break;
    in.text(); // skips the name of the type
    const int32_t size = in.integer();
    if (size < 0) refuse("an attribute of a negative size");
    Reader value(in.take(size_t(size)));
    if (name == "channels") header.channels = readChannels(value);
    if (name == "compression") {
      header.compression = readCompression(value.byte());
      compression = true;
    }
    if (name == "dataWindow") {
      header.x0 = value.integer();
      header.y0 = value.integer();
      header.width = value.integer() - header.x0 + 1;
      header.height = value.integer() - header.y0 + 1;
      window = true;
    }
  }
  if (!compression || !window) refuse("the header lacks the compression or the data window");
  bool colours[3] = {};
  for (const Channel& c : header.channels)
    for (int k = 0; k < 3; k++) colours[k] |= c.colour == k || c.colour == 3;
  if (!colours[0] || !colours[1] || !colours[2])
    refuse("there are no channels R, G and B and none Y");
  return header;
}

std::vector<uint8_t> expandRuns(Bytes packed, size_t size) {
  std::vector<uint8_t> out;
  out.reserve(size);
  Reader in(packed);
  while (in.left() > 0) {
    const int count = static_cast<int8_t>(in.byte());
    const size_t length = size_t(count < 0 ? -count : count + 1);
    if (out.size() + length > size) refuse("a line is damaged");
    if (count < 0) {
      const Bytes plain = in.take(length);
      out.insert(out.end(), plain.begin(), plain.end());
    } else {
      out.insert(out.end(), length, in.byte());
    }
  }
  return out;
}

// Returns the decompressed lines of a block.
std::vector<uint8_t> unpack(Bytes packed, size_t size, Compression compression) {
  std::vector<uint8_t> bytes;
  // A block is stored uncompressed if compression would not make it smaller.
  if (packed.size() == size || compression == Compression::none) {
    bytes.assign(packed.begin(), packed.end());
  } else if (compression == Compression::runs) {
    bytes = expandRuns(packed, size);
  } else {
    bytes.resize(size);
    uLongf written = uLongf(size);
    if (uncompress(bytes.data(), &written, packed.data(), uLong(packed.size())) != Z_OK)
      refuse("a block cannot be inflated");
    bytes.resize(written);
  }
  if (bytes.size() != size) refuse("a block of a wrong size");
  if (packed.size() == size || compression == Compression::none) return bytes;
  // Bytes are stored as differences.
  for (size_t i = 1; i < size; i++) bytes[i] = uint8_t(bytes[i - 1] + bytes[i] - 128);
  std::vector<uint8_t> interleaved(size); // the even bytes come first, then the odd ones
  for (size_t i = 0; i < size; i++) interleaved[i] = bytes[i % 2 ? (size + 1) / 2 + i / 2 : i / 2];
  return interleaved;
}

// Converts IEEE 754 binary16.
float halfToFloat(uint16_t h) {
  const uint32_t sign = uint32_t(h & 0x8000) << 16, exponent = (h >> 10) & 31, fraction = h & 1023;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000 | fraction << 13);
  if (exponent == 0) return (sign ? -1 : 1) * float(fraction) * 0x1p-24f;
  return std::bit_cast<float>(sign | (exponent + 112) << 23 | fraction << 13);
}

float sampleAt(const uint8_t* p, Samples kind) {
  if (kind == Samples::half) return halfToFloat(uint16_t(p[0] | p[1] << 8));
  const uint32_t bits =
      uint32_t(p[0]) | uint32_t(p[1]) << 8 | uint32_t(p[2]) << 16 | uint32_t(p[3]) << 24;
  return kind == Samples::single ? std::bit_cast<float>(bits) : float(bits);
}

} // namespace

RadianceImage decodeExr(std::span<const uint8_t> bytes, const Limits& limits) {
  Reader in(bytes);
  const Header header = readHeader(in);
  checkRadianceSize(header.width, header.height, limits);
  const size_t width = size_t(header.width), height = size_t(header.height);
  const size_t lines = header.compression == Compression::deflated ? 16 : 1;
  size_t lineBytes = 0;
  for (const Channel& c : header.channels) lineBytes += c.bytes() * width;
  if (lineBytes * lines > maxBlockBytes) refuse("blocks of lines that are too large");
  RadianceImage image;
  image.width = int(width);
  image.height = int(height);
  const size_t blocks = (height + lines - 1) / lines;
  std::vector<uint64_t> offsets;
  // Not more than the file contains.
  for (size_t b = 0; b < blocks; b++) offsets.push_back(in.offset());
  // Blocks may lie in any order; the table lists them from the top.
  for (size_t b = 0; b < blocks; b++) {
    if (offsets[b] > bytes.size()) refuse("a block beyond the end of the file");
    Reader block(bytes.subspan(size_t(offsets[b])));
    const size_t first = b * lines, count = std::min(lines, height - first),
                 size = lineBytes * count;
    if (int64_t(block.integer()) != header.y0 + int64_t(first))
      refuse("a block of lines that is not where it should be");
    const int32_t packed = block.integer();
    if (packed < 0 || size_t(packed) > size) refuse("a block of a wrong size");
    const std::vector<uint8_t> plain = unpack(block.take(size_t(packed)), size, header.compression);
    image.rgb.resize(image.rgb.size() + count * width * 3);
    const uint8_t* from = plain.data();
    for (size_t y = first; y < first + count; y++)
      for (const Channel& c : header.channels) {
        float* const row = image.rgb.data() + y * width * 3;
        for (size_t x = 0; x < width; x++, from += c.bytes())
          for (int k = 0; k < 3; k++)
            if (c.colour == k || c.colour == 3) row[3 * x + size_t(k)] = sampleAt(from, c.samples);
      }
  }
  flipRows(image);
  return image;
}

} // namespace xvrml
