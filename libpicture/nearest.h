// nearest.h: Suggests the word that the user probably meant when one was mistyped. [any thread]
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace picture {

// Returns the word of `words` nearest to `word`; empty if none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& words);

} // namespace picture
