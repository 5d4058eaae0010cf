// cage.h: what a process may do in which programs run that nobody trusts: compute, use its memory
// and its socket. Linux only.
#pragma once

#include <cstdint>
#include <string>

namespace xvrml {

// First of all: the process ends with its parent, at the other end of the socket; false if that has
// gone already.
bool bindToParent(long parent, int socket);
// From here on there are no files, sockets, threads or processes, and no way back. False, and why.
bool closeCage(std::string& why);
// Bytes of address space in use; 0 if it cannot be limited, as with the sanitizers, which reserve
// terabytes.
uint64_t addressSpace();

} // namespace xvrml
