// listener.h: Listens at the address of --control and moves lines between sockets and the
// mailbox, on a thread of its own until it is destroyed.
#pragma once

#include <memory>
#include <string>

#include "control/address.h"
#include "control/keys.h"
#include "control/mailbox.h"

namespace vv::control {

class Listener {
 public:
  virtual ~Listener() = default;
  // Returns the address as a client of this machine gives it, with the port that was chosen.
  virtual std::string address() const = 0;
};

// Listens with plain sockets at an address of this machine, or with keys at any other one. Throws
// Failure if the address cannot be used, also if others can reach it and there are no keys. The
// mailbox must outlive it.
std::unique_ptr<Listener> listenAt(const Address& address, const KeyRing& keys, Mailbox& mailbox);

// The two kinds of listeners; listenAt() chooses.
//
// Lines over a stream: socket_listener.cpp. fd: a listening socket, which is taken over.
std::unique_ptr<Listener> listenPlain(int fd, const Address& address, uint16_t port,
                                      Mailbox& mailbox);
// Encrypted, each line a message of ZeroMQ: curve_listener.cpp.
std::unique_ptr<Listener> listenWithKeys(const Address& address, const KeyRing& keys,
                                         Mailbox& mailbox);

} // namespace vv::control
