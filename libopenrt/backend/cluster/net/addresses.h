// addresses.h: where a wire calls or listens: HOST[:PORT], a public key with it if the other side
// has one of its own; names looked up without waiting. Used by the Wire, on its thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace openrt::cluster {

struct Address {
  std::string host; // a name, or digits (no brackets); a path if ipc
  uint16_t port = 0;
  std::string key; // Z85; empty: one's own
  bool ipc = false;

  // HOST, HOST:PORT, [V6]:PORT, :PORT (loopback), ipc://PATH; followed by =KEY if there is one.
  // Throws std::runtime_error.
  static Address parse(std::string_view text);
  std::string shown() const; // HOST:PORT
  // On this machine beyond doubt: 127.0.0.0/8, ::1, localhost, ipc.
  bool loopback() const;
  bool numeric() const;         // nothing to look up
  std::string endpoint() const; // of ZeroMQ; numeric ones
};

// An address as ZeroMQ writes it, for people: without the scheme, and IPv4 as itself where a socket
// of IPv6 carries it.
std::string shownEndpoint(std::string_view endpoint);

// Looks a name up in the background.
class Lookup {
 public:
  explicit Lookup(const Address& address);
  ~Lookup();
  bool ready() const;
  // Once ready. Nothing: it is unknown; why: for people.
  std::optional<Address> result(std::string& why) const;

 private:
  struct Request;
  std::unique_ptr<Request> request_;
  Address address_;
};

} // namespace openrt::cluster
