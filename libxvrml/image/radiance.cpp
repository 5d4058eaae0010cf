// radiance.cpp: decodes Radiance (RGBE) and PFM pictures. RGBE: G. Ward, "Real Pixels", Graphics
// Gems II, with the run-length code of later Radiance files. Memory grows with the data in the
// file, not with the size in its header.
#include "xvrml/radiance.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "image/decoders.h"
#include "image/foreign.h"

namespace xvrml {

namespace {

using Bytes = std::span<const uint8_t>;

[[noreturn]] void refuse(const std::string& why) { throw std::runtime_error(why); }

bool startsWith(Bytes bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}
  std::string_view line() {
    const auto begin = bytes_.begin() + ptrdiff_t(at_),
               end = std::find(begin, bytes_.end(), uint8_t('\n'));
    if (end == bytes_.end() || end - begin > 4096) refuse("the header does not end");
    at_ += size_t(end - begin) + 1;
    return {reinterpret_cast<const char*>(&*begin), size_t(end - begin)};
  }
  uint8_t next() {
    if (at_ == bytes_.size()) refuse("it ends too early");
    return bytes_[at_++];
  }
  Bytes rest() const { return bytes_.subspan(at_); }

 private:
  Bytes bytes_;
  size_t at_ = 0;
};

// Removes a word from a line and returns it as a number.
template <class T> T number(std::string_view& line) {
  const auto space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!line.empty() && space(line.front())) line.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc()) refuse("the header cannot be read");
  line.remove_prefix(size_t(end - line.data()));
  return value;
}

RadianceImage decodePfm(Bytes bytes, const Limits& limits) {
  Reader in(bytes);
  in.line(); // skips the line "PF"
  std::string_view size = in.line(), order = in.line();
  RadianceImage image;
  const int64_t width = number<int64_t>(size), height = number<int64_t>(size);
  const double scale = number<double>(order);
  checkRadianceSize(width, height, limits);
  image.width = int(width);
  image.height = int(height);
  const size_t count = size_t(width) * size_t(height) * 3;
  if (in.rest().size() / 4 < count) refuse("it ends too early");
  image.rgb.resize(count);
  std::memcpy(image.rgb.data(), in.rest().data(), count * 4);
  if (scale > 0) // a positive scale means big-endian numbers
    for (float& v : image.rgb)
      v = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(v)));
  return image;
}

// Reads a row as four planes, one after the other.
void readRow(Reader& in, size_t width, std::vector<uint8_t>& row) {
  const uint8_t head[4] = {in.next(), in.next(), in.next(), in.next()};
  if (width < 8 || width > 32767 || head[0] != 2 || head[1] != 2 ||
      size_t(head[2] << 8 | head[3]) != width) { // not run-length coded
    for (size_t x = 0; x < width; x++)
      for (size_t c = 0; c < 4; c++) row[c * width + x] = x == 0 ? head[c] : in.next();
    return;
  }
  for (size_t c = 0; c < 4; c++)
    for (size_t x = 0; x < width;) {
      const uint8_t code = in.next();
      const size_t count = code > 128 ? code - 128u : code;
      if (count == 0 || x + count > width) refuse("a row is damaged");
      const uint8_t same = code > 128 ? in.next() : 0;
      for (size_t i = 0; i < count; i++) row[c * width + x++] = code > 128 ? same : in.next();
    }
}

RadianceImage decodeHdr(Bytes bytes, const Limits& limits) {
  Reader in(bytes);
  in.line(); // skips the line "#?RADIANCE"
  while (!in.line().empty()) {}
  std::string_view resolution = in.line();
  if (!resolution.starts_with("-Y ")) refuse("its rows do not run from the top left");
  resolution.remove_prefix(3);
  const int64_t height = number<int64_t>(resolution);
  if (!resolution.starts_with(" +X ")) refuse("its rows do not run from the top left");
  resolution.remove_prefix(4);
  const int64_t width = number<int64_t>(resolution);
  checkRadianceSize(width, height, limits);
  RadianceImage image;
  image.width = int(width);
  image.height = int(height);
  const size_t w = size_t(width);
  std::vector<uint8_t> row(4 * w);
  for (int64_t y = 0; y < height; y++) {
    readRow(in, w, row);
    for (size_t x = 0; x < w; x++)
      for (size_t c = 0; c < 3; c++)
        image.rgb.push_back(
            row[3 * w + x] ? float(std::ldexp(row[c * w + x] + 0.5, row[3 * w + x] - 136)) : 0.0f);
  }
  flipRows(image);
  return image;
}

} // namespace

void checkRadianceSize(int64_t width, int64_t height, const Limits& limits) {
  if (width < 1 || height < 1) refuse(fmt::format("a picture of {} x {} pixels", width, height));
  if (width > 65536 || height > 65536 ||
      uint64_t(width) * uint64_t(height) > limits.imagePixels / 4)
    throw TooManyPixels(fmt::format(
        "{} x {} pixels of radiance are beyond a quarter of the limit 'imagePixels' ({})", width,
        height, limits.imagePixels));
}

void flipRows(RadianceImage& image) {
  const ptrdiff_t row = ptrdiff_t(image.width) * 3;
  for (ptrdiff_t y = 0; y < image.height / 2; y++) {
    const auto top = image.rgb.begin() + y * row;
    std::swap_ranges(top, top + row, image.rgb.begin() + (image.height - 1 - y) * row);
  }
}

bool looksLikeRadiance(const uint8_t* bytes, size_t size) {
  const Bytes content(bytes, size);
  return startsWith(content, "#?") || startsWith(content, "PF\n") ||
         startsWith(content, "PF\r\n") || startsWith(content, "\x76\x2f\x31\x01");
}

RadianceImage decodeRadiance(Bytes content, const ImageRoom& room) {
  if (!looksLikeRadiance(content.data(), content.size()))
    refuse("is not a picture of radiance (OpenEXR, Radiance or colour PFM)");
  RadianceImage image = content[0] == '#'   ? decodeHdr(content, room.limits)
                        : content[0] == 'P' ? decodePfm(content, room.limits)
                                            : decodeExr(content, room);
  for (const float v : image.rgb)
    if (!(v >= 0) || v > 1e30f) refuse(fmt::format("holds {}, which is no radiance", v));
  return image;
}

RadianceImage decodeRadiance(const uint8_t* bytes, size_t size, const Limits& limits) {
  return decodeRadiance(Bytes(bytes, size), ImageRoom{limits});
}

RadianceImage readRadiance(const std::string& path, const Limits& limits) {
  const std::vector<uint8_t> bytes = readPictureFile(path, limits);
  return decodeRadiance(bytes.data(), bytes.size(), limits);
}

} // namespace xvrml
