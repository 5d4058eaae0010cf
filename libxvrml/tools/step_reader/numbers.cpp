// numbers.cpp: walks over the tokens of a STEP file. Strings and comments hold no numbers.
#include "numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "lower_case.h"

namespace xvrml::decoding {
namespace {

// A number without an exponent needs more digits than this to be beyond the range.
constexpr size_t fewDigits = 300;

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isOfName(char c) { return isDigit(c) || c == '_' || ((c | 32) >= 'a' && (c | 32) <= 'z'); }

// Returns the end of a token that begins with a digit.
size_t endOfNumber(std::string_view file, size_t at) {
  while (at < file.size() && (isDigit(file[at]) || file[at] == '.')) ++at;
  if (at == file.size() || (file[at] != 'E' && file[at] != 'e')) return at;
  ++at;
  if (at < file.size() && (file[at] == '+' || file[at] == '-')) ++at;
  while (at < file.size() && isDigit(file[at])) ++at;
  return at;
}

bool isFinite(std::string_view number) {
  if (number.size() < fewDigits && number.find_first_of("eE") == number.npos) return true;
  return std::isfinite(std::strtod(std::string(number).c_str(), nullptr));
}

// Programs write these words for numbers that are not finite, and also 1.#INF (printf of some C
// libraries). A word with the character `before` it is a parameter.
bool isNotFinite(std::string_view word, char before) {
  constexpr std::string_view around = "(,+-";
  if (around.find(before) == around.npos) return false;
  const std::string lower = lowerCase(word);
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

[[noreturn]] void refuse(std::string_view file, size_t at, std::string_view number) {
  constexpr size_t shown = 40;
  const auto line = 1 + std::count(file.begin(), file.begin() + std::ptrdiff_t(at), '\n');
  throw std::runtime_error(
      "Line " + std::to_string(line) + ": the number " + std::string(number.substr(0, shown)) +
      (number.size() > shown ? "..." : "") + " is out of range: expected at most 1.79E308");
}

} // namespace

void checkNumbers(std::string_view file) {
  char before = 0; // the last character that is no blank
  for (size_t at = 0; at < file.size();) {
    const size_t begin = at;
    const char c = file[at];
    if (c == '\'') {
      at = std::min(file.find('\'', at + 1), file.size() - 1) + 1;
    } else if (c == '/' && file.substr(at).starts_with("/*")) {
      at = std::min(file.find("*/", at + 2), file.size() - 1) + 1;
    } else if (isDigit(c)) {
      const size_t end = endOfNumber(file, at);
      const bool goesOn = end < file.size() && file[end] == '#';
      if (goesOn || !isFinite(file.substr(at, end - at)))
        refuse(file, at,
               file.substr(at, end - at + (goesOn ? std::string_view("#INF").size() : 0)));
      at = end;
    } else if (isOfName(c)) { // keywords may hold digits
      while (at < file.size() && isOfName(file[at])) ++at;
      const std::string_view word = file.substr(begin, at - begin);
      if (isNotFinite(word, before)) refuse(file, begin, word);
    } else {
      ++at;
    }
    if (c != ' ' && c != '\t' && c != '\r' && c != '\n') before = c;
  }
}

} // namespace xvrml::decoding
