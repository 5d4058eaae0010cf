// lexer.cpp: reads the tokens of VRML97 text.
#include "base/lexer.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace xvrml {
namespace {

// The characters of identifiers (Annex A.3): all but those below. Digits, + and - cannot start an
// identifier.
constexpr std::array<bool, 256> makeIdentifierRest() {
  std::array<bool, 256> table{};
  for (int c = 0x21; c < 256; ++c) table[c] = true;
  for (unsigned char c : {'"', '#', '\'', ',', '.', '[', '\\', ']', '{', '}', '\x7f'})
    table[c] = false;
  return table;
}
constexpr auto identifierRest = makeIdentifierRest();

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
constexpr bool isHexDigit(char c) {
  return isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}
const char* endOfLine(const char* p, const char* end) {
  while (p < end && *p != '\n' && *p != '\r') ++p;
  return p;
}

} // namespace

bool isNonFiniteSuffix(std::string_view rest) {
  return rest.starts_with("#IND") || rest.starts_with("#INF") || rest.starts_with("#QNAN") ||
         rest.starts_with("#SNAN");
}
bool isIdentifierRest(unsigned char c) { return identifierRest[c]; }
bool isIdentifierStart(unsigned char c) {
  return identifierRest[c] && !isDigit(static_cast<char>(c)) && c != '+' && c != '-';
}

bool isIdentifier(std::string_view text) {
  return !text.empty() && isIdentifierStart(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return isIdentifierRest(static_cast<unsigned char>(c)); });
}

Lexer::Lexer(Locator& locator)
    : locator_(locator), end_(locator.text().data() + locator.text().size()),
      position_(locator.text().data()) {}

void Lexer::enter(std::string_view text) {
  end_ = text.data() + text.size();
  comments_ = false;
  seek(text.data());
}

std::vector<uint32_t> Lexer::linesOfStrings(const char* from, const char* to) {
  std::vector<uint32_t> lines;
  for (const char* p = skipSpace(from); p < to; p = skipSpace(p + 1)) {
    if (*p != '"') continue;
    lines.push_back(place(p).line);
    for (++p; p < to && *p != '"'; ++p)
      if (*p == '\\') ++p;
  }
  return lines;
}

const char* Lexer::skipComments(const char* p) {
  for (; p < end_; ++p) {
    if (isVrmlSpace(*p)) continue;
    if (*p != '#') break;
    const char* stop = endOfLine(p, end_);
    comment_ = {p + 1, static_cast<size_t>(stop - p - 1)};
    p = stop - 1;
  }
  return p;
}

// float ::= ([+/-]?((([0-9]+(\.)?)|([0-9]*\.[0-9]+))([eE][+\-]?[0-9]+)?))
// int32 ::= ([+\-]?(([0-9]+)|(0[xX][0-9a-fA-F]+)))
const char* Lexer::lexNumber(const char* p, bool& valid) const {
  if (*p == '+' || *p == '-') ++p;
  const char* digits = p;
  if (end_ - p > 2 && p[0] == '0' && (p[1] == 'x' || p[1] == 'X') && isHexDigit(p[2])) {
    for (p += 2; p < end_ && isHexDigit(*p);) ++p;
  } else {
    while (p < end_ && isDigit(*p)) ++p;
    size_t count = p - digits;
    if (p < end_ && *p == '.') {
      const char* fraction = ++p;
      while (p < end_ && isDigit(*p)) ++p;
      count += p - fraction;
    }
    if (count == 0) valid = false;
    if (p < end_ && (*p == 'e' || *p == 'E')) {
      const char* exponent = p + 1;
      if (exponent < end_ && (*exponent == '+' || *exponent == '-')) ++exponent;
      if (exponent < end_ && isDigit(*exponent)) {
        for (p = exponent; p < end_ && isDigit(*p);) ++p;
      }
    }
  }
  if (p < end_ && *p == '#' && isNonFiniteSuffix({p, size_t(end_ - p)})) {
    valid = false;
    ++p;
  }
  if (p < end_ && !isVrmlSeparator(*p) && *p != '+' && *p != '-') valid = false;
  if (!valid) {
    while (p < end_ && !isVrmlSeparator(*p)) ++p;
  }
  return p;
}

// string ::= ".*" where double-quotes must be \", backslashes must be \\ (A.4)
const char* Lexer::lexString(const char* p, bool& valid) const {
  for (++p; p < end_; ++p) {
    if (*p == '"') return p + 1;
    if (*p == '\\' && p + 1 < end_) ++p;
  }
  valid = false;
  return end_;
}

void Lexer::lex() {
  comment_ = {};
  consumed_ = position_;
  const char* p = skipSpace(position_);
  const char* start = p;
  bool valid = true;
  TokenKind kind = TokenKind::end;
  if (p < end_) {
    const unsigned char c = static_cast<unsigned char>(*p);
    switch (c) {
    case '{':
      kind = TokenKind::braceOpen;
      ++p;
      break;
    case '}':
      kind = TokenKind::braceClose;
      ++p;
      break;
    case '[':
      kind = TokenKind::bracketOpen;
      ++p;
      break;
    case ']':
      kind = TokenKind::bracketClose;
      ++p;
      break;
    case '"':
      kind = TokenKind::string;
      p = lexString(p, valid);
      break;
    default:
      if (isIdentifierStart(c)) {
        kind = TokenKind::identifier;
        while (p < end_ && isIdentifierRest(static_cast<unsigned char>(*p))) ++p;
      } else if (c == '.' && !(p + 1 < end_ && isDigit(p[1]))) {
        kind = TokenKind::period;
        ++p;
      } else if (isDigit(*p) || c == '+' || c == '-' || c == '.') {
        kind = TokenKind::number;
        p = lexNumber(p, valid);
      } else {
        valid = false;
        do { // also a '#' where there are no comments
          ++p;
        } while (p < end_ && !isVrmlSeparator(*p));
      }
    }
  }
  token_ = {valid ? kind : TokenKind::invalid, {start, static_cast<size_t>(p - start)}};
  position_ = p;
  peeked_ = true;
}

Token Lexer::nextName() {
  const Token token = peek();
  switch (token.kind) {
  case TokenKind::identifier:
  case TokenKind::number:
  case TokenKind::period:
  case TokenKind::invalid: break;
  default: return next();
  }
  if (!token.text.empty() && token.text[0] == '"') return next(); // an unterminated string
  const char* p = token.at();
  while (p < end_ && !isVrmlSeparator(*p)) ++p;
  seek(p);
  const std::string_view text(token.at(), p - token.at());
  return {isIdentifier(text) ? TokenKind::identifier : TokenKind::invalid, text};
}

std::string describe(const Token& token) {
  if (token.kind == TokenKind::end) return "the end of the file";
  if (token.kind == TokenKind::invalid && !token.text.empty() && token.text[0] == '"')
    return "a string without its closing quote";
  if (token.kind == TokenKind::string) return fmt::format("the string {}", shortened(token.text));
  return describe(Name(token));
}

} // namespace xvrml
