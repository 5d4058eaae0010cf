// sums.cpp: Files of sums. Little-endian:
//   "VVSUMS1\n"; 8 bytes: length of the facts; 8 bytes: FNV-1a of the facts; the facts
//   twice (done, current): 8 bytes for the length, bytes of rtWriteSums; a length of 0: none
// Behind an OpenEXR file, 8 bytes with the length of all this and "VVSUMS1\n" follow.
// The facts: 4 bytes of channels, a byte for linear, one for the kind of depths, one for the kind
// of the background, three floats of its colour; the view: 8 bytes of its exposure, a byte for its
// curve and one for fits; 4 bytes for the number of names, and each name with 4 bytes for its
// length.
#include "libpicture/sums.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "libpicture/files/byte_reader.h"
#include "libpicture/files/exr_end.h"
#include "libpicture/renderer.h"

namespace picture {

namespace {

constexpr std::string_view magic = "VVSUMS2\n", exrMagic = "\x76\x2f\x31\x01";

// Returns whether another version of this project wrote the file of sums, or the sums, that begin
// with these bytes.
bool isOtherVersion(std::string_view bytes) {
  return bytes.starts_with(magic.substr(0, 6)) && !bytes.starts_with(magic);
}

uint64_t checksum(std::string_view bytes) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ uint8_t(c)) * 0x100000001b3u;
  return hash;
}

template <class T> void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Returns what is wrong with the bytes from `begin` to where the reader is.
BrokenFile damagedSince(uint64_t begin, const ByteReader& reader, std::string_view why) {
  return BrokenFile(
      fmt::format("it is damaged between the bytes {} and {}: {}", begin, reader.at(), why));
}

std::string encodeFacts(const SumsFacts& facts, const SumsView& view) {
  std::string out;
  put(out, facts.channels);
  put(out, uint8_t(facts.linear));
  put(out, uint8_t(facts.depthAlongRay));
  put(out, uint8_t(facts.background.kind));
  for (const float c : facts.background.colour) put(out, c);
  put(out, view.transform.exposure);
  put(out, uint8_t(view.transform.curve));
  put(out, uint8_t(view.fits));
  put(out, uint32_t(facts.names.size()));
  for (const std::string& name : facts.names) {
    put(out, uint32_t(name.size()));
    out += name;
  }
  return out;
}

SumsView decodeView(ByteReader& reader) {
  SumsView view;
  view.transform.exposure = reader.number<double>();
  const auto curve = reader.number<uint8_t>();
  if (!(std::abs(view.transform.exposure) <= mostExposure) || curve > uint8_t(ViewCurve::agx))
    throw BrokenFile("it is damaged: its exposure or its view");
  view.transform.curve = ViewCurve(curve);
  view.fits = reader.number<uint8_t>() != 0;
  return view;
}

void decodeFacts(std::string_view bytes, uint64_t at, SumsFacts& facts, SumsView& view) {
  ByteReader reader(bytes, at);
  facts.channels = reader.number<uint32_t>();
  facts.linear = reader.number<uint8_t>() != 0;
  facts.depthAlongRay = reader.number<uint8_t>() != 0;
  const auto kind = reader.number<uint8_t>();
  if (kind > uint8_t(Background::Kind::backdrop)) throw BrokenFile("it is damaged: its background");
  facts.background.kind = Background::Kind(kind);
  for (float& c : facts.background.colour) c = reader.number<float>();
  view = decodeView(reader);
  const auto names = reader.number<uint32_t>();
  if (names > reader.left() / sizeof(uint32_t))
    throw BrokenFile("it is damaged: its number of names");
  for (uint32_t i = 0; i < names; i++)
    facts.names.emplace_back(reader.take(reader.number<uint32_t>()));
}

int append(const void* data, size_t size, void* to) {
  try {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), size);
    return 1;
  } catch (const std::bad_alloc&) { return 0; }
}

