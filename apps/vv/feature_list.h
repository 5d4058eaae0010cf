// feature_list.h: Implements --list-features. [main thread]
#pragma once

#include <string>

namespace vv {

// scriptPath: folders, separated by colons, searched before the default ones for script engines.
std::string listFeatures(const std::string& scriptPath, bool json);

} // namespace vv
