#include "window/sound/mixer.h"

#include <algorithm>
#include <cmath>

namespace vv {

void Mixer::set(const std::vector<xvrml::Heard>& audible) {
  std::vector<Voice> fresh;
  fresh.reserve(audible.size());
  for (const xvrml::Heard& one : audible) {
    const int place =
        !fresh.empty() && fresh.back().sound == one.sound ? fresh.back().place + 1 : 0;
    fresh.push_back({one.sound, place, one.playing, {}, one.levels, true});
  }
  const std::lock_guard lock(mutex_);
  fresh_ = std::move(fresh);
}

// Updates the voices. The clocks of world and device drift, and ticks are late, so a voice jumps to
// the new position only if it is far off.
void Mixer::updateVoices(std::vector<Voice>& fresh) {
  constexpr double farOff = 0.2; // tolerated drift in seconds
  for (Voice& voice : voices_) {
    voice.wanted = false;
    voice.next = {};
  }
  for (Voice& one : fresh) {
    const auto found = std::find_if(voices_.begin(), voices_.end(), [&](const Voice& v) {
      return v.sound == one.sound && v.place == one.place && v.playing.clip == one.playing.clip;
    });
    if (found == voices_.end()) {
      voices_.push_back(std::move(one));
      continue;
    }
    double off = std::abs(found->playing.position - one.playing.position);
    const double length = one.playing.clip->rate > 0
                              ? double(one.playing.clip->frames()) / one.playing.clip->rate
                              : 0;
    if (one.playing.loop) off = std::min(off, std::abs(length - off));
    const double position = off > farOff * std::max(1.0, one.playing.pitch)
                                ? one.playing.position
                                : found->playing.position;
    found->playing = one.playing;
    found->playing.position = position;
    found->next = one.next;
    found->wanted = true;
  }
}

void Mixer::fill(std::span<float> stereo, double rate) {
  constexpr size_t piece = 64; // pairs of samples with the same levels
  std::optional<std::vector<Voice>> fresh;
  if (const std::unique_lock lock(mutex_, std::try_to_lock); lock.owns_lock()) fresh.swap(fresh_);
  if (fresh) updateVoices(*fresh);
  std::fill(stereo.begin(), stereo.end(), 0.f);
  const size_t pairs = stereo.size() / 2;
  for (Voice& voice : voices_) {
    xvrml::Playing& p = voice.playing;
    const double length = p.clip->rate > 0 ? double(p.clip->frames()) / p.clip->rate : 0;
    for (size_t at = 0; at < pairs; at += piece) {
      const size_t count = std::min(piece, pairs - at);
      const double s = double(at + count) / double(pairs);
      const xvrml::SoundLevels levels{voice.now.left + (voice.next.left - voice.now.left) * s,
                                      voice.now.right + (voice.next.right - voice.now.right) * s};
      xvrml::mix(p, levels, rate, stereo.subspan(2 * at, 2 * count));
      p.position += double(count) / rate * p.pitch;
      if (p.loop && length > 0) p.position = std::fmod(p.position, length);
    }
    voice.now = voice.next;
  }
  std::erase_if(voices_, [](const Voice& v) { return !v.wanted; });
  for (float& v : stereo) v = std::clamp(v, -1.f, 1.f);
}

} // namespace vv
