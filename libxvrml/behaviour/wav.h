// wav.h: reads RIFF WAVE files. Pure functions over a file; called by AudioClip. [any thread]
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "xvrml/media.h"

namespace xvrml {

struct WavInfo {
  int format = 0; // 1: PCM, 3: floats; others have a duration but no samples that can be had here
  int channels = 0, bits = 0;
  double rate = 0;     // frames a second
  double duration = 0; // seconds
  uint64_t dataAt = 0, dataBytes = 0;
};

// Reads the header alone. Throws std::runtime_error saying what is wrong: missing, not a WAVE file
// (MIDI has a message of its own), damaged.
WavInfo readWavInfo(const std::string& path);

// PCM of 8, 16, 24 or 32 bits and floats of 32. Throws std::runtime_error for others, and for more
// than maximumClipBytes. reserve, if there is one: is told how many bytes the samples will take,
// and throws if these are too many.
Clip readWav(const std::string& path, const std::function<void(uint64_t bytes)>& reserve = {});
inline constexpr uint64_t maximumClipBytes = 256 << 20;

} // namespace xvrml
