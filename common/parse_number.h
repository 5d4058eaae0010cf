// parse_number.h: a text that is a number from its first to its last character.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>

// Returns the number; nothing if the text is anything else, is not finite or is beyond what T
// holds. Blanks, a `+` sign and the format of a locale are not accepted.
template <class T> std::optional<T> parseNumber(std::string_view text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end) return {};
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) return {};
  return value;
}
