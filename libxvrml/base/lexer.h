// lexer.h: the tokens of VRML97 text (ISO/IEC 14772-1 Annex A). Tokens are views of the bytes;
// nothing is copied or stored, so the bytes must outlive the lexer. Used by the value parser, the
// file parser and nodegen. [one thread per lexer]
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/locator.h"

namespace xvrml {

enum class TokenKind : uint8_t {
  end,
  identifier,
  number,
  string,
  braceOpen,
  braceClose,
  bracketOpen,
  bracketClose,
  period,
  invalid
};

struct Token {
  TokenKind kind = TokenKind::end;
  // A string includes its quotes; the end token is empty, placed at the end of the text.
  std::string_view text;
  const char* at() const { return text.data(); }
  operator Name() const { return {text, at()}; }
  bool is(TokenKind k) const { return kind == k; }
  bool is(std::string_view keyword) const {
    return kind == TokenKind::identifier && text == keyword;
  }
};

namespace lexer_detail {
enum : uint8_t { space = 1, separator = 2 };
constexpr std::array<uint8_t, 256> makeClasses() {
  std::array<uint8_t, 256> classes{};
  for (const unsigned char c : {' ', '\n', '\t', '\r', ',', '\f', '\v'})
    classes[c] = space | separator;
  for (const unsigned char c : {'[', ']', '{', '}', '"', '#'}) classes[c] = separator;
  return classes;
}
inline constexpr auto classes = makeClasses();
} // namespace lexer_detail

// Returns whether c is white space or a comma.
constexpr bool isVrmlSpace(char c) {
  return lexer_detail::classes[static_cast<unsigned char>(c)] & lexer_detail::space;
}
// Returns whether a number or a word ends at c.
constexpr bool isVrmlSeparator(char c) {
  return lexer_detail::classes[static_cast<unsigned char>(c)] & lexer_detail::separator;
}
// Returns whether `rest`, right behind a number, is what the C library of old Windows programs adds
// to one that is not finite: -1.#IND00, 1.#INF, 1.#QNAN0. It is no comment.
bool isNonFiniteSuffix(std::string_view rest);
bool isIdentifierStart(unsigned char c); // returns whether c is an IdFirstChar (Annex A.3)
bool isIdentifierRest(unsigned char c);  // returns whether c is one of IdRestChars (Annex A.3)
bool isIdentifier(std::string_view text);

class Lexer {
 public:
  // Reads the locator's text, and reports its own messages there.
  explicit Lexer(Locator& locator);
  // Goes on with another text: a part of the locator's, or one that was decoded from it. It has no
  // comments.
  void enter(std::string_view text);

  const Token& peek() {
    if (!peeked_) lex();
    return token_;
  }
  Token next() {
    Token token = peek();
    peeked_ = false;
    return token;
  }
  bool accept(TokenKind kind) {
    if (peek().kind != kind) return false;
    peeked_ = false;
    return true;
  }
  // Reads the next token as a name where the grammar expects one. It accepts what real files
  // contain (1stRoom, a.b, it's) and the grammar forbids; such a token has the kind `invalid`.
  // Structure ({ } [ ] " and the end) is returned unchanged.
  Token nextName();
  // Returns the last comment skipped before the next token, without its #; empty if there was none.
  std::string_view comment() {
    peek();
    return comment_;
  }

  // Raw access for loops over big arrays. Returns the first byte not yet consumed; behind a token
  // that has been peeked at, the white space before it is passed.
  const char* cursor() const { return peeked_ ? token_.at() : position_; }
  // Returns the end of what has been consumed.
  const char* consumed() const { return peeked_ ? consumed_ : position_; }
  const char* end() const { return end_; }
  void seek(const char* position) {
    position_ = position;
    peeked_ = false;
  }
  // Returns the first position from p on that is not white space, a comma or a comment.
  const char* skipSpace(const char* p) {
    while (p < end_ && isVrmlSpace(*p)) ++p;
    return p < end_ && *p == '#' && comments_ ? skipComments(p) : p;
  }

  // Returns the lines of the strings in a part of the text.
  std::vector<uint32_t> linesOfStrings(const char* from, const char* to);
  SourcePosition place(const char* at) { return locator_.place(at); }
  void error(const char* at, std::string message) { locator_.error(at, std::move(message)); }
  void warn(const char* at, std::string message) { locator_.warn(at, std::move(message)); }
  Diagnostics& diagnostics() { return locator_.diagnostics(); }

 private:
  void lex();
  const char* skipComments(const char* p);
  const char* lexNumber(const char* p, bool& valid) const;
  const char* lexString(const char* p, bool& valid) const;

  Locator& locator_;
  const char* end_;
  const char* position_;
  const char* consumed_ = nullptr; // while a token is peeked at: the end of the one before it
  bool comments_ = true;
  Token token_;
  bool peeked_ = false;
  std::string_view comment_;
};

// Returns the description of a token for "found ..." in a message: 'word', the string "...", the
// end of the file.
std::string describe(const Token& token);

} // namespace xvrml
