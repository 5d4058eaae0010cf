// assignments.cpp: Rewrites the program's assignments. `v = field` must copy, while `field.x = 1`
// must change the field (C.6.2). ECMAScript's getter cannot tell these apart, but the program's
// text can. The text is split into tokens. If a plain chain of names and indices is assigned, it is
// wrapped in a call that copies. Other text stays unchanged.
#include "assignments.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ecma {
namespace {

struct Token {
  enum class Kind : uint8_t { name, keyword, literal, sign } kind;
  uint32_t start, end;
  bool line; // a line ends before the token
};

bool isNameStart(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$' || (c & 0x80);
}
bool isNamePart(char c) { return isNameStart(c) || (c >= '0' && c <= '9'); }

bool isKeyword(std::string_view word) {
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

  // Returns whether a / begins a regular expression: this holds if no value precedes it.
  bool patternMayStand() const {
    if (list_.empty()) return true;
    const Token& last = list_.back();
    if (last.kind == Token::Kind::keyword)
      return text_.substr(last.start, last.end - last.start) != "this";
    if (last.kind != Token::Kind::sign) return false;
    const char c = text_[last.start];
    return c != ')' && c != ']' && c != '}';
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
};

struct Rewriter {
  std::string_view text;
  const std::unordered_set<std::string_view>& objects;
  std::vector<Token> tokens;

  std::string_view word(size_t i) const {
    return text.substr(tokens[i].start, tokens[i].end - tokens[i].start);
  }
  bool is(size_t i, std::string_view what) const { return i < tokens.size() && word(i) == what; }

  // Returns the index after the ] that matches the [ at i; 0 if there is none.
  size_t behindIndex(size_t i) const {
    // Maximum tokens of an index, so that many unclosed brackets do not cause quadratic time.
    constexpr size_t longest = 200;
    size_t depth = 0;
    for (const size_t last = std::min(tokens.size(), i + longest); i < last; ++i) {
      if (tokens[i].kind != Token::Kind::sign) continue;
      const char c = text[tokens[i].start];
      if (c == '[' || c == '(') ++depth;
      if ((c == ']' || c == ')') && --depth == 0) return c == ']' ? i + 1 : 0;
      if (c == '{' || c == '}' || c == ';') return 0;
    }
    return 0;
  }

  // Returns whether a property is a component or another number, and so not an object.
  static bool isNumber(std::string_view property) {
    static constexpr std::string_view names[] = {"x", "y",     "z",      "r",   "g",
                                                 "b", "angle", "length", "comp"};
    return std::find(std::begin(names), std::end(names), property) != std::end(names);
  }

  // Returns the end of the chain that begins at i, if it may name an object of a field; otherwise
  // 0.
  size_t chain(size_t i) const {
    if (i >= tokens.size() || tokens[i].kind != Token::Kind::name || word(i) == "Math") return 0;
    bool object = objects.contains(word(i));
    size_t end = i + 1;
    for (;;) {
      if (is(end, ".") && end + 1 < tokens.size() && tokens[end + 1].kind == Token::Kind::name) {
        object = !isNumber(word(end + 1));
        end += 2;
      } else if (is(end, "[")) {
        end = behindIndex(end);
        if (end == 0) return 0;
        object = true;
      } else {
        break;
      }
    }
    return object && endsExpression(end) ? end : 0;
  }

  bool endsExpression(size_t i) const {
    if (i >= tokens.size()) return true;
    const std::string_view next = word(i);
    if (next == ";" || next == "," || next == ")" || next == "}" || next == "]") return true;
    const bool beginsStatement =
        tokens[i].kind == Token::Kind::name ||
        (tokens[i].kind == Token::Kind::keyword && next != "in" && next != "instanceof");
    return tokens[i].line && beginsStatement;
  }

  std::string rewritten() const {
    std::string out;
    size_t copied = 0;
    for (size_t i = 0; i < tokens.size(); ++i) {
      const bool assigns = is(i, "=") && tokens[i].kind == Token::Kind::sign;
      const bool returns = is(i, "return") && tokens[i].kind == Token::Kind::keyword &&
                           i + 1 < tokens.size() && !tokens[i + 1].line;
      const size_t end = assigns || returns ? chain(i + 1) : 0;
      if (end == 0) continue;
      out.append(text, copied, tokens[i + 1].start - copied);
      out += "__xvrmlCopy(";
      out.append(text, tokens[i + 1].start, tokens[end - 1].end - tokens[i + 1].start);
      out += ')';
      copied = tokens[end - 1].end;
      i = end - 1;
    }
    return out.append(text, copied);
  }
};

} // namespace

std::string copyAssigned(std::string_view program,
                         const std::unordered_set<std::string_view>& objects) {
  return Rewriter{program, objects, Tokens(program).all()}.rewritten();
}

} // namespace ecma
