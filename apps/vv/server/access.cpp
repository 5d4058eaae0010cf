#include "server/access.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include <fmt/format.h>

#include "lower_case.h"
#include "server/limits.h"
#include "system/random.h"

namespace vv::server {

namespace {

constexpr std::string_view hexDigits = "0123456789abcdef";

// Returns the host without its port: "[::1]:80" gives "[::1]". Text that is no port stays.
std::string_view withoutPort(std::string_view host) {
  const size_t digits = std::min(host.find_last_not_of("0123456789") + 1, host.size());
  const bool hasPort = digits > 0 && host[digits - 1] == ':' && !host.ends_with(":");
  return hasPort ? host.substr(0, digits - 1) : host;
}

// Returns the host with its port, which is left out where it is the scheme's own.
std::string normal(std::string_view host, std::string_view port) {
  std::string out = lowerCase(host);
  if (out.size() > port.size() && out.ends_with(port)) out.resize(out.size() - port.size());
  return out;
}

// Tells whether a text is an address 127.x.y.z.
bool isLoopbackAddress(std::string_view host) {
  if (!host.starts_with("127.")) return false;
  int dots = 0;
  for (size_t i = 0; i < host.size(); ++i) {
    const bool dot = host[i] == '.';
    if (!dot && !std::isdigit(static_cast<unsigned char>(host[i]))) return false;
    if (dot && (++dots > 3 || i + 1 == host.size() || host[i + 1] == '.')) return false;
  }
  return dots == 3;
}

// Tells whether a text is a token that is in use.
bool isToken(std::string_view text, std::string_view token) {
  return !token.empty() && equalInConstantTime(text, token);
}

} // namespace

bool equalInConstantTime(std::string_view a, std::string_view b) {
  // The length of a token is no secret, its characters are.
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  return difference == 0;
}

std::string faultOfToken(std::string_view token) {
  if (token.size() < size_t(minTokenLength) || token.size() > size_t(maxTokenLength))
    return fmt::format("a token has {} to {} characters, not {}", minTokenLength, maxTokenLength,
                       token.size());
  const bool plain = std::all_of(token.begin(), token.end(), [](unsigned char c) {
    return c < 128 && (std::isalnum(c) || c == '-' || c == '_');
  });
  return plain ? "" : "a token consists of letters, digits, - and _";
}

std::string newToken() {
  uint8_t bytes[16];
  os::fillRandomly(bytes, sizeof bytes);
  std::string token;
  for (const uint8_t byte : bytes) {
    token += hexDigits[byte >> 4];
    token += hexDigits[byte & 15];
  }
  return token;
}

std::string_view cookieNamed(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const size_t end = std::min(header.find(';'), header.size());
    std::string_view one = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    while (one.starts_with(' ')) one.remove_prefix(1);
    const size_t equals = one.find('=');
    if (equals != one.npos && one.substr(0, equals) == name) return one.substr(equals + 1);
  }
  return {};
}

bool isLoopbackHost(std::string_view host) {
  const std::string_view name = withoutPort(host);
  return lowerCase(name) == "localhost" || name == "[::1]" || isLoopbackAddress(name);
}

bool isSameOrigin(std::string_view origin, std::string_view host) {
  for (const auto& [scheme, port] :
       {std::pair<std::string_view, std::string_view>{"http://", ":80"}, {"https://", ":443"}})
    if (lowerCase(origin.substr(0, scheme.size())) == scheme)
      return !host.empty() && normal(origin.substr(scheme.size()), port) == normal(host, port);
  return false;
}

Verdict judge(const Credentials& credentials, const Tokens& tokens, Asked asked) {
  // Without this a page that has given its own name the address of this machine could steer.
  if (tokens.view.empty() && !isLoopbackHost(credentials.host)) return Verdict::wrongHost;
  if (!credentials.origin.empty() && !isSameOrigin(credentials.origin, credentials.host))
    return Verdict::wrongOrigin;
  if (credentials.origin.empty() && asked == Asked::socket) return Verdict::noOrigin;
  if (isToken(credentials.token, tokens.view) || isToken(credentials.token, tokens.edit))
    return Verdict::withQuery;
  if (tokens.view.empty() || isToken(credentials.cookie, tokens.view) ||
      isToken(credentials.cookie, tokens.edit))
    return Verdict::allowed;
  return credentials.token.empty() && credentials.cookie.empty() ? Verdict::tokenMissing
                                                                 : Verdict::wrongToken;
}

bool mayEdit(const Credentials& credentials, const Tokens& tokens) {
  return isToken(credentials.token, tokens.edit) || isToken(credentials.cookie, tokens.edit);
}

std::string_view textOf(Verdict verdict) {
  switch (verdict) {
  case Verdict::wrongHost:
    return "Without --token this world can be seen only under the names of this machine itself, "
           "such as localhost.";
  case Verdict::noOrigin:
    return "A WebSocket needs the header Origin, with the address of the page.";
  case Verdict::wrongOrigin: return "A page of another site may not use this world.";
  case Verdict::tokenMissing:
    return "This world needs a token: open the address that vv has printed, which ends with "
           "?token=...";
  case Verdict::wrongToken: return "The token is not the right one.";
  case Verdict::allowed:
  case Verdict::withQuery: break;
  }
  return {};
}

} // namespace vv::server