void putSums(std::string& out, const Sums& sums) {
  const size_t at = out.size();
  put(out, uint64_t(0));
  if (!sums) return;
  if (!rtWriteSums(sums.get(), append, &out)) {
    while (rtGetError() != RT_NO_ERROR) {}
    throw std::bad_alloc();
  }
  const uint64_t size = out.size() - at - sizeof(uint64_t);
  std::memcpy(out.data() + at, &size, sizeof size);
}

// Returns what went wrong in the last call of the engine, without the name of the call.
std::string whyNot() {
  const RTenum code = rtGetError();
  if (code == RT_OUT_OF_MEMORY) throw std::bad_alloc();
  const std::string message = rtGetErrorMessage();
  const size_t colon = message.find(": ");
  return message.starts_with("rt") && colon != message.npos ? message.substr(colon + 2) : message;
}

Sums takeSums(ByteReader& reader) {
  const std::string_view bytes = reader.take(reader.number<uint64_t>());
  if (bytes.empty()) return {};
  const RTsums sums = rtReadSums(bytes.data(), bytes.size());
  if (sums) return Sums(sums);
  constexpr std::string_view damaged = "it is damaged: ";
  const std::string why = whyNot();
  if (why.starts_with(damaged))
    throw damagedSince(reader.at() - bytes.size(), reader, why.substr(damaged.size()));
  throw BrokenFile(why);
}

// at: place of the first byte in the file
SumsFile decode(std::string_view bytes, uint64_t at) {
  ByteReader reader(bytes, at);
  reader.take(magic.size());
  SumsFile file;
  const auto size = reader.number<uint64_t>(), check = reader.number<uint64_t>();
  const uint64_t begin = reader.at();
  const std::string_view facts = reader.take(size);
  if (checksum(facts) != check) throw damagedSince(begin, reader, "its checksum differs");
  decodeFacts(facts, begin, file.facts, file.view);
  file.done = takeSums(reader);
  file.current = takeSums(reader);
  if (!reader.empty())
    throw BrokenFile(
        fmt::format("it is damaged: more follows than was expected, {} bytes from byte {} "
                    "on",
                    reader.left(), reader.at()));
  if (!file.done && !file.current)
    throw damagedSince(begin + size, reader, "the lengths of both sums are 0");
  return file;
}

// Throws BrokenFile: these bytes of an OpenEXR file do not end with sums.
[[noreturn]] void refuseWithoutSums(std::string_view bytes) {
  const uint64_t end = endOfExr(bytes);
  const std::string_view behind = bytes.substr(size_t(end));
  if (!behind.empty() && magic.starts_with(behind.substr(0, magic.size())))
    throw BrokenFile(
        fmt::format("it is truncated or damaged: its sums begin at byte {}, and their end "
                    "is not at byte {}, where the file ends",
                    end, bytes.size()));
  if (isOtherVersion(behind)) throw BrokenFile("its sums were made by another version");
  throw BrokenFile("it has no sums, only rounded means; --sums puts sums into a file");
}

SumsFile decodeBehindExr(std::string_view bytes) {
  constexpr size_t tail = sizeof(uint64_t);
  if (!bytes.ends_with(magic) || bytes.size() < magic.size() + tail) refuseWithoutSums(bytes);
  uint64_t size = 0;
  std::memcpy(&size, bytes.data() + bytes.size() - magic.size() - tail, sizeof size);
  bytes.remove_suffix(magic.size() + tail);
  const uint64_t begin = bytes.size() - std::min<uint64_t>(size, bytes.size());
  const std::string_view sums = bytes.substr(size_t(begin));
  if (size > bytes.size() || !sums.starts_with(magic))
    throw BrokenFile(fmt::format("it is damaged: sums of {} bytes were expected before byte {}",
                                 size, bytes.size()));
  return decode(sums, begin);
}

