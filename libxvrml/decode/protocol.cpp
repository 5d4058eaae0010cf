// protocol.cpp: encodes the messages of protocol.h. Part of the library and of the programs
// that decode files.
#include "decode/protocol.h"

#include <algorithm>

namespace xvrml::decoding {

// The size of a message is a multiple of 8; `flags` tells how many of its last bytes mean nothing.
bool send(wire::Channel& channel, Op op, std::span<const char> content) {
  static constexpr char nothing[8] = {};
  const size_t padding = (8 - content.size() % 8) % 8;
  wire::Header header{};
  header.bytes = uint32_t(content.size() + padding);
  header.op = uint16_t(op);
  header.flags = uint16_t(padding);
  return channel.send({reinterpret_cast<const char*>(&header), sizeof header}) &&
         channel.send({content.data(), content.size()}) && channel.send({nothing, padding});
}

bool sendParts(wire::Channel& channel, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const auto part = bytes.first(std::min(bytes.size(), partBytes));
    if (!send(channel, Op::bytes, part)) return false;
    bytes = bytes.subspan(part.size());
  }
  return true;
}

std::optional<std::span<const char>> contentOf(const wire::Message& message) {
  const size_t padding = message.header.flags, all = message.header.bytes;
  if (padding > 7 || padding > all) return {};
  return std::span(message.bytes.data(), all - padding);
}

} // namespace xvrml::decoding
