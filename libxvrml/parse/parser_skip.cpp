// parser_skip.cpp: skips text after an error, and notes which names are lost. All functions are
// loops without recursion, so that a million open braces are skipped like any other text.
#include <string>

#include "parse/parser.h"

namespace xvrml {

namespace {

// Returns whether a field's value may end with such a token. Identifiers do not count, because they
// may be the name of a field.
bool endsValue(TokenKind kind) {
  return kind == TokenKind::braceClose || kind == TokenKind::bracketClose ||
         kind == TokenKind::number || kind == TokenKind::string;
}

// Returns the kind of the last token that skipOne() skips.
TokenKind lastOf(TokenKind first) {
  if (first == TokenKind::braceOpen) return TokenKind::braceClose;
  return first == TokenKind::bracketOpen ? TokenKind::bracketClose : first;
}

} // namespace

// Notes names defined in skipped text, so that later uses of them are not reported as errors.
void Parser::noteLost(const Token& token) {
  if (!token.is("DEF")) return;
  const Token lost = lexer_.peek();
  if (lost.is(TokenKind::identifier)) sink_.lostName(lost);
}

// Returns whether the next token is the field `children` of the node whose body is skipped, with a
// list or a node.
bool Parser::childrenFollow() {
  const Token field = lexer_.peek();
  if (!field.is("children")) return false;
  lexer_.next();
  Token type;
  const bool follow = lexer_.peek().is(TokenKind::bracketOpen) || lexer_.peek().is("USE") ||
                      (lexer_.peek().is(TokenKind::identifier) && nodeAhead(type));
  lexer_.seek(field.at());
  return follow;
}

// Skips from inside a block to behind its closing brace. kind and atChildren: see skipNested().
void Parser::skipBlock(char kind, bool* atChildren) {
  if (!skipNested(kind, recoveryPoints_.back().kind != RecoveryPoint::Kind::statements, atChildren))
    fail(lexer_.peek(), "}");
}

// Skips from behind an opening brace or bracket to behind its partner. opened: { the body of a
// node, s the body of a prototype, [ a list. Missing tokens are detected as in text that is parsed.
// These end the block, and are not consumed:
// - the end of the file, where the result is false;
// - a closing bracket of an enclosing list (inList);
// - a node where only a field is allowed;
// - a closing brace before a bracket's partner;
// - if atChildren is not null, the field `children` of the block itself; *atChildren becomes true.
bool Parser::skipNested(char opened, bool inList, bool* atChildren) {
  std::string open(1, opened);
  uint64_t lists = opened == '[', bodies = opened == 's'; // number of [ and of s in `open`
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
      if (atChildren && open.size() == 1 && childrenFollow()) return *atChildren = true;
      if (open.back() != '{' || !endsValue(previous) || !nodeAhead(type)) break;
      if (lists + bodies > 0)
        while (open.back() == '{') pop();
      else if (sink_.wouldAccept(recoveryPoints_.back().nodeTarget, type.text, false))
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

// Skips the value of an unknown field: up to the next known field of the node, the end of the node,
// or a node that cannot be part of the value.
void Parser::skipField() {
  const bool inList = recoveryPoints_.back().kind != RecoveryPoint::Kind::statements;
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

// Skips what is left of a field or statement that cannot be read, in the body of a node: up to
// something that may follow it there. The lexer is at or behind what is wrong.
void Parser::skipToField() {
  const bool inList = recoveryPoints_.back().kind != RecoveryPoint::Kind::statements;
  for (TokenKind previous = TokenKind::number;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end) || token.is(TokenKind::braceClose)) return;
    if (token.is(TokenKind::bracketClose) && inList) return;
    if (token.is(TokenKind::identifier)) {
      Token type;
      if (token.is("ROUTE") || token.is("PROTO") || token.is("EXTERNPROTO") ||
          sink_.hasField(token.text) || (sink_.declaresFields() && declares(token)))
        return;
      if (endsValue(previous) && nodeAhead(type)) return;
    }
    skipOne();
    previous = lastOf(token.kind);
  }
}

// Skips up to and including the bracket of a list of values that cannot be read. If it is missing,
// the list ends before a brace.
void Parser::skipRestOfList() { skipNested('[', true); }

// Skips what is left of a default value of a prototype's interface: up to the next declaration, the
// end of the interface, or the body.
void Parser::skipInterfaceValue() {
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end) || token.is(TokenKind::braceClose) ||
        token.is(TokenKind::braceOpen) || token.is(TokenKind::bracketClose) || declares(token))
      return;
    skipOne();
  }
}

// Skips a declaration of unknown type in a node: up to the node's next declaration or field, or its
// end. The rest of a Script still runs.
void Parser::skipDeclaration() {
  const bool inList = recoveryPoints_.back().kind != RecoveryPoint::Kind::statements;
  for (;;) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end) || token.is(TokenKind::braceClose)) return;
    if (token.is(TokenKind::bracketClose) && inList) return;
    if (declares(token) || (token.is(TokenKind::identifier) && sink_.hasField(token.text))) return;
    skipOne();
  }
}

// Skips a prototype after an error in its interface. Its body begins with the first brace that
// follows a bracket outside of any node of a default value. If a node follows a bracket, there is
// no body.
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

// Skips one token, or the whole block that it opens.
void Parser::skipOne() {
  const Token token = lexer_.next();
  if (token.is(TokenKind::braceOpen))
    skipNested('{', recoveryPoints_.back().kind != RecoveryPoint::Kind::statements);
  if (token.is(TokenKind::bracketOpen)) skipNested('[', true);
  noteLost(token);
}

// Skips to the next node of a list after an error, or to a token that may end the list.
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

// Skips to a token that may begin a statement. Blocks on the way are skipped as a whole.
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