std::string contentsOf(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw BrokenFile("it is a folder");
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw BrokenFile("it is not an ordinary file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  if (file) {
    char block[65536];
    // A large file of something else is not read.
    file.read(block, std::streamsize(magic.size()));
    bytes.append(block, size_t(file.gcount()));
    if (file.eof() && (magic.starts_with(bytes) || exrMagic.starts_with(bytes)) && bytes != magic)
      throw BrokenFile(fmt::format("it is truncated: it has {} bytes", bytes.size()));
    if (isOtherVersion(bytes)) throw BrokenFile("it was made by another version");
    if (!bytes.starts_with(exrMagic) && bytes != magic)
      throw BrokenFile("it is not a file of sums, and no OpenEXR file");
    while (file.read(block, sizeof block) || file.gcount() > 0)
      bytes.append(block, size_t(file.gcount()));
  }
  if (!file.eof() || file.bad())
    throw BrokenFile(errno ? std::strerror(errno) : "it is unreadable");
  return bytes;
}

[[noreturn]] void failed() { throw RenderError(whyNot(), RT_SUMS_ERROR); }

} // namespace

RTsumsInfo Sums::info() const {
  RTsumsInfo info{};
  info.size = sizeof info;
  rtGetSumsInfo(get(), &info);
  return info;
}

SumsFacts factsOf(const RenderSettings& settings, uint32_t channels,
                  const std::vector<std::string>& names) {
  SumsFacts facts{channels, settings.linear,
                  settings.quality.whole(RT_DEPTH_ALONG) == RT_DEPTH_ALONG_RAY, settings.background,
                  names};
  facts.background.file.clear();
  return facts;
}

std::string encodeSums(const SumsFile& file) {
  std::string out(magic);
  const std::string facts = encodeFacts(file.facts, file.view);
  put(out, uint64_t(facts.size()));
  put(out, checksum(facts));
  out += facts;
  putSums(out, file.done);
  putSums(out, file.current);
  return out;
}

SumsFile readSums(const std::string& path) {
  try {
    const std::string bytes = contentsOf(path);
    return bytes.starts_with(exrMagic) ? decodeBehindExr(bytes) : decode(bytes, 0);
  } catch (const BrokenFile& error) { throw InputError(path, error.what()); }
}

void appendSums(std::string& exr, const SumsFile& file) {
  const std::string bytes = encodeSums(file);
  exr += bytes;
  put(exr, uint64_t(bytes.size()));
  exr += magic;
}

Sums mergeSums(const Sums& a, const Sums& b) {
  if (!a || !b) return condensed(a ? a : b);
  const RTsums merged = rtMergeSums(a.get(), b.get());
  if (!merged) failed();
  return Sums(merged);
}

Sums condensed(const Sums& sums) {
  const RTsums made = rtMergeSums(sums.get(), nullptr);
  if (!made) failed();
  return Sums(made);
}

Picture pictureOf(const Sums& sums, const SumsFacts& facts) {
  const RTsumsInfo info = sums.info();
  Picture picture;
  picture.width = info.width;
  picture.height = info.height;
  picture.linear = facts.linear;
  picture.depthAlongRay = facts.depthAlongRay;
  setBackdrop(facts.background, picture);
  picture.names = facts.names;
  fillChannels(picture, info.channels, [&](uint32_t channel, std::vector<float>& plane) {
    if (!rtReadSumsPixels(sums.get(), channel, plane.data(), plane.size())) failed();
    return true;
  });
  // Sums do not hold a picture that is the background.
  if (const auto rgba = picture.planes.find(RT_RGBA);
      rgba != picture.planes.end() && facts.background.kind != Background::Kind::file)
    BackgroundLayer(facts.background, facts.linear)
        .compositeOver(rgba->second, picture.width, picture.height);
  return picture;
}

RTstats statsOf(const Sums& sums) {
  RTstats stats{};
  stats.size = sizeof stats;
  if (!rtGetSumsStats(sums.get(), &stats)) failed();
  return stats;
}

} // namespace picture
