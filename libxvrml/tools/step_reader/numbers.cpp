// numbers.cpp: finds numbers as ISO 10303-21, clause 6.4, spells them, outside of strings and
// comments.
#include "numbers.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

namespace xvrml::decoding {
namespace {

constexpr double most = 1e30;
constexpr size_t longestPlain = 25; // digits without an exponent that cannot reach `most`

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isNameCharacter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  void run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\'' || c == '"')
        skipTo(std::string_view(&text_[at_], 1), 1);
      else if (text_.substr(at_, 2) == "/*")
        skipTo("*/", 2);
      else if (isDigit(c))
        number();
      else if (isNameCharacter(c) || c == '#')
        skipName();
      else
        step(1);
    }
  }

 private:
  void step(size_t count) {
    for (; count > 0 && at_ < text_.size(); --count) line_ += text_[at_++] == '\n';
  }
  // Skips what begins with `head` characters and has this end.
  void skipTo(std::string_view end, size_t head) {
    const size_t found = text_.find(end, at_ + head);
    step(found == text_.npos ? text_.size() : found + end.size() - at_);
  }
  void skipName() {
    ++at_;
    while (at_ < text_.size() && isNameCharacter(text_[at_])) ++at_;
  }

  void number() {
    const size_t begin = at_;
    const auto digits = [&] {
      while (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) ++at_;
    };
    digits();
    const bool hasExponent = at_ < text_.size() && (text_[at_] == 'E' || text_[at_] == 'e');
    if (!hasExponent && at_ - begin <= longestPlain) return;
    bool isSmall = false;
    if (hasExponent) {
      ++at_;
      isSmall = at_ < text_.size() && text_[at_] == '-';
      if (at_ < text_.size() && (isSmall || text_[at_] == '+')) ++at_;
      digits();
    }
    if (!isSmall) check(text_.substr(begin, at_ - begin));
  }

  void check(std::string_view word) const {
    std::string number(word);
    if (const size_t plus = number.find('+'); plus != number.npos) number.erase(plus, 1);
    double value = 0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), value);
    if (read.ec != std::errc::result_out_of_range && !(std::abs(value) > most)) return;
    constexpr size_t shown = 40;
    if (number.size() > shown) number = number.substr(0, shown) + "...";
    throw std::runtime_error("line " + std::to_string(line_) + ": " + number +
                             " is no number that a part can have: up to 1e30 was expected");
  }

  std::string_view text_;
  size_t at_ = 0;
  uint64_t line_ = 1;
};

} // namespace

void checkNumbers(std::span<const uint8_t> file) {
  Scan({reinterpret_cast<const char*>(file.data()), file.size()}).run();
}

} // namespace xvrml::decoding
