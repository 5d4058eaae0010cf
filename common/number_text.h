// number_text.h: Reads numbers of command lines and of files of text, in one way: the whole text
// is a number, with a point whatever the locale, without blanks and without a plus sign. [any
// thread]
#pragma once

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <type_traits>

// Returns whether the whole text is a finite number of the type. If not, `value` keeps its value or
// has that of the number in front.
template <class T> bool isNumber(std::string_view text, T& value) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (text.empty() || read.ec != std::errc() || read.ptr != end) return false;
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
  return true;
}
