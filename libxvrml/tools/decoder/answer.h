// answer.h: how decoders in the cage report what they have read, and those of xvrml-decoder. They
// may read past the end, run for ever or end the process: the library has prepared for that. [one
// thread]
#pragma once

#include <cstdint>
#include <span>

#include "decode/protocol.h"

namespace xvrml::decoding {

// Thrown when the library wants no numbers of the file.
struct Stopped {};

class Answer {
 public:
  explicit Answer(wire::Channel& channel) : channel_(channel) {}
  // Says what the file holds. Throws Stopped if its numbers are not wanted. Each decoder calls it
  // before it allocates memory for them.
  void contents(const Contents& contents);
  // Sends the next bytes of the decoded numbers.
  void add(const void* numbers, size_t bytes);

 private:
  wire::Channel& channel_;
};

// Decode a file. Throw std::exception with the reason if that is not possible.
void decodeOpenExr(std::span<const uint8_t> file, Answer& answer); // three floats per pixel
void decodeWebp(std::span<const uint8_t> file, Answer& answer);
void decodeBitmap(std::span<const uint8_t> file, Answer& answer); // BMP or TGA
void decodeSound(std::span<const uint8_t> file, Answer& answer);  // floats

} // namespace xvrml::decoding
