#include "control/address.h"

#include <fmt/format.h>

#include "number_text.h"
#include "options/values.h"

namespace vv::control {

namespace {

[[noreturn]] void refuse(std::string_view text, std::string_view why) {
  throw UsageError(fmt::format("HOST:PORT, :PORT or unix:PATH was expected, not \"{}\": {}",
                               text.substr(0, 200), why));
}

} // namespace

Address Address::parse(std::string_view text) {
  constexpr std::string_view scheme = "unix:";
  constexpr size_t longestPath = 107; // sockaddr_un
  Address address;
  if (text.starts_with(scheme)) {
    address.path = text.substr(scheme.size());
    if (address.path.empty()) refuse(text, "the path is missing");
    if (address.path.size() > longestPath)
      refuse(text, fmt::format("the path has more than {} bytes", longestPath));
    if (address.path.find('\0') != address.path.npos) refuse(text, "the path contains a zero byte");
    return address;
  }
  const size_t colon = text.rfind(':');
  if (colon == text.npos) refuse(text, "the port is missing; 0 is any free one");
  std::string_view host = text.substr(0, colon), digits = text.substr(colon + 1);
  if (host.starts_with('[') && host.ends_with(']'))
    host = host.substr(1, host.size() - 2);
  else if (host.find(':') != host.npos)
    refuse(text, "write [ADDRESS]:PORT for IPv6");
  for (const char c : host)
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f)
      refuse(text, "it contains blanks or invisible characters");
  if (!isNumber(digits, address.port)) refuse(text, "a port is a number from 0 to 65535");
  address.host = host.empty() ? "127.0.0.1" : host;
  return address;
}

std::string Address::text(uint16_t withPort) const {
  if (isPath()) return "unix:" + path;
  return fmt::format("{}:{}", host.find(':') == host.npos ? host : "[" + host + "]", withPort);
}

} // namespace vv::control
