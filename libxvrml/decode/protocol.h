// protocol.h: the messages between the library and the programs that decode files (xvrml-decoder,
// xvrml-step-reader). The library sends the bytes of a file; the program answers with what the file
// holds, and, if the library wants it, with the decoded numbers as they come. Both ends are on one
// machine, so numbers have its order of bytes. [one thread each]
#pragma once

#include <cstring>
#include <optional>
#include <span>

#include "process/channel.h"

namespace xvrml::decoding {

constexpr uint32_t version = 3;

enum class Format : uint32_t {
  exr = 1,
  webp,
  bitmap, // BMP or TGA
  sound,
  step // becomes a binary glTF file
};

enum class Op : uint16_t {
  // From the program: it is closed in.
  ready = 1,
  // From the library: a file follows, in messages `bytes`.
  decode,
  bytes, // from either: a part of the file, or of the decoded numbers
  // From the program, when it has read the file's header. It waits for `proceed` or `stop`.
  contents,
  proceed,
  stop,
  end,   // from the program: all numbers have been sent
  failed // from the program: the reason why it cannot decode the file, as text
};

struct Ready {
  uint32_t version, reserved = 0;
  uint64_t addressSpace; // bytes in use; 0: no limit can be set
};
struct Request {
  Format format;
  uint32_t reserved = 0;
  uint64_t fileBytes;
  double chordError; // models: millimetres; 0: a part of each model's size
};
// Describes a picture, whose rows follow from the top, a sound, whose columns are frames, or a
// model, whose columns are the bytes of a glTF file.
struct Contents {
  uint64_t columns, rows;
  uint32_t components;     // numbers of a pixel, channels of a sound
  uint32_t componentBytes; // 1: bytes; 4: floats
  double rate = 0;         // sounds: frames a second
  uint64_t leftOut = 0;    // models: faces that could not be divided into triangles
  double away = 0;         // models: the largest coordinate in the file, metres
  double size = 0;         // models: the diagonal of the box, metres
};

constexpr size_t partBytes = 256 << 10; // bytes of a part at most

// Sends a message. Returns false if the other end is gone.
bool send(wire::Channel& channel, Op op, std::span<const char> content = {});
template <class Struct> bool send(wire::Channel& channel, Op op, const Struct& content) {
  return send(channel, op, std::span(reinterpret_cast<const char*>(&content), sizeof content));
}
// Sends bytes in parts.
bool sendParts(wire::Channel& channel, std::span<const char> bytes);

// Returns the content of a message; nothing if its size is not possible.
std::optional<std::span<const char>> contentOf(const wire::Message& message);
// Returns a message as a struct; nothing if it is another message.
template <class Struct> std::optional<Struct> as(const wire::Message& message, Op op) {
  const auto content = contentOf(message);
  if (message.header.op != uint16_t(op) || !content || content->size() != sizeof(Struct)) return {};
  Struct result;
  std::memcpy(&result, content->data(), sizeof result);
  return result;
}

} // namespace xvrml::decoding
