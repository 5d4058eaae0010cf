#include "server/address.h"

#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "server/access.h"
#include "server/limits.h"

namespace vv::server {

namespace {

constexpr const char* variable = "VV_TOKEN";

std::string readToken(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  // A little more than the longest token, since a file like /dev/zero may have no end.
  for (char c; line.size() < 2 * size_t(maxTokenLength) && file.get(c) && c != '\n';) line += c;
  if (!file && line.empty()) throw Failure{exitInput, fmt::format("--token: cannot read {}", path)};
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  return line;
}

std::string tokenOf(const ServeOptions& options) {
  std::string where = "--token", token = options.token;
  if (token == "new") return newToken();
  if (token.starts_with('@')) token = readToken(token.substr(1));
  if (options.token.empty()) {
    const char* const value = std::getenv(variable);
    token = value ? value : "";
    where = std::string("$") + variable;
    if (token.empty()) return {};
  }
  if (const std::string fault = faultOfToken(token); !fault.empty())
    throw UsageError(fmt::format("{}: {}; --token new makes one", where, fault));
  return token;
}

// Returns an address as a URL contains it.
std::string inUrl(const std::string& address) {
  return address.find(':') == address.npos ? address : "[" + address + "]";
}

bool isEveryAddress(const std::string& address) { return address == "0.0.0.0" || address == "::"; }

std::string hostName() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 && *name ? name : "localhost";
}

std::string urlWith(const HostOptions& host, int port, const std::string& query) {
  const std::string name =
      isEveryAddress(host.addresses[0]) ? hostName() : inUrl(host.addresses[0]);
  return fmt::format("http://{}:{}/{}", name, port, query);
}

} // namespace

HostOptions hostOptionsOf(const ServeOptions& options) {
  HostOptions host;
  host.port = options.port;
  const std::string& address = options.address;
  if (!address.empty() && address != "localhost" && !isIpAddress(address))
    throw UsageError(fmt::format("--address: an IP address was expected, not \"{}\"", address));
  host.token = tokenOf(options);
  if (options.edit) host.editToken = newToken();
  const bool local = options.address.empty() || isLoopbackHost(inUrl(options.address));
  if (!local && host.token.empty())
    throw UsageError(fmt::format("--address {} lets other machines see the world: it needs a token "
                                 "(--token new makes one)",
                                 options.address));
  if (options.address.empty() || options.address == "localhost")
    host.addresses = {"127.0.0.1", "::1"};
  else
    host.addresses = {options.address};
  return host;
}

std::string urlOf(const ServeOptions& options, const HostOptions& host, int port) {
  return urlWith(host, port,
                 host.token.empty()       ? ""
                 : options.token == "new" ? "?token=" + host.token
                                          : "?token=...");
}

std::string editUrlOf(const HostOptions& host, int port) {
  return host.editToken.empty() ? "" : urlWith(host, port, "?token=" + host.editToken);
}

} // namespace vv::server
