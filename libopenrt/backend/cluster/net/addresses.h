// addresses.h: addresses that a wire calls or listens at: HOST[:PORT], with a public key if the
// other side has its own. Names are looked up in the background. Used by the Wire, on its thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace openrt::cluster {

struct Address {
  std::string host; // name or numeric address (no brackets); the path for ipc
  uint16_t port = 0;
  std::string key; // public key of the other side (Z85); empty: the same as ours
  bool ipc = false;

  // Reads HOST, HOST:PORT, [V6]:PORT, :PORT (loopback) or ipc://PATH, each with an optional =KEY.
  // Throws std::runtime_error.
  static Address parse(std::string_view text);
  std::string shown() const; // returns HOST:PORT
  // Returns true if the address is certainly on this machine: 127.0.0.0/8, ::1, localhost, ipc.
  bool loopback() const;
  bool numeric() const; // returns true if no lookup is needed
  // Returns the ZeroMQ endpoint of a numeric address.
  std::string endpoint() const;
};

// Formats a ZeroMQ endpoint for the user: without the scheme, and with IPv4 addresses mapped into
// IPv6 as plain IPv4.
std::string shownEndpoint(std::string_view endpoint);

// Looks up a name in the background.
class Lookup {
 public:
  explicit Lookup(const Address& address);
  ~Lookup();
  bool ready() const;
  // Call once ready. Returns nothing if the name is unknown; why: the reason, for the user.
  std::optional<Address> result(std::string& why) const;

 private:
  struct Request;
  std::unique_ptr<Request> request_;
  Address address_;
};

} // namespace openrt::cluster
