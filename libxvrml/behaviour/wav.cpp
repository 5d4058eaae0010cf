// wav.cpp: reads WAVE files. Sizes in the file are not trusted: a chunk ends at the end of
// the file at the latest.
#include "behaviour/wav.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

#include "base/regular_file.h"

namespace xvrml {
namespace {

uint32_t little(const uint8_t* p, int bytes) {
  uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= uint32_t(p[i]) << (8 * i);
  return value;
}

class File {
 public:
  explicit File(const std::string& path) : file_(path) {}
  uint64_t size() const { return file_.size(); }
  // Returns false if the file is too short.
  bool read(uint64_t at, void* to, uint64_t bytes) {
    if (at > size() || bytes > size() - at) return false;
    return file_.read(at, to, bytes) == bytes;
  }

 private:
  RegularFile file_;
};

bool is(const uint8_t* bytes, const char* name) { return std::memcmp(bytes, name, 4) == 0; }

void readFormat(const uint8_t* p, uint64_t bytes, WavInfo& info, uint32_t& bytesPerSecond,
                uint32_t& frameBytes) {
  info.format = int(little(p, 2));
  info.channels = int(little(p + 2, 2));
  info.rate = little(p + 4, 4);
  bytesPerSecond = little(p + 8, 4);
  frameBytes = little(p + 12, 2);
  info.bits = int(little(p + 14, 2));
  // In the extensible format the code is in the first bytes of a GUID.
  if (info.format == 0xfffe && bytes >= 26) info.format = int(little(p + 24, 2));
}

WavInfo readHeader(File& file) {
  uint8_t head[40] = {};
  if (!file.read(0, head, 12)) throw std::runtime_error("the file is not a sound");
  if (is(head, "MThd")) throw std::runtime_error("MIDI is not played");
  if (!is(head, "RIFF") || !is(head + 8, "WAVE"))
    throw std::runtime_error("the file is not a WAVE sound");
  WavInfo info;
  uint32_t bytesPerSecond = 0, frameBytes = 0;
  bool hasFormat = false, hasData = false;
  int chunks = 0;
  for (uint64_t at = 12; !(hasFormat && hasData) && file.read(at, head, 8) && ++chunks < 1000;) {
    const uint64_t begin = at + 8,
                   bytes = std::min<uint64_t>(little(head + 4, 4), file.size() - begin);
    if (is(head, "data")) {
      hasData = true;
      info.dataAt = begin;
      info.dataBytes = bytes;
    } else if (is(head, "fmt ") && bytes >= 16) {
      hasFormat = file.read(begin, head, std::min<uint64_t>(bytes, sizeof head));
      if (hasFormat) readFormat(head, bytes, info, bytesPerSecond, frameBytes);
    }
    at = begin + bytes + bytes % 2;
  }
  if (!hasFormat || !hasData || info.channels == 0 || !(info.rate > 0))
    throw std::runtime_error("damaged WAVE sound");
  const bool plain = info.format == 1 || info.format == 3;
  if (plain && info.bits > 0) frameBytes = uint32_t((info.bits + 7) / 8 * info.channels);
  if (plain && frameBytes > 0)
    info.duration = double(info.dataBytes / frameBytes) / info.rate;
  else if (bytesPerSecond > 0)
    info.duration = double(info.dataBytes) / bytesPerSecond;
  else
    throw std::runtime_error("damaged WAVE sound");
  return info;
}

float sample(const uint8_t* p, int format, int bytes) {
  if (format == 3) {
    const uint32_t bits = little(p, 4);
    float value;
    std::memcpy(&value, &bits, 4);
    return std::isfinite(value) ? std::clamp(value, -1.0f, 1.0f) : 0;
  }
  if (bytes == 1) return (float(p[0]) - 128) / 128; // 8-bit samples are the only unsigned ones
  return float(double(int32_t(little(p, bytes) << (32 - 8 * bytes))) / 2147483648.0);
}

} // namespace

WavInfo readWavInfo(const std::string& path) {
  File file(path);
  return readHeader(file);
}

Clip readWav(const std::string& path, const std::function<void(uint64_t bytes)>& reserve) {
  File file(path);
  const WavInfo info = readHeader(file);
  const int bytes = (info.bits + 7) / 8;
  if (!(info.format == 1 && bytes >= 1 && bytes <= 4) && !(info.format == 3 && bytes == 4))
    throw std::runtime_error(
        fmt::format("WAVE sound of format {} with {} bits is not decoded", info.format, info.bits));
  if (info.dataBytes > maximumClipBytes) throw std::runtime_error("the sound is too large");
  if (reserve) reserve(info.dataBytes / uint64_t(bytes) * sizeof(float));
  std::vector<uint8_t> raw(info.dataBytes);
  if (!file.read(info.dataAt, raw.data(), raw.size()))
    throw std::runtime_error("damaged WAVE sound");
  Clip clip{info.channels, info.rate, {}};
  const size_t frames = raw.size() / size_t(bytes * info.channels);
  clip.samples.resize(frames * size_t(info.channels));
  for (size_t i = 0; i < clip.samples.size(); ++i)
    clip.samples[i] = sample(raw.data() + i * size_t(bytes), info.format, bytes);
  return clip;
}

} // namespace xvrml
