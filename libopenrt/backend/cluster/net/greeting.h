// greeting.h: who may work for whom: what master and worker must have in common so that their
// pictures are the same bytes. [any]
#pragma once

#include <string>

#include "backend/cluster/net/messages.h"

namespace openrt::cluster {

// What this process is, apart from its number of threads. local: as a local backend tells it (isa,
// kernel).
message::Hello identity(const RTstats& local);

// Empty, or why `worker` cannot work for `master`, both sides named; tolerant: another instruction
// set, version of the kernel, of the library or of the system's mathematics will do.
std::string difference(const message::Hello& worker, const message::Hello& master, bool tolerant);

} // namespace openrt::cluster
