// help.h: Makes what `vv --help` prints. [main thread]
#pragma once

#include <string>
#include <string_view>

namespace vv {

// Returns the text about a topic: a group of options, "exit codes", an option, or "all". "": the
// short text. Throws UsageError for any other word.
std::string helpText(std::string_view topic);

} // namespace vv
