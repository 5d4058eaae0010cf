#include "backend/cluster/net/addresses.h"

#include <cstring>
#include <stdexcept>

#include <arpa/inet.h>
#include <netdb.h>

#include "backend/cluster/net/wire.h"
#include "number_text.h"

namespace openrt::cluster {
namespace {

constexpr std::string_view ipcScheme = "ipc://", tcpScheme = "tcp://";
constexpr size_t keyLength = 40;

[[noreturn]] void failed(std::string_view text, const char* why) {
  throw std::runtime_error("address \"" + std::string(text.substr(0, 200)) + "\": " + why);
}

bool v4(const std::string& host, in_addr& out) {
  return inet_pton(AF_INET, host.c_str(), &out) == 1;
}
bool v6(const std::string& host, in6_addr& out) {
  // After % comes the name of an interface.
  return inet_pton(AF_INET6, host.substr(0, host.find('%')).c_str(), &out) == 1;
}

} // namespace

Address Address::parse(std::string_view text) {
  const std::string_view whole = text;
  Address a;
  if (const size_t mark = text.find('='); mark != text.npos) {
    a.key = text.substr(mark + 1);
    if (a.key.size() != keyLength)
      failed(whole, "the text after = must be a public key of 40 characters");
    text = text.substr(0, mark);
  }
  for (char c : text)
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f)
      failed(whole, "it contains blanks or invisible characters");
  if (text.starts_with(ipcScheme)) {
    a.ipc = true;
    a.host = text.substr(ipcScheme.size());
    if (a.host.empty()) failed(whole, "the path is missing");
    return a;
  }
  if (text.starts_with(tcpScheme)) text.remove_prefix(tcpScheme.size());
  std::string_view port;
  if (text.starts_with('[')) {
    const size_t end = text.find(']');
    if (end == text.npos) failed(whole, "] is missing after [");
    a.host = text.substr(1, end - 1);
    port = text.substr(end + 1);
    if (!port.empty() && port.front() != ':') failed(whole, "only :PORT may follow ]");
  } else {
    const size_t colon = text.find(':');
    const bool bare6 = colon != text.npos && text.find(':', colon + 1) != text.npos;
    a.host = bare6 ? text : text.substr(0, colon);
    port = bare6 || colon == text.npos ? std::string_view() : text.substr(colon);
  }
  if (a.host.empty()) a.host = "127.0.0.1";
  if (a.host.find('/') != a.host.npos) failed(whole, "expected HOST:PORT");
  a.port = defaultPort;
  if (!port.empty()) {
    port.remove_prefix(1);
    if (!isNumber(port, a.port)) failed(whole, "a port is a number from 0 to 65535");
  }
  return a;
}

std::string Address::shown() const {
  if (ipc) return std::string(ipcScheme) + host;
  const bool six = host.find(':') != host.npos;
  return (six ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

bool Address::loopback() const {
  if (ipc || host == "localhost") return true;
  in_addr four;
  in6_addr six;
  if (v4(host, four)) return (ntohl(four.s_addr) >> 24) == 127;
  if (!v6(host, six)) return false;
  return IN6_IS_ADDR_LOOPBACK(&six) || (IN6_IS_ADDR_V4MAPPED(&six) && six.s6_addr[12] == 127);
}

bool Address::numeric() const {
  in_addr four;
  in6_addr six;
  return ipc || host == "localhost" || host == "*" || v4(host, four) || v6(host, six);
}

std::string Address::endpoint() const {
  if (ipc) return shown();
  if (host != "localhost") return std::string(tcpScheme) + shown();
  Address digits = *this;
  digits.host = "127.0.0.1";
  return digits.endpoint();
}

std::string shownEndpoint(std::string_view endpoint) {
  constexpr std::string_view mapped = "::ffff:";
  if (endpoint.starts_with(tcpScheme)) endpoint.remove_prefix(tcpScheme.size());
  const bool brackets = endpoint.starts_with('[');
  std::string_view rest = endpoint.substr(brackets);
  if (!rest.starts_with(mapped) || rest.find('.') == rest.npos) return std::string(endpoint);
  rest.remove_prefix(mapped.size());
  const size_t end = brackets ? rest.find(']') : rest.npos;
  return std::string(rest.substr(0, end)) +
         (end == rest.npos ? "" : std::string(rest.substr(end + 1)));
}

// Kept at a fixed address: getaddrinfo_a writes to it until the lookup is done.
struct Lookup::Request {
  std::string host;
  addrinfo hints{};
  gaicb block{};
};

Lookup::Lookup(const Address& address) : request_(std::make_unique<Request>()), address_(address) {
  request_->host = address.host;
  request_->hints.ai_socktype = SOCK_STREAM;
  request_->hints.ai_flags = AI_ADDRCONFIG;
  request_->block.ar_name = request_->host.c_str();
  request_->block.ar_request = &request_->hints;
  gaicb* list[] = {&request_->block};
  getaddrinfo_a(GAI_NOWAIT, list, 1, nullptr);
}

Lookup::~Lookup() {
  if (gai_error(&request_->block) == EAI_INPROGRESS &&
      gai_cancel(&request_->block) == EAI_NOTCANCELED) {
    static_cast<void>(request_.release()); // the lookup still writes to it
    return;
  }
  if (gai_error(&request_->block) == 0 && request_->block.ar_result)
    freeaddrinfo(request_->block.ar_result);
}

bool Lookup::ready() const { return gai_error(&request_->block) != EAI_INPROGRESS; }

std::optional<Address> Lookup::result(std::string& why) const {
  const int error = gai_error(&request_->block);
  char digits[NI_MAXHOST];
  const addrinfo* found = request_->block.ar_result;
  if (error != 0 || !found ||
      getnameinfo(found->ai_addr, found->ai_addrlen, digits, sizeof digits, nullptr, 0,
                  NI_NUMERICHOST) != 0) {
    why = error == 0 ? "unknown" : gai_strerror(error);
    return std::nullopt;
  }
  Address result = address_;
  result.host = digits;
  return result;
}

} // namespace openrt::cluster
