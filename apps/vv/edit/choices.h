// choices.h: The words that a field of strings may hold. [any thread]
#pragma once

#include <string>
#include <vector>

#include "xvrml/node.h"

namespace vv {

// Returns the words in capitals that the documentation of an SFString or MFString begins with
// (docs/nodegen.md): "LINEAR or EXPONENTIAL growth". Empty if there are none. A file may have
// others.
std::vector<std::string> choicesOf(const xvrml::FieldInfo& field);

} // namespace vv
