// nrrd.cpp: decodes volumes in NRRD files. A header of lines "field: value" ends with an empty
// line; the numbers follow, the first axis fastest. Nothing is allocated by the header alone:
// packed numbers grow with what is unpacked.
#include <fast_float/fast_float.h>
#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "image/decoders.h"
#include "image/volume.h"

namespace xvrml {
namespace {

using Bytes = std::span<const uint8_t>;

[[noreturn]] void refuse(const std::string& why) { throw std::runtime_error("NRRD file: " + why); }

enum class Number : uint8_t { none, u8, i8, u16, i16, u32, i32, f32, f64 };
constexpr size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8}; // bytes of a Number

struct Name {
  std::string_view name;
  Number number;
};
constexpr Name names[] = {{"uchar", Number::u8},
                          {"unsigned char", Number::u8},
                          {"uint8", Number::u8},
                          {"uint8_t", Number::u8},
                          {"signed char", Number::i8},
                          {"int8", Number::i8},
                          {"int8_t", Number::i8},
                          {"ushort", Number::u16},
                          {"unsigned short", Number::u16},
                          {"unsigned short int", Number::u16},
                          {"uint16", Number::u16},
                          {"uint16_t", Number::u16},
                          {"short", Number::i16},
                          {"short int", Number::i16},
                          {"signed short", Number::i16},
                          {"signed short int", Number::i16},
                          {"int16", Number::i16},
                          {"int16_t", Number::i16},
                          {"uint", Number::u32},
                          {"unsigned int", Number::u32},
                          {"uint32", Number::u32},
                          {"uint32_t", Number::u32},
                          {"int", Number::i32},
                          {"signed int", Number::i32},
                          {"int32", Number::i32},
                          {"int32_t", Number::i32},
                          {"float", Number::f32},
                          {"double", Number::f64}};

enum class Encoding : uint8_t { none, raw, text, gzip };

struct Header {
  Number number = Number::none;
  Encoding encoding = Encoding::none;
  bool bigEndian = false;
  uint64_t axes[4] = {1, 1, 1, 1}; // components, width, height, depth
  uint64_t values() const { return axes[0] * axes[1] * axes[2] * axes[3]; }
  size_t data = 0; // where the numbers begin
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view spaces = " \t\r";
  const size_t first = text.find_first_not_of(spaces);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(spaces) - first + 1);
}

// Takes the next word of a text.
std::string_view takeWord(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(" \t"));
  text.remove_prefix(word.size());
  return word;
}

void readSizes(std::string_view value, Header& header) {
  std::array<uint64_t, 4> sizes{};
  size_t count = 0;
  for (std::string_view word; !(word = takeWord(value)).empty(); ++count) {
    if (count == sizes.size()) refuse("it has more than four axes");
    const auto read = std::from_chars(word.data(), word.data() + word.size(), sizes[count]);
    if (read.ec != std::errc() || read.ptr != word.data() + word.size())
      refuse(fmt::format("sizes has \"{}\", expected a number", word.substr(0, 40)));
  }
  if (count < 3) refuse(fmt::format("it has {} axes, expected three or four", count));
  if (count == 4 && (sizes[0] < 1 || sizes[0] > 4))
    refuse(
        fmt::format("the first of four axes has {} numbers, expected 1 to 4 components", sizes[0]));
  for (size_t i = 0; i < count; ++i) header.axes[4 - count + i] = sizes[i];
}

void readField(std::string_view field, std::string_view value, Header& header) {
  if (field == "sizes") return readSizes(value, header);
  if (field == "endian") {
    if (value != "big" && value != "little") refuse("endian is neither big nor little");
    header.bigEndian = value == "big";
  } else if (field == "type") {
    for (const Name& known : names)
      if (known.name == value) header.number = known.number;
    if (header.number == Number::none)
      refuse(fmt::format("numbers of the type \"{}\" are not read", value.substr(0, 40)));
  } else if (field == "encoding") {
    header.encoding = value == "raw"                                          ? Encoding::raw
                      : value == "gzip" || value == "gz"                      ? Encoding::gzip
                      : value == "ascii" || value == "text" || value == "txt" ? Encoding::text
                                                                              : Encoding::none;
    if (header.encoding == Encoding::none)
      refuse(fmt::format("the encoding \"{}\" is not read, expected raw, gzip or ascii",
                         value.substr(0, 40)));
  } else if (field == "data file" || field == "datafile") {
    refuse("its numbers are in another file, which is not read");
  } else if ((field == "line skip" || field == "lineskip" || field == "byte skip" ||
              field == "byteskip") &&
             value != "0") {
    refuse("numbers that begin after bytes to skip are not read");
  }
}

Header readHeader(std::string_view text) {
  Header header;
  bool sized = false;
  for (size_t at = text.find('\n');;) {
    if (at == text.npos) refuse("the header does not end");
    const size_t begin = at + 1;
    at = text.find('\n', begin);
    const std::string_view line = trimmed(text.substr(begin, std::min(at, text.size()) - begin));
    if (line.empty() && at != text.npos) {
      header.data = at + 1;
      break;
    }
    const size_t colon = line.find(": ");
    if (line.starts_with('#') || colon == line.npos) continue;
    const std::string_view field = trimmed(line.substr(0, colon));
    sized |= field == "sizes";
    readField(field, trimmed(line.substr(colon + 2)), header);
  }
  if (!sized || header.number == Number::none || header.encoding == Encoding::none)
    refuse("the header lacks type, sizes or encoding");
  return header;
}

