// world_start.h: reads worlds, and brings them alive as the options ask for: what vv does before a
// picture and before a window.
#pragma once

#include <memory>
#include <string>

#include "options/options.h"
#include "report/problems.h"
#include "xvrml/browser.h"

namespace vv {

// "-": standard input. Throws xvrml::LoadError or Failure. [any thread]
std::unique_ptr<xvrml::World> readWorld(const std::string& path, const xvrml::LoadOptions& options);

// Brings the world alive at time 0 after options.epoch, with what -D and --shader change, and tells
// its problems. Throws Failure and UsageError. [the browser's thread]
std::unique_ptr<xvrml::Browser> startWorld(std::unique_ptr<xvrml::World> world,
                                           const Options& options, Problems& problems);

} // namespace vv
