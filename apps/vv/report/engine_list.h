// engine_list.h: Implements --list-engines, which lists the installed script engines. [one thread]
#pragma once

#include <string>

namespace vv {

// scriptPath: folders, separated by colons, searched before the default ones. Prints a warning for
// each library that is not an engine.
std::string listEngines(const std::string& scriptPath, bool json);

} // namespace vv
