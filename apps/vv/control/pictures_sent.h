// pictures_sent.h: Encodes finished pictures for clients, on a thread of its own, because a large
// picture takes longer than a frame. [the browser's thread]
#pragma once

#include <future>
#include <optional>
#include <string>
#include <string_view>

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

// Begins to encode. With render.file the file is written, otherwise the result holds the bytes.
std::future<Encoded> encode(picture::Picture picture, uint32_t channels, const Render& render);

// Returns bytes in base64 (RFC 4648, section 4).
std::string base64(std::string_view bytes);

} // namespace vv::control
