// tokens.h: Splits the text of a program into the tokens of ECMAScript, for what looks at programs
// before they run. Text that is no such program gives some tokens, too. The texts of a template are
// literals; what stands in its ${ } is split.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

namespace ecma {

struct Token {
  enum class Kind : uint8_t { name, keyword, literal, sign } kind;
  uint32_t start, end;
  bool line; // a line ends before the token
};

inline bool isNameStart(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$' || (c & 0x80);
}
inline bool isNamePart(char c) { return isNameStart(c) || (c >= '0' && c <= '9'); }

inline bool isKeyword(std::string_view word) {
  static constexpr std::string_view words[] = {
      "break",   "case", "catch",    "continue", "default", "delete",     "do",   "else",
      "finally", "for",  "function", "if",       "in",      "instanceof", "new",  "return",
      "switch",  "this", "throw",    "try",      "typeof",  "var",        "void", "while",
      "with",    "true", "false",    "null",     "const"};
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) {}

  std::vector<Token> all() {
    while (skip()) {
      const size_t start = at_;
      list_.push_back({take(), uint32_t(start), uint32_t(at_), line_});
      line_ = false;
    }
    return std::move(list_);
  }

 private:
  char peek(size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  bool begins(std::string_view what) const { return text_.substr(at_).starts_with(what); }

  // Skips blanks and comments; returns false at the end.
  bool skip() {
    while (at_ < text_.size()) {
      if (begins("//") || begins("<!--") || (begins("-->") && (line_ || list_.empty()))) {
        at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      } else if (begins("/*")) {
        const size_t end = text_.find("*/", at_ + 2);
        line_ =
            line_ || text_.substr(at_, end == text_.npos ? end : end - at_).find_first_of("\r\n") !=
                         text_.npos;
        at_ = end == text_.npos ? text_.size() : end + 2;
      } else if (peek() == '\n' || peek() == '\r') {
        line_ = true;
        ++at_;
      } else if (peek() == ' ' || peek() == '\t' || peek() == '\v' || peek() == '\f') {
        ++at_;
      } else {
        return true;
      }
    }
    return false;
  }

  Token::Kind take() {
    const char c = peek();
    const size_t start = at_;
    if (isNameStart(c)) {
      while (isNamePart(peek())) ++at_;
      return isKeyword(text_.substr(start, at_ - start)) ? Token::Kind::keyword : Token::Kind::name;
    }
    if ((c >= '0' && c <= '9') || (c == '.' && peek(1) >= '0' && peek(1) <= '9')) {
      while (isNamePart(peek()) || peek() == '.' ||
             ((peek() == '+' || peek() == '-') && (text_[at_ - 1] | 0x20) == 'e'))
        ++at_;
      return Token::Kind::literal;
    }
    if (c == '"' || c == '\'') {
      quoted(c);
      return Token::Kind::literal;
    }
    if (c == '`' || (c == '}' && !templates_.empty() && templates_.back() == 0)) {
      if (c == '}') templates_.pop_back();
      if (templateText()) return Token::Kind::literal;
      at_ = start + 1; // it is no template: it may stand in a regular expression
      return Token::Kind::sign;
    }
    if (!templates_.empty() && (c == '{' || c == '}')) templates_.back() += c == '{' ? 1 : -1;
    if (c == '/' && patternMayStand()) {
      pattern();
      return Token::Kind::literal;
    }
    static constexpr std::string_view signs[] = {
        ">>>=", "===", "!==", ">>>", "<<=", ">>=", "==", "!=", "<=", ">=", "&&", "||",
        "++",   "--",  "+=",  "-=",  "*=",  "/=",  "%=", "&=", "|=", "^=", "=>"};
    for (const std::string_view sign : signs)
      if (begins(sign)) {
        at_ += sign.size();
        return Token::Kind::sign;
      }
    ++at_;
    return Token::Kind::sign;
  }

  void quoted(char quote) {
    for (++at_; at_ < text_.size() && peek() != quote && peek() != '\n'; ++at_)
      if (peek() == '\\') ++at_;
    at_ = std::min(at_ + 1, text_.size());
  }

  // Takes the text of a template up to its end, or to the next ${. Returns false if there is
  // neither.
  bool templateText() {
    for (++at_; at_ < text_.size(); ++at_) {
      if (peek() == '\\') {
        ++at_;
      } else if (peek() == '`') {
        ++at_;
        return true;
      } else if (begins("${")) {
        at_ += 2;
        templates_.push_back(0);
        return true;
      }
    }
    return false;
  }

  // Returns whether a / begins a regular expression: this holds if no value precedes it.
  bool patternMayStand() const {
    if (list_.empty()) return true;
    const Token& last = list_.back();
    if (last.kind == Token::Kind::keyword)
      return text_.substr(last.start, last.end - last.start) != "this";
    if (last.kind != Token::Kind::sign) return false;
    const char c = text_[last.start];
    return c != ')' && c != ']' && c != '}' && c != '`';
  }
  void pattern() {
    bool set = false;
    for (++at_; at_ < text_.size() && peek() != '\n' && (set || peek() != '/'); ++at_) {
      if (peek() == '\\') ++at_;
      if (peek() == '[') set = true;
      if (peek() == ']') set = false;
    }
    at_ = std::min(at_ + 1, text_.size());
    while (isNamePart(peek())) ++at_;
  }

  std::string_view text_;
  size_t at_ = 0;
  bool line_ = false;
  std::vector<Token> list_;
  std::vector<int> templates_; // open braces within each ${ } that is not closed
};

} // namespace ecma
