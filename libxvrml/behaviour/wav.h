// wav.h: reads RIFF WAVE files. Pure functions over a file; called by AudioClip. [any thread]
#pragma once

#include <cstdint>
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

// Reads the header alone. Throws std::runtime_error saying what is wrong: missing, not a WAVE file (MIDI has a message of its
// own), damaged.
WavInfo readWavInfo(const std::string& path);

// PCM of 8, 16, 24 or 32 bits and floats of 32. Throws std::runtime_error for others, and for more than maximumClipBytes.
Clip readWav(const std::string& path);
inline constexpr uint64_t maximumClipBytes = 256 << 20;

} // namespace xvrml
