// address.h: The address of --control: HOST:PORT, :PORT (this machine), or unix:PATH.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vv::control {

struct Address {
  std::string host; // without brackets; "" for a unix socket
  uint16_t port = 0;
  std::string path; // the path of a unix socket

  // Throws UsageError.
  static Address parse(std::string_view text);
  bool isPath() const { return !path.empty(); }
  // Returns the address as parse() reads it, with another port.
  std::string text(uint16_t withPort) const;
};

} // namespace vv::control
