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

// An open sound. It is not copied or moved, because the library keeps the address of the file.
struct Sound {
  explicit Sound(std::span<const uint8_t> bytes) : file{bytes} {
    SF_VIRTUAL_IO access{size, seek, read, nullptr, tell};
    sound.reset(sf_open_virtual(&access, SFM_READ, &info, &file));
    if (!sound) throw std::runtime_error(sf_strerror(nullptr));
    if (info.frames < 0 || info.channels < 1) throw std::runtime_error("it has no length");
    atOnce = std::max<sf_count_t>(65536 / info.channels, 1);
    samples.resize(size_t(atOnce * info.channels));
  }
  Sound(const Sound&) = delete;
  Sound& operator=(const Sound&) = delete;

  // Reads the next samples, at most so many frames. Returns how many frames there were.
  sf_count_t next(sf_count_t most) {
    const sf_count_t got = sf_readf_float(sound.get(), samples.data(), std::min(most, atOnce));
    return std::max<sf_count_t>(got, 0);
  }

  FileInMemory file;
  SF_INFO info{};
  std::unique_ptr<SNDFILE, decltype(&sf_close)> sound{nullptr, sf_close};
  sf_count_t atOnce = 0;
  std::vector<float> samples;
};

// Returns the length of a sound in frames. FLAC of an encoder that could not go back, and Ogg that
// ends too early, do not say it: they are read once more.
sf_count_t lengthOf(const Sound& sound) {
  if (sound.info.frames != SF_COUNT_MAX) return sound.info.frames;
  Sound copy(sound.file.bytes);
  sf_count_t frames = 0;
  while (const sf_count_t got = copy.next(copy.atOnce)) frames += got;
  return frames;
}

} // namespace

void decodeSound(std::span<const uint8_t> bytes, Answer& answer) {
  Sound sound(bytes);
  const SF_INFO& info = sound.info;
  const sf_count_t frames = lengthOf(sound);
  answer.contents(
      {uint64_t(frames), 1, uint32_t(info.channels), sizeof(float), double(info.samplerate)});
  for (sf_count_t left = frames; left > 0;) {
    const sf_count_t got = sound.next(left);
    if (got == 0) return;
    answer.add(sound.samples.data(), size_t(got * info.channels) * sizeof(float));
    left -= got;
  }
}

} // namespace xvrml::decoding
