// wav.h: reads RIFF WAVE files. Pure functions over a file, called by AudioClip. [any thread]
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "xvrml/media.h"

namespace xvrml {

struct WavInfo {
  // 1: PCM, 3: float. Other formats have a duration, but no samples that can be decoded here
  int format = 0;
  int channels = 0, bits = 0;
  double rate = 0;     // frames per second
  double duration = 0; // length of the sound in seconds
  uint64_t dataAt = 0, dataBytes = 0;
};

// Reads the header only. Throws std::runtime_error with the reason: missing, not a WAVE file (with
// a message of its own for MIDI), damaged.
WavInfo readWavInfo(const std::string& path);

// Reads PCM of 8, 16, 24 or 32 bits and 32-bit floats. Throws std::runtime_error for other formats
// and for more than maximumClipBytes. reserve: if given, it is called with the number of bytes that
// the samples will take, and throws if these are too many.
Clip readWav(const std::string& path, const std::function<void(uint64_t bytes)>& reserve = {});
inline constexpr uint64_t maximumClipBytes = 256 << 20;

} // namespace xvrml
