// text_cursor.h: reads words and numbers of the texts of meshes, line by line. Numbers do not
// depend on the locale. [any thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/lexer.h"
#include "base/number.h"

namespace xvrml {

class TextCursor {
 public:
  // comment: begins a comment, also directly behind a number; 0: nothing does.
  explicit TextCursor(std::string_view text, char comment = 0)
      : p_(text.data()), end_(text.data() + text.size()), comment_(comment) {}

  const char* at() const { return p_; }
  const char* end() const { return end_; }
  bool atEnd() const { return p_ == end_; }
  // Skips blanks within the line.
  void skipBlanks() {
    while (p_ < end_ && isSpace(*p_) && *p_ != '\n' && *p_ != '\r') ++p_;
  }
  void skipSpace() { // blanks and line ends
    while (p_ < end_ && isSpace(*p_)) ++p_;
  }
  // Returns whether nothing but blanks is left of the line.
  bool atLineEnd() {
    skipBlanks();
    return p_ == end_ || *p_ == '\n' || *p_ == '\r';
  }
  // Moves to the beginning of the next line (LF, CR or CR LF).
  void nextLine() {
    while (p_ < end_ && *p_ != '\n' && *p_ != '\r') ++p_;
    if (p_ < end_ && *p_ == '\r') ++p_;
    if (p_ < end_ && *p_ == '\n') ++p_;
  }
  // Returns the next word of the line; empty at its end.
  std::string_view word() {
    skipBlanks();
    const char* from = p_;
    while (p_ < end_ && !isSpace(*p_)) ++p_;
    return {from, size_t(p_ - from)};
  }
  // Returns the rest of the line without blanks around it, and moves to its end.
  std::string_view rest() {
    skipBlanks();
    const char* from = p_;
    while (p_ < end_ && *p_ != '\n' && *p_ != '\r') ++p_;
    const char* to = p_;
    while (to > from && (to[-1] == ' ' || to[-1] == '\t')) --to;
    return {from, size_t(to - from)};
  }
  // Reads a number that ends at a blank or a comment. Returns false, and stays at it, if this is
  // none or it is out of range.
  template <class T> bool number(T& out) {
    skipBlanks();
    const char* q = p_;
    if (q < end_ && *q == '+') ++q;
    if (readNumber(q, end_, out) != NumberError::none || !endsNumber(q)) return false;
    p_ = q;
    return true;
  }
  void seek(const char* to) { p_ = to; }

  static bool isSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

 private:
  // "1.#INF" is no number with a comment.
  bool endsNumber(const char* at) const {
    if (at == end_ || isSpace(*at)) return true;
    return comment_ != 0 && *at == comment_ && !isNonFiniteSuffix({at, size_t(end_ - at)});
  }
  const char* p_;
  const char* end_;
  char comment_;
};

// Returns a keyword in lower case. No keyword has more than 20 letters.
inline std::string lowerKeyword(std::string_view word) {
  std::string lower(word.substr(0, 21));
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  return lower;
}

} // namespace xvrml
