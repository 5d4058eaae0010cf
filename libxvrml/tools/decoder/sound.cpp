// sound.cpp: decodes sounds with libsndfile, which recognises their format: WAVE, AIFF, FLAC, Ogg
// (Vorbis, Opus), MP3 and more. A sound that ends too early is read as far as it goes.
#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include <sndfile.h>

#include "answer.h"

namespace xvrml::decoding {
namespace {

struct FileInMemory {
  std::span<const uint8_t> bytes;
  sf_count_t at = 0;
};

FileInMemory& fileOf(void* user) { return *static_cast<FileInMemory*>(user); }

sf_count_t size(void* user) { return sf_count_t(fileOf(user).bytes.size()); }

sf_count_t seek(sf_count_t offset, int whence, void* user) {
  FileInMemory& file = fileOf(user);
  const sf_count_t origin = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file.at : size(user);
  if (offset < -origin || offset > size(user) - origin) return -1;
  return file.at = origin + offset;
}

sf_count_t read(void* to, sf_count_t count, void* user) {
  FileInMemory& file = fileOf(user);
  const sf_count_t got = std::clamp<sf_count_t>(count, 0, size(user) - file.at);
  std::memcpy(to, file.bytes.data() + file.at, size_t(got));
  file.at += got;
  return got;
}

sf_count_t tell(void* user) { return fileOf(user).at; }

} // namespace

void decodeSound(std::span<const uint8_t> bytes, Answer& answer) {
  FileInMemory file{bytes};
  SF_VIRTUAL_IO access{size, seek, read, nullptr, tell};
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, decltype(&sf_close)> sound(
      sf_open_virtual(&access, SFM_READ, &info, &file), sf_close);
  if (!sound) throw std::runtime_error(sf_strerror(nullptr));
  if (info.frames < 0 || info.channels < 1) throw std::runtime_error("it has no length");
  answer.contents(
      {uint64_t(info.frames), 1, uint32_t(info.channels), sizeof(float), double(info.samplerate)});
  const sf_count_t atOnce = std::max<sf_count_t>(65536 / info.channels, 1);
  std::vector<float> samples(size_t(atOnce * info.channels));
  for (sf_count_t left = info.frames; left > 0;) {
    const sf_count_t got = sf_readf_float(sound.get(), samples.data(), std::min(left, atOnce));
    if (got <= 0) return;
    answer.add(samples.data(), size_t(got * info.channels) * sizeof(float));
    left -= got;
  }
}

} // namespace xvrml::decoding
