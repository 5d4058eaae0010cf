// range.h: parses the ranges that the standard prints in the comment behind a field: [0,1]  (0,inf)
// [-1,1],(-inf,inf)  (0,inf) or -1  [0,pi/2]. Used by the reader of .node files.
#pragma once

#include <string>
#include <string_view>

#include "xvrml/node.h"

namespace xvrml::nodegen {

// Returns true if a comment (without its #) is meant as a range: it begins with a bracket or a
// parenthesis.
bool looksLikeRange(std::string_view comment);

// Parses a range. A rotation may have two: the first is for the axis; the second, for the angle,
// must be (-inf,inf). Returns "", or the error message and its byte position in `offset`.
std::string parseRange(std::string_view comment, bool rotation, FieldRange& range, size_t& offset);

} // namespace xvrml::nodegen
