// mixer.h: the Sounds of a running world as samples. The browser's thread says after each tick what
// is heard; the device's thread asks for samples and goes on by itself in between.
#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "xvrml/media.h"

namespace vv {

class Mixer {
 public:
  // What is heard from now on. [browser's thread]
  void set(const std::vector<xvrml::Heard>& heard);
  // Pairs of left and right samples in [-1,1], `rate` pairs a second; without memory of its own
  // being asked for a block. What is new fades in, what has ended fades out, within the block.
  // [device's thread]
  void fill(std::span<float> stereo, double rate);

 private:
  struct Voice {
    const void* sound =
        nullptr; // with `place` and the clip what tells voices apart; never looked at
    int place = 0;
    xvrml::Playing playing;
    xvrml::SoundLevels now, next;
    bool wanted = true;
  };
  void follow(std::vector<Voice>& fresh);

  std::mutex mutex_;
  std::optional<std::vector<Voice>> fresh_;
  std::vector<Voice> voices_; // the device's thread's
};

} // namespace vv
