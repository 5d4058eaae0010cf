// engine_list.h: the script engines that are installed, for --list-engines. [one thread]
#pragma once

#include <string>

namespace vv {

// scriptPath: folders, separated by colons, before the usual ones. Libraries that are no engines
// are warned of.
std::string listEngines(const std::string& scriptPath, bool json);

} // namespace vv
