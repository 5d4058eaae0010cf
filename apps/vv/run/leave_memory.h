// leave_memory.h: Says what vv leaves to the operating system when its process ends. Freeing a
// world of a million shapes object by object takes longer than reading it, and the process ends
// anyway. [main thread]
#pragma once

#include <memory>

#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

// Returns whether the nodes of the world, and what the renderer knows about its shapes, may be left
// to the operating system when the job is done. Everything that may have an end outside the process
// is ended as usual:
// * a world with Scripts, because they have processes and engines;
// * a world with node plug-ins, whose nodes may hold anything;
// * a world that is followed by another one (--watch);
// * machines of a cluster, recordings, and shaders with their plug-ins.
// Builds with sanitizers free everything, so that they find leaks.
bool leavesMemory(const Options& options, const xvrml::Browser& browser);

// From now on leavesMemory() returns false, because a node plug-in is loaded.
void freeAllMemory();

// Gives up an object without destroying it. Its memory stays reachable until the process ends.
void leave(std::shared_ptr<void> object);

} // namespace vv
