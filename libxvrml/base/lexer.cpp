// lexer.cpp: reads the tokens of VRML97 text and finds the positions of messages.
#include "base/lexer.h"

#include <algorithm>
#include <array>
#include <cstring>

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
constexpr bool isContinuationByte(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

uint32_t countCharacters(const char* from, const char* to) {
  return static_cast<uint32_t>(
      std::count_if(from, to, [](char c) { return !isContinuationByte(c); }));
}

// Returns the number of line ends (LF, CR or CR LF) in [from, to). Blocks are small enough for byte
// sums, so that compilers vectorise the loop.
uint32_t countLines(const char* from, const char* to, const char* end) {
  if (from < to && to == end)
    // to[0] cannot be read.
    return countLines(from, to - 1, end) + (to[-1] == '\n' || to[-1] == '\r');
  uint32_t lines = 0;
  while (from < to) {
    const ptrdiff_t block = std::min<ptrdiff_t>(to - from, 240);
    uint8_t sum = 0;
    for (ptrdiff_t i = 0; i < block; ++i)
      sum += (from[i] == '\n') | ((from[i] == '\r') & (from[i + 1] != '\n'));
    lines += sum;
    from += block;
  }
  return lines;
}

const char* startOfLine(const char* p, const char* begin, const char* end) {
  while (p > begin && p[-1] != '\n' && !(p[-1] == '\r' && (p == end || *p != '\n'))) --p;
  return p;
}

const char* endOfLine(const char* p, const char* end) {
  while (p < end && *p != '\n' && *p != '\r') ++p;
  return p;
}

} // namespace

bool isIdentifierRest(unsigned char c) { return identifierRest[c]; }
bool isIdentifierStart(unsigned char c) {
  return identifierRest[c] && !isDigit(static_cast<char>(c)) && c != '+' && c != '-';
}

bool isIdentifier(std::string_view text) {
  return !text.empty() && isIdentifierStart(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return isIdentifierRest(static_cast<unsigned char>(c)); });
}

Lexer::Lexer(std::string_view bytes, std::shared_ptr<const std::string> file,
             Diagnostics& diagnostics)
    : begin_(bytes.data()), end_(bytes.data() + bytes.size()), position_(begin_),
      file_(std::move(file)), diagnostics_(diagnostics), mark_(begin_) {}

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
        while (p < end_ && !isVrmlSeparator(*p)) ++p;
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

SourcePosition Lexer::place(const char* at) {
  const char* from = std::min(at, mark_);
  const char* to = std::max(at, mark_);
  const uint32_t lines = countLines(from, to, end_);
  line_ = at >= mark_ ? line_ + lines : line_ - lines;
  if (lines > 0) {
    column_ = countCharacters(startOfLine(at, begin_, end_), at) + 1;
  } else {
    const uint32_t characters = countCharacters(from, to);
    column_ = at >= mark_ ? column_ + characters : column_ - characters;
  }
  mark_ = at;
  return {file_, line_, column_};
}

void Lexer::report(Severity severity, const char* at, std::string message) {
  if (!diagnostics_.keeps(severity)) { // it is only counted, so its line is not needed
    diagnostics_.add({severity, {}, 0, 0, {}, {}, 0});
    return;
  }
  const SourcePosition where = place(at);
  // A very long line is shown as a window around the position, cut between characters.
  constexpr ptrdiff_t before = 100, after = 80;
  const char* from = startOfLine(at, at - begin_ > before ? at - before : begin_, end_);
  while (from < at && isContinuationByte(*from)) ++from;
  const char* to = endOfLine(at, end_ - at > after ? at + after : end_);
  while (to < end_ && to > at && isContinuationByte(*to)) --to;
  diagnostics_.add({severity, file_ ? *file_ : std::string(), where.line, where.column,
                    std::move(message), std::string(from, to), countCharacters(from, at) + 1});
}

std::string describe(const Token& token) {
  if (token.kind == TokenKind::end) return "the end of the file";
  constexpr size_t shown = 40;
  std::string_view text = token.text;
  std::string_view more;
  if (text.size() > shown) {
    size_t cut = shown;
    while (cut > 0 && isContinuationByte(text[cut])) --cut;
    text = text.substr(0, cut);
    more = "...";
  }
  if (token.kind == TokenKind::invalid && !token.text.empty() && token.text[0] == '"')
    return "a string without its closing quote";
  if (token.kind == TokenKind::string) return fmt::format("the string {}{}", text, more);
  if (text.size() == 1 && static_cast<unsigned char>(text[0]) < 0x20) {
    return fmt::format("the control character 0x{:02x}", static_cast<unsigned>(text[0]));
  }
  return fmt::format("'{}{}'", text, more);
}

} // namespace xvrml
