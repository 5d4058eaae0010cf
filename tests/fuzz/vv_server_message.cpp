// vv_server_message.cpp: reads arbitrary text as a message of a page of `vv serve`. An accepted
// message is within the ranges that the server relies on; a refused one says why. libFuzzer calls
// this on one thread.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "server/limits.h"
#include "server/message.h"

namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

void check(const vv::server::Message& message) {
  using Type = vv::server::Message::Type;
  const vv::InputEvent& input = message.input;
  switch (message.type) {
  case Type::size: return require(message.width > 0 && message.height > 0);
  case Type::shown: return require(message.picture > 0);
  case Type::viewpoint: return require(message.number >= 0);
  case Type::input:
    require(std::abs(input.x) <= 100 && std::abs(input.y) <= 100 && std::abs(input.amount) <= 100);
    require(input.text.size() <= 16 && input.kind <= vv::InputEvent::Kind::up);
    return require(input.button <= vv::Button::right);
  default: return;
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  using vv::server::Rights;
  for (const Rights rights : {Rights::view, Rights::edit}) {
    const vv::server::ReadMessage read = vv::server::readMessage(text, rights);
    require(read.message.has_value() == read.fault.empty());
    if (!read.message) continue;
    check(*read.message);
    const bool edits = read.message->type == vv::server::Message::Type::edit;
    require(edits == read.message->editCommand.has_value());
    require(!edits || rights == Rights::edit);
    require(size <= size_t(edits ? vv::server::maxEditBytes : vv::server::maxMessageBytes));
  }
  return 0;
}
