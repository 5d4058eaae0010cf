// mixer.h: Mixes the Sounds of a running world into samples. The browser's thread sets the audible
// sounds after each tick; the audio device's thread fetches samples and advances the sounds between
// ticks.
#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "xvrml/media.h"

namespace vv {

class Mixer {
 public:
  // Sets the sounds that are audible from now on. [browser's thread]
  void set(const std::vector<xvrml::Heard>& audible);
  // Fills pairs of left and right samples in [-1,1], `rate` pairs per second. Allocates no memory.
  // New sounds fade in, and ended sounds fade out, within the block. [device's thread]
  void fill(std::span<float> stereo, double rate);

 private:
  struct Voice {
    // identifies a voice, together with `place` and the clip; never dereferenced
    const void* sound = nullptr;
    int place = 0;
    xvrml::Playing playing;
    xvrml::SoundLevels now, next;
    bool wanted = true;
  };
  void updateVoices(std::vector<Voice>& fresh);

  std::mutex mutex_;
  std::optional<std::vector<Voice>> fresh_;
  std::vector<Voice> voices_; // used by the device's thread only
};

} // namespace vv
