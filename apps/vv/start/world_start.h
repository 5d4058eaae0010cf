// world_start.h: Starts worlds according to the options, for pictures and for the
// window.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "options/options.h"
#include "report/problems.h"
#include "xvrml/browser.h"

namespace vv {

// Returns how worlds are read that are shown while their Inlines are still to come. Inlines are
// read with the world if an option needs all nodes. [any thread]
xvrml::LoadOptions loadOptionsForShowing(const Options& options);

// Tells whether a world is that of the command line, to which -D, --shader and --viewpoint refer.
// Worlds that it leads to need not have what they name. If the command line names none, every world
// is. [any thread]
bool isOfCommandLine(const Options& options, const xvrml::World& world);

// Receives a world before its Scripts begin.
using BeforeScripts = std::function<void(const xvrml::World&)>;

// Starts the world at time 0 after options.epoch, with the changes of -D and --shader if
// it is that of the command line, and reports its problems. before: receives the world with these
// changes; may be empty. If -D sends events, which only a world that runs can take, it receives the
// world after them. Throws Failure and UsageError. [the browser's thread]
std::unique_ptr<xvrml::Browser> startWorld(std::unique_ptr<xvrml::World> world,
                                           const Options& options, Problems& problems,
                                           const BeforeScripts& before = {});

} // namespace vv
