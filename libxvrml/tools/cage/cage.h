// cage.h: the sandbox of a process that runs untrusted programs, or decodes untrusted files. It may
// compute, and use its memory and the socket. Linux only.
#pragma once

#include <cstdint>
#include <string>

namespace xvrml {

// Makes the process end with its parent, which holds the other end of the socket. Call it first.
// Returns false if the parent has ended already.
bool bindToParent(long parent, int socket);
// Enters the sandbox for good: no files, sockets, threads or processes from here on. Returns false,
// with the reason, on failure.
bool enterSandbox(std::string& why);
// Returns the bytes of address space in use; 0 if they cannot be limited, as with the sanitizers,
// which reserve terabytes.
uint64_t addressSpace();

} // namespace xvrml
