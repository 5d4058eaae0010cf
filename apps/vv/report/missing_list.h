// missing_list.h: Lists the parts that a world lacks because their files cannot be read. [any
// thread]
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "libpicture/missing_parts.h"

namespace vv {

// Returns what to tell of missing parts: each with its path of DEF names and its url. boxes: how
// many placeholders stand for them. all: lists every part, not the first few.
std::string missingText(const std::vector<picture::MissingPart>& parts, size_t boxes, bool all);

} // namespace vv
