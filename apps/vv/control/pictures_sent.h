// pictures_sent.h: Encodes finished pictures for clients, on a thread of its own, because a large
// picture takes longer than a frame. [the browser's thread]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "control/command.h"
#include "libpicture/files/formats.h"

namespace vv::control {

// Returns the format that a command asks for. Throws CommandError.
const picture::Format& formatOf(const Render& render);
// Returns the bits of the channels that it names; `usual` if it names none. Throws CommandError.
uint32_t channelsOf(const Render& render, uint32_t usual);

// Makes the answer of an encoded picture: the result as JSON, or an error.
struct Encoded {
  std::string result;
  std::string failure;
};

// Encodes a picture on a thread of its own. With render.file the file is written, otherwise the
// result holds the bytes.
class Encoding {
 public:
  // Throws std::system_error if there is no thread for it.
  Encoding(picture::Picture picture, uint32_t channels, const Render& render);
  // Returns whether it has ended; waits for that at most these seconds.
  bool hasEnded(double seconds = 0) const;
  // Returns the answer. [after its end]
  Encoded take();
  // Tells whether a thread still encodes or writes, whether its answer is wanted or not. Such a
  // thread cannot be stopped, and a slow disk may hold it for long.
  static bool working();

 private:
  struct Task;
  std::shared_ptr<Task> task_;
};

} // namespace vv::control
