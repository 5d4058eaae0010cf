// parser_recovery.cpp: what the parser does after an error: where it goes on, and which names are lost. All loops, no recursion:
// a million open braces are skipped like any other text. See parser.h.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "parse/parser.h"

namespace xvrml {

namespace {

// Statements that X3D has and VRML97 has not, and what a world lacks without them. Nothing that is seen depends on most of them.
struct X3dStatement {
  std::string_view keyword;
  const char* lost; // null: nothing
};
constexpr X3dStatement x3dStatements[] = {{"PROFILE", nullptr},
                                          {"COMPONENT", nullptr},
                                          {"META", nullptr},
                                          {"UNIT", "lengths and angles are taken as metres and radians"},
                                          {"IMPORT", "the name that it brings is unknown"},
                                          {"EXPORT", "the name stays the file's own"}};

const X3dStatement* x3dStatement(const Token& token) {
  if (!token.is(TokenKind::identifier)) return nullptr;
  const auto found = std::find_if(std::begin(x3dStatements), std::end(x3dStatements),
                                  [&](const X3dStatement& one) { return one.keyword == token.text; });
  return found == std::end(x3dStatements) ? nullptr : found;
}

} // namespace

// Says so if it is the keyword of a statement of X3D; skipToStatement() leaves the rest of it out.
bool Parser::leaveOutX3d(const Token& keyword) {
  const X3dStatement* statement = x3dStatement(keyword);
  if (!statement) return false;
  const std::string text = fmt::format("{} is a statement of X3D, not of VRML97: it is left out", statement->keyword);
  if (statement->lost)
    lexer_.error(keyword.at(), fmt::format("{}; {}", text, statement->lost));
  else
    lexer_.warn(keyword.at(), text);
  return true;
}

bool Parser::fail(const Token& at, std::string_view expected) {
  if (at.is(TokenKind::end) && std::exchange(endReported_, true)) return false; // once is enough
  lexer_.error(at.at(), fmt::format("expected {}, found {}", expected, describe(at)));
  return false;
}

void Parser::failAtEnd(const Token& opened) {
  if (endReported_) return;
  const uint32_t line = lexer_.place(opened.at()).line;
  fail(lexer_.peek(), fmt::format("}} of {} opened in line {}", describe(opened), line));
}

// A name the grammar forbids but files use is taken with a warning: nothing else could be meant where only a name may stand.
bool Parser::name(Token& out, const char* what) {
  const Token token = lexer_.peek();
  out = lexer_.nextName();
  if (out.is(TokenKind::identifier)) return true;
  const bool control = std::any_of(out.text.begin(), out.text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (!out.is(TokenKind::invalid) || control || (!out.text.empty() && out.text[0] == '"')) {
    lexer_.seek(token.at()); // a brace belongs to whoever counts them
    return fail(token, what);
  }
  lexer_.warn(out.at(), fmt::format("{} is not a name as VRML97 spells them (A.3)", describe(out)));
  return true;
}

// Names defined in what is skipped: later uses of them are not errors of their own.
void Parser::noteLost(const Token& token) {
  if (!token.is("DEF")) return;
  const Token lost = lexer_.peek();
  if (lost.is(TokenKind::identifier)) sink_.lostName(lost);
}

// From inside a block to behind its closing brace.
void Parser::skipBlock() {
  for (uint64_t open = 1; open > 0;) {
    const Token token = lexer_.next();
    if (token.is(TokenKind::end)) {
      fail(token, "}");
      return;
    }
    if (token.is(TokenKind::braceOpen)) ++open;
    if (token.is(TokenKind::braceClose)) --open;
    noteLost(token);
  }
}

// The value of a field nobody knows: up to the next field of the node that is known, or the end of the node.
void Parser::skipField() {
  uint64_t braces = 0, brackets = 0;
  for (bool first = true;; first = false) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end)) return;
    if (braces == 0) {
      if (token.is(TokenKind::braceClose)) return;
      const bool statement = token.is("ROUTE") || token.is("PROTO") || token.is("EXTERNPROTO");
      if (!first && brackets == 0 && token.is(TokenKind::identifier) && (statement || sink_.hasField(token.text))) return;
    }
    lexer_.next();
    if (token.is(TokenKind::braceOpen)) ++braces;
    if (token.is(TokenKind::braceClose)) --braces;
    if (token.is(TokenKind::bracketOpen)) ++brackets;
    if (token.is(TokenKind::bracketClose) && brackets > 0) --brackets;
    noteLost(token);
  }
}

// A declaration in a Script whose type nobody knows: up to the next declaration or field of the Script, or its end. The rest of
// the Script still runs.
void Parser::skipDeclaration() {
  uint64_t open = 0;
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end)) return;
    if (open == 0 && token.is(TokenKind::braceClose)) return;
    const bool begins = token.is("field") || token.is("eventIn") || token.is("eventOut") || token.is("exposedField");
    if (open == 0 && token.is(TokenKind::identifier) && (begins || sink_.hasField(token.text))) return;
    lexer_.next();
    if (token.is(TokenKind::braceOpen) || token.is(TokenKind::bracketOpen)) ++open;
    if ((token.is(TokenKind::braceClose) || token.is(TokenKind::bracketClose)) && open > 0) --open;
    noteLost(token);
  }
}

// After an error in a prototype's interface: behind its body, which opens with the first brace that follows a bracket outside of
// any node of a default value.
void Parser::skipProto() {
  uint64_t braces = 0;
  bool afterBracket = false;
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end)) return;
    if (braces == 0 && token.is(TokenKind::braceClose)) return;
    if (braces == 0 && (token.is("PROTO") || token.is("EXTERNPROTO"))) return;
    lexer_.next();
    if (token.is(TokenKind::braceOpen)) {
      if (braces == 0 && afterBracket) return skipBlock();
      ++braces;
    }
    if (token.is(TokenKind::braceClose)) --braces;
    afterBracket = token.is(TokenKind::bracketClose);
  }
}

// To what looks like the start of a statement; blocks on the way are skipped whole.
void Parser::skipToStatement(TokenKind end) {
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end)) return;
    if (token.is(TokenKind::braceClose)) {
      if (end == TokenKind::braceClose) return;
      lexer_.next();
      continue;
    }
    if (token.is(TokenKind::identifier)) {
      if (token.text == "DEF" || token.text == "USE" || token.text == "PROTO" || token.text == "EXTERNPROTO" ||
          token.text == "ROUTE")
        return;
      const char* before = token.at();
      lexer_.next();
      const bool isNode = lexer_.peek().is(TokenKind::braceOpen) && isIdentifierStart(static_cast<unsigned char>(token.text[0]));
      if (isNode || x3dStatement(token)) return lexer_.seek(before);
      continue;
    }
    lexer_.next();
    if (token.is(TokenKind::braceOpen)) skipBlock();
  }
}

} // namespace xvrml
