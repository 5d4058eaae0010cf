// world_start.h: Reads worlds and starts them according to the options, for pictures and for the
// window.
#pragma once

#include <memory>
#include <string>

#include "options/options.h"
#include "report/problems.h"
#include "xvrml/browser.h"

namespace vv {

// Reads a world; "-" is standard input. Throws xvrml::LoadError or Failure. [any thread]
std::unique_ptr<xvrml::World> readWorld(const std::string& path, const xvrml::LoadOptions& options);

// Starts the world at time 0 after options.epoch, with the changes of -D and --shader, and reports
// its problems. Throws Failure and UsageError. [the browser's thread]
std::unique_ptr<xvrml::Browser> startWorld(std::unique_ptr<xvrml::World> world,
                                           const Options& options, Problems& problems);

} // namespace vv
