// lower_case.h: Compares text without the case of the letters A to Z, whatever the locale. [any
// thread]
#pragma once

#include <string>
#include <string_view>

constexpr char lowerCase(char c) { return c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c; }

inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = lowerCase(c);
  return lower;
}

// Returns whether `text` begins with `word`; the case of letters does not count.
constexpr bool beginsWithoutCase(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return false;
  for (size_t i = 0; i < word.size(); ++i)
    if (lowerCase(text[i]) != lowerCase(word[i])) return false;
  return true;
}
