// ending.h: Says what vv leaves to the operating system when its process ends. Freeing a world of a
// million shapes object by object takes longer than reading it, and the process ends anyway. [main
// thread]
#pragma once

#include <memory>

#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

// Returns whether the world and the renderer may be left to the operating system when the job is
// done. Everything that has an end outside the process is ended as usual:
// * processes of Scripts, and whatever else script engines hold;
// * machines of a cluster;
// * a world that is followed by another one (--watch).
// Builds with sanitizers free everything, so that they find leaks.
bool leavesMemory(const Options& options, const xvrml::Browser& browser);

// Gives up an object without destroying it. Its memory stays reachable until the process ends.
void leave(std::shared_ptr<void> object);

} // namespace vv
