// numbers.cpp: finds numbers as ISO 10303-21, clause 6.4, spells them, outside of strings and
// comments.
#include "numbers.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "lower_case.h"

namespace xvrml::decoding {
namespace {

constexpr double most = 1e30;
constexpr size_t longestPlain = 25; // digits without an exponent that cannot reach `most`

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
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
        word();
      else
        step(1);
      if (!isBlank(c)) before_ = c;
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
  std::string_view takeWord() {
    const size_t begin = at_++;
    while (at_ < text_.size() && isNameCharacter(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  // Takes a keyword or an instance name. As a parameter, a word stands before a list.
  void word() {
    const bool isParameter = before_ == '(' || before_ == ',' || before_ == '-' || before_ == '+';
    const std::string_view word = takeWord();
    if (!isParameter || word[0] == '#') return;
    for (const std::string_view wrong : {"nan", "inf", "infinity"})
      if (word.size() == wrong.size() && beginsWithoutCase(word, wrong)) refuse(word);
  }

  void number() {
    const size_t begin = at_;
    const auto digits = [&] {
      while (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) ++at_;
    };
    digits();
    const bool hasExponent = at_ < text_.size() && (text_[at_] == 'E' || text_[at_] == 'e');
    bool isSmall = false;
    if (hasExponent) {
      ++at_;
      isSmall = at_ < text_.size() && text_[at_] == '-';
      if (at_ < text_.size() && (isSmall || text_[at_] == '+')) ++at_;
      digits();
    }
    const bool goesOn = at_ < text_.size() && (text_[at_] == '#' || isNameCharacter(text_[at_]));
    if (goesOn) takeWord(); // such as 1.#INF
    const std::string_view word = text_.substr(begin, at_ - begin);
    if (goesOn || !isDigit(word.back() == '.' ? word[0] : word.back())) refuse(word);
    if ((hasExponent && !isSmall) || word.size() > longestPlain) check(word);
  }

  void check(std::string_view word) const {
    std::string number(word);
    if (const size_t plus = number.find('+'); plus != number.npos) number.erase(plus, 1);
    double value = 0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), value);
    const bool isSmall = number.find('-') != number.npos; // a negative exponent
    if (read.ec == std::errc::result_out_of_range ? !isSmall : std::abs(value) > most) refuse(word);
  }

  [[noreturn]] void refuse(std::string_view word) const {
    constexpr size_t shown = 40;
    const bool isLong = word.size() > shown;
    throw std::runtime_error("line " + std::to_string(line_) +
                             ": a number up to 1e30 was expected, "
                             "not " +
                             std::string(word.substr(0, shown)) + (isLong ? "..." : ""));
  }

  std::string_view text_;
  size_t at_ = 0;
  uint64_t line_ = 1;
  char before_ = 0; // the first character of what stands before; blanks do not count
};

} // namespace

void checkNumbers(std::span<const uint8_t> file) {
  Scan({reinterpret_cast<const char*>(file.data()), file.size()}).run();
}

} // namespace xvrml::decoding
