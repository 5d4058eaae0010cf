// parser_skip.cpp: where the parser goes on after an error that leaves something out, and which
// names are lost. All loops, no recursion: a million open braces are skipped like any other text.
// See parser.h.
#include <string>

#include "parse/parser.h"

namespace xvrml {

namespace {

// Whether a field's value may end with such a token. Words are left out: they may be the name of a
// field, too.
bool endsValue(TokenKind kind) {
  return kind == TokenKind::braceClose || kind == TokenKind::bracketClose ||
         kind == TokenKind::number || kind == TokenKind::string;
}

// The last token of what skipOne() passes over.
TokenKind lastOf(TokenKind first) {
  if (first == TokenKind::braceOpen) return TokenKind::braceClose;
  return first == TokenKind::bracketOpen ? TokenKind::bracketClose : first;
}

} // namespace

// Names defined in what is skipped: later uses of them are not errors of their own.
void Parser::noteLost(const Token& token) {
  if (!token.is("DEF")) return;
  const Token lost = lexer_.peek();
  if (lost.is(TokenKind::identifier)) sink_.lostName(lost);
}

// From inside a block to behind its closing brace; kind: as in skipNested().
void Parser::skipBlock(char kind) {
  if (!skipNested(kind, takers_.back().kind != Taker::Kind::statements)) fail(lexer_.peek(), "}");
}

// From behind an opening brace or bracket to behind its partner. opened: { the body of a node, s
// that of a prototype, [ a list. What is missing within is found out as in text that is read: the
// end of the file, a bracket of a list around it (inList), a node where only a field may stand, and
// a brace before a bracket's partner end it, and stay to be read. False at the end of the file.
bool Parser::skipNested(char opened, bool inList) {
  std::string open(1, opened);
  uint64_t lists = opened == '[', bodies = opened == 's'; // of [ and of s among them
  const auto pop = [&] {
    lists -= open.back() == '[';
    bodies -= open.back() == 's';
    open.pop_back();
  };
  TokenKind previous = TokenKind::invalid;
  while (!open.empty()) {
    const Token token = lexer_.peek();
    Token type;
    switch (token.kind) {
    case TokenKind::end: return false;
    case TokenKind::braceOpen:
      bodies += previous == TokenKind::bracketClose;
      open += previous == TokenKind::bracketClose ? 's' : '{';
      break;
    case TokenKind::bracketOpen:
      open += '[';
      ++lists;
      break;
    case TokenKind::bracketClose:
      if (lists == 0 && inList) return true;
      if (lists > 0) {
        while (open.back() != '[') pop();
        pop();
      }
      break;
    case TokenKind::braceClose:
      while (!open.empty() && open.back() == '[') pop();
      if (open.empty()) return true;
      pop();
      break;
    case TokenKind::identifier:
      if (open.back() != '{' || !endsValue(previous) || !nodeAhead(type)) break;
      if (lists + bodies > 0)
        while (open.back() == '{') pop();
      else if (sink_.wouldTake(takers_.back().receiver, type.text, false))
        return true;
      break;
    default: break;
    }
    previous = token.kind;
    lexer_.next();
    noteLost(token);
  }
  return true;
}

// The value of a field nobody knows: up to the next field of the node that is known, the end of the
// node, or a node that cannot be a part of the value.
void Parser::skipField() {
  const bool inList = takers_.back().kind != Taker::Kind::statements;
  TokenKind previous = TokenKind::invalid;
  for (;;) {
    const Token token = lexer_.peek();
    const bool first = previous == TokenKind::invalid;
    if (token.is(TokenKind::end) || token.is(TokenKind::braceClose)) return;
    if (token.is(TokenKind::bracketClose) && inList) return;
    if (token.is(TokenKind::identifier) && !first) {
      Token type;
      if (token.is("ROUTE") || token.is("PROTO") || token.is("EXTERNPROTO") ||
          sink_.hasField(token.text))
        return;
      if (endsValue(previous) && nodeAhead(type)) return;
    }
    skipOne();
    previous = lastOf(token.kind);
  }
}

// A declaration in a Script whose type nobody knows: up to the next declaration or field of the
// Script, or its end. The rest of the Script still runs.
void Parser::skipDeclaration() {
  const bool inList = takers_.back().kind != Taker::Kind::statements;
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end) || token.is(TokenKind::braceClose)) return;
    if (token.is(TokenKind::bracketClose) && inList) return;
    if (declares(token) || (token.is(TokenKind::identifier) && sink_.hasField(token.text))) return;
    skipOne();
  }
}

// After an error in a prototype's interface: behind its body, which opens with the first brace that
// follows a bracket outside of any node of a default value. A node that follows a bracket shows
// that there is no body.
void Parser::skipProto() {
  TokenKind previous = TokenKind::invalid;
  for (;;) {
    const Token token = lexer_.peek();
    Token type;
    if (token.is(TokenKind::end) || token.is(TokenKind::braceClose)) return;
    if (token.is("PROTO") || token.is("EXTERNPROTO")) return;
    const bool afterBracket = previous == TokenKind::bracketClose;
    if (afterBracket && token.is(TokenKind::identifier) && nodeAhead(type)) return;
    if (afterBracket && token.is(TokenKind::braceOpen)) {
      lexer_.next();
      return skipBlock('s');
    }
    skipOne();
    previous = lastOf(token.kind);
  }
}

// One token, or all that its brace or bracket holds.
void Parser::skipOne() {
  const Token token = lexer_.next();
  if (token.is(TokenKind::braceOpen))
    skipNested('{', takers_.back().kind != Taker::Kind::statements);
  if (token.is(TokenKind::bracketOpen)) skipNested('[', true);
  noteLost(token);
}

// After an error in a list of nodes: to the next node of it or to what may end it.
void Parser::skipToNode() {
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end) || token.is(TokenKind::braceClose) ||
        token.is(TokenKind::bracketClose))
      return;
    if (token.is("DEF") || token.is("USE") || token.is("NULL")) return;
    if (token.is(TokenKind::identifier)) {
      lexer_.next();
      if (lexer_.peek().is(TokenKind::braceOpen)) return lexer_.seek(token.at());
    } else {
      skipOne();
    }
  }
}

// To what looks like the start of a statement; blocks on the way are skipped whole.
void Parser::skipToStatement(TokenKind end) {
  bool afterBracket = false; // a brace then opens the body of a prototype
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end)) return;
    if (token.is(TokenKind::braceClose)) {
      if (end == TokenKind::braceClose) return;
      lexer_.next();
      continue;
    }
    if (token.is(TokenKind::identifier)) {
      if (token.text == "DEF" || token.text == "USE" || token.text == "PROTO" ||
          token.text == "EXTERNPROTO" || token.text == "ROUTE")
        return;
      const char* before = token.at();
      lexer_.next();
      const bool isNode = lexer_.peek().is(TokenKind::braceOpen) &&
                          isIdentifierStart(static_cast<unsigned char>(token.text[0]));
      if (isNode || isX3dStatement(token)) return lexer_.seek(before);
      continue;
    }
    lexer_.next();
    if (token.is(TokenKind::braceOpen)) skipBlock(afterBracket ? 's' : '{');
    afterBracket = token.is(TokenKind::bracketClose);
  }
}

} // namespace xvrml
