// range.h: the ranges that the standard prints behind a field, in the comment of its line: [0,1]
// (0,inf)  [-1,1],(-inf,inf) (0,inf) or -1  [0,pi/2]. Used by the reader of .node files.
#pragma once

#include <string>
#include <string_view>

#include "xvrml/node.h"

namespace xvrml::nodegen {

// True if a comment (without its #) is meant as a range: it begins with a bracket or a parenthesis.
bool looksLikeRange(std::string_view comment);

// Reads a range. Two ranges are taken for rotations: the first is of the axis, the second, of the
// angle, must be (-inf,inf). Returns an empty string, or what is wrong and sets `offset` to the
// byte it is at.
std::string parseRange(std::string_view comment, bool rotation, FieldRange& range, size_t& offset);

} // namespace xvrml::nodegen
