// greeting.h: Implements the handshake: compares what a master and a worker must have in common so
// that they render identical bytes. [any]
#pragma once

#include <string>

#include "backend/cluster/messages/messages.h"

namespace openrt::cluster {

// Returns the Hello of this process, without its number of threads. local: statistics of a local
// backend (isa, kernel).
message::Hello identity(const RTstats& local);

// Returns the Welcome of this version, with the heartbeat times that a Wire begins with.
message::Welcome usualWelcome(uint64_t session);

// Returns why `worker` cannot work for `master`, naming the values of both; empty if it can.
// tolerant: accepts another instruction set, and other versions of the kernel, the library and the
// system's math library.
std::string difference(const message::Hello& worker, const message::Hello& master, bool tolerant);

// Returns whether a machine can use this instruction set, if it is told to.
bool canUse(const message::Hello& machine, const std::string& isa);

} // namespace openrt::cluster
