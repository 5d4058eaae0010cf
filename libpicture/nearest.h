// nearest.h: what somebody who mistyped a word most likely meant. [any thread]
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace picture {

// The word of `words` nearest to `word`; empty if none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& words);

} // namespace picture
