// suffix.h: compares the ends of file names. Pure function.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace xvrml {

inline bool endsWithOneOf(std::string_view file, std::initializer_list<std::string_view> suffixes) {
  return std::any_of(suffixes.begin(), suffixes.end(),
                     [&](std::string_view suffix) { return file.ends_with(suffix); });
}

} // namespace xvrml
