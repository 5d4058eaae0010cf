#include "behaviour/sound_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "decode/decoder.h"
#include "image/decoders.h"

namespace xvrml {

using namespace decoding;

namespace {

using Found = std::function<bool(const Contents&)>;
using More = std::function<void(std::span<const char>)>;

void check(const Contents& sound) {
  constexpr uint32_t mostChannels = 1024; // as libsndfile
  constexpr double leastRate = 1, mostRate = 1e9;
  if (sound.rows != 1 || sound.componentBytes != sizeof(float) || sound.components < 1 ||
      sound.components > mostChannels || !(sound.rate >= leastRate && sound.rate <= mostRate))
    throw std::runtime_error("damaged sound");
}

void decode(const std::string& path, const ImageRoom& room, const Found& found, const More& more) {
  Limits limits = room.limits;
  limits.fileBytes = std::min(limits.fileBytes, maximumClipBytes);
  const std::vector<uint8_t> file = readPictureFile(path, {limits, room.bytes, room.budget});
  if (file.size() >= 4 && std::memcmp(file.data(), "MThd", 4) == 0)
    throw std::runtime_error("MIDI is not played");
  decoderOf(room.budget)->decode({Format::sound, file, 0}, found, more);
}

} // namespace

double soundLength(const std::string& path, const ImageRoom& room) {
  double seconds = 0;
  decode(path, room,
         [&](const Contents& sound) {
           check(sound);
           seconds = double(sound.columns) / sound.rate;
           return false;
         },
         {});
  return seconds;
}

Clip readSound(const std::string& path, const ImageRoom& room,
               const std::function<void(uint64_t bytes)>& reserve) {
  Clip clip;
  decode(
      path, room,
      [&](const Contents& sound) {
        check(sound);
        const uint64_t frame = sound.components * sizeof(float);
        if (sound.columns > maximumClipBytes / frame)
          throw std::runtime_error("the sound is too large");
        if (reserve) reserve(sound.columns * frame);
        clip.channels = int(sound.components);
        clip.rate = sound.rate;
        return true;
      },
      [&](std::span<const char> part) {
        const size_t at = clip.samples.size();
        clip.samples.resize(at + part.size() / sizeof(float));
        std::memcpy(clip.samples.data() + at, part.data(),
                    (clip.samples.size() - at) * sizeof(float));
        for (size_t i = at; i < clip.samples.size(); ++i)
          clip.samples[i] =
              std::isfinite(clip.samples[i]) ? std::clamp(clip.samples[i], -1.0f, 1.0f) : 0;
      });
  clip.samples.resize(clip.frames() * size_t(clip.channels)); // no part of a frame
  return clip;
}

} // namespace xvrml