// Unpacks the bytes that the numbers take. They may be packed in several members (RFC 1952, 2.2).
std::vector<uint8_t> unpacked(Bytes packed, uint64_t wanted) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 32) != Z_OK) refuse("no memory to unpack it");
  struct End {
    z_stream* stream;
    ~End() { inflateEnd(stream); }
  } end{&stream};
  std::vector<uint8_t> bytes;
  std::array<uint8_t, 1 << 16> part;
  stream.next_in = const_cast<uint8_t*>(packed.data());
  stream.avail_in = uInt(std::min<size_t>(packed.size(), 1u << 30));
  for (int status = Z_OK; bytes.size() < wanted;) {
    if (status == Z_STREAM_END && (stream.avail_in == 0 || inflateReset(&stream) != Z_OK))
      refuse("it ends too early");
    stream.next_out = part.data();
    stream.avail_out = uInt(part.size());
    status = inflate(&stream, Z_NO_FLUSH);
    const size_t made = part.size() - stream.avail_out;
    if ((status != Z_OK && status != Z_STREAM_END) || (made == 0 && status == Z_OK))
      refuse(status == Z_BUF_ERROR ? "it ends too early" : "the packed numbers are damaged");
    bytes.insert(bytes.end(), part.begin(), part.begin() + std::ptrdiff_t(made));
  }
  return bytes;
}

double valueAt(const uint8_t* at, const Header& header) {
  const size_t size = sizes[size_t(header.number)];
  uint64_t bits = 0;
  for (size_t b = 0; b < size; ++b)
    bits |= uint64_t(at[header.bigEndian ? size - 1 - b : b]) << (8 * b);
  switch (header.number) {
  case Number::i8: return int8_t(bits);
  case Number::i16: return int16_t(bits);
  case Number::i32: return int32_t(bits);
  case Number::f32: return double(std::bit_cast<float>(uint32_t(bits)));
  case Number::f64: return std::bit_cast<double>(bits);
  default: return double(bits);
  }
}

std::vector<double> textNumbers(std::string_view text, uint64_t wanted) {
  std::vector<double> values;
  for (const char *at = text.data(), *end = at + text.size(); values.size() < wanted;) {
    while (at < end && std::strchr(" \t\r\n,", *at) && *at != 0) ++at;
    double value = 0;
    const auto read = fast_float::from_chars(at, end, value);
    if (read.ec != std::errc())
      refuse(fmt::format("it has {} numbers, expected {}", values.size(), wanted));
    values.push_back(value);
    at = read.ptr;
  }
  return values;
}

// Converts numbers to bytes: colours as they are, others by their range.
template <class At>
void convert(uint64_t count, bool colors, const At& at, std::vector<uint8_t>& pixels) {
  double low = 0, high = 255;
  if (!colors) {
    low = INFINITY;
    high = -INFINITY;
    for (uint64_t i = 0; i < count; ++i)
      if (const double v = at(i); std::isfinite(v)) {
        low = std::min(low, v);
        high = std::max(high, v);
      }
  }
  // Halves keep the difference of the largest numbers finite.
  const double range = high / 2 - low / 2;
  pixels.reserve(size_t(count));
  for (uint64_t i = 0; i < count; ++i) {
    const double share = range > 0 ? (at(i) / 2 - low / 2) / range : 0;
    pixels.push_back(share > 0 ? uint8_t(std::lround(std::min(share, 1.0) * 255)) : uint8_t(0));
  }
}

} // namespace

bool looksLikeNrrd(Bytes bytes) {
  return bytes.size() >= 8 && std::memcmp(bytes.data(), "NRRD000", 7) == 0;
}

Volume decodeNrrd(Bytes bytes, const ImageRoom& room) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const Header header = readHeader(text);
  const size_t size = sizes[size_t(header.number)];
  // The sizes are checked before they are multiplied.
  checkVolumeSize({header.axes[1], header.axes[2], header.axes[3]}, header.axes[0], 0, room,
                  "NRRD file");
  const uint64_t count = header.values(), wanted = count * size;
  const uint64_t working = header.encoding == Encoding::raw    ? 0
                           : header.encoding == Encoding::gzip ? wanted
                                                               : count * sizeof(double);
  checkVolumeSize({header.axes[1], header.axes[2], header.axes[3]}, header.axes[0], working, room,
                  "NRRD file");
  Volume volume{
      int(header.axes[1]), int(header.axes[2]), int(header.axes[3]), int(header.axes[0]), {}};
  const bool colors = header.number == Number::u8;
  const Bytes data = bytes.subspan(header.data);
  if (header.encoding == Encoding::text) {
    const std::vector<double> values = textNumbers(text.substr(header.data), count);
    convert(
        count, colors, [&](uint64_t i) { return values[i]; }, volume.pixels);
    return volume;
  }
  std::vector<uint8_t> own;
  if (header.encoding == Encoding::gzip) own = unpacked(data, wanted);
  const Bytes numbers = header.encoding == Encoding::gzip ? Bytes(own) : data;
  if (numbers.size() < wanted) refuse("it ends too early");
  convert(
      count, colors, [&](uint64_t i) { return valueAt(&numbers[i * size], header); },
      volume.pixels);
  return volume;
}

} // namespace xvrml
