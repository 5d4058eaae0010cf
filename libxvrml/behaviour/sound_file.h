// sound_file.h: reads the files of AudioClips, which another process decodes (decode/decoder.h).
// [any thread]
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "image/image.h"
#include "xvrml/media.h"

namespace xvrml {

// Returns the length of a sound in seconds. Throws std::runtime_error with the reason: missing, too
// large, no sound (with a message of its own for MIDI), damaged.
double soundLength(const std::string& path, const ImageRoom& room);

// Reads the samples of a sound. Throws std::runtime_error, also for more than maximumClipBytes.
// reserve: is called with the number of bytes that the samples will take, and throws if these are
// too many.
Clip readSound(const std::string& path, const ImageRoom& room,
               const std::function<void(uint64_t bytes)>& reserve = {});
inline constexpr uint64_t maximumClipBytes = 512 << 20;

} // namespace xvrml
