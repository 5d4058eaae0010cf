// message.h: the head of the messages between the library and the programs that it starts:
// xvrml-script-host (script/remote/wire.h), xvrml-decoder and xvrml-step-reader
// (decode/protocol.h). [one thread each]
#pragma once

#include <cstdint>
#include <vector>

namespace xvrml::wire {

constexpr uint32_t maximumMessage = 256u << 20; // bytes per message

struct Header {
  uint32_t bytes; // size of the message after the header; a multiple of 8
  uint16_t op, flags;
  uint32_t script; // Scripts only: number of the interpreter in its process
  int32_t result;  // Scripts only: XsResult of done and answer
  double time;     // Scripts only: to the helper: the timestamp
};
static_assert(sizeof(Header) == 24);

// A received message.
struct Message {
  Header header{};
  std::vector<char> bytes; // aligned for any element
};

} // namespace xvrml::wire
