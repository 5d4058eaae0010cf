// parser_recovery.cpp: the parser's messages, and how it continues if a brace, a bracket or a name
// is missing or superfluous. parser_skip.cpp skips text.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "parse/parser.h"

namespace xvrml {

namespace {

// Statements of X3D that VRML97 does not have, and what the world lacks without them. Most of them
// have no visible effect.
struct X3dStatement {
  std::string_view keyword;
  const char* lost; // null: nothing is lost
};
constexpr X3dStatement x3dStatements[] = {
    {"PROFILE", nullptr},
    {"COMPONENT", nullptr},
    {"META", nullptr},
    {"UNIT", "lengths and angles are taken as metres and radians"},
    {"IMPORT", "the imported name is unknown"},
    {"EXPORT", "the name is not exported"}};

const X3dStatement* findX3dStatement(const Token& token) {
  if (!token.is(TokenKind::identifier)) return nullptr;
  const auto found =
      std::find_if(std::begin(x3dStatements), std::end(x3dStatements),
                   [&](const X3dStatement& one) { return one.keyword == token.text; });
  return found == std::end(x3dStatements) ? nullptr : found;
}

} // namespace

bool Parser::isX3dStatement(const Token& token) { return findX3dStatement(token) != nullptr; }

// Reports the keyword of an X3D statement. skipToStatement() then skips the rest of it. Returns
// false for other keywords.
bool Parser::leaveOutX3d(const Token& keyword) {
  const X3dStatement* statement = findX3dStatement(keyword);
  if (!statement || x3d_) return false;
  const std::string text =
      fmt::format("{} is a statement of X3D, not of VRML97: it is left out", statement->keyword);
  if (statement->lost)
    lexer_.error(keyword.at(), fmt::format("{}; {}", text, statement->lost));
  else
    lexer_.warn(keyword.at(), text);
  return true;
}

bool Parser::fail(const Token& at, std::string_view expected) {
  // The end of the file is reported once.
  if (at.is(TokenKind::end) && std::exchange(endReported_, true)) return false;
  lexer_.error(at.at(), fmt::format("expected {}, found {}", expected, describe(at)));
  return false;
}

void Parser::failAtEnd(const Token& opened) {
  if (endReported_) return;
  const uint32_t line = lexer_.place(opened.at()).line;
  fail(lexer_.peek(), fmt::format("}} of {} opened in line {}", describe(opened), line));
}

// Reads a name. A name that the grammar forbids but files use is accepted with a warning, because
// nothing else could be meant here.
bool Parser::name(Token& out, const char* what) {
  const Token token = lexer_.peek();
  out = lexer_.nextName();
  if (out.is(TokenKind::identifier)) return true;
  const bool control = std::any_of(out.text.begin(), out.text.end(),
                                   [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (!out.is(TokenKind::invalid) || control || (!out.text.empty() && out.text[0] == '"')) {
    lexer_.seek(token.at()); // a brace is left to the caller, which counts braces
    return fail(token, what);
  }
  lexer_.warn(out.at(), fmt::format("{} is not a name as {} spells them (A.3)", describe(out),
                                    x3d_ ? "X3D" : "VRML97"));
  return true;
}

// Closes the nodes that are open within the innermost recovery point, as if their braces were
// there.
void Parser::closeNodesBefore(const Token& at, std::string_view what) {
  RecoveryPoint& point = recoveryPoints_.back();
  const size_t nodes = open_.size() - point.nodes;
  const SourcePosition begin = sink_.openNodePlace();
  const std::string more = nodes == 1 ? std::string()
                           : nodes == 2
                               ? ", nor is the node around it"
                               : fmt::format(", nor are the {} nodes around it", nodes - 1);
  lexer_.error(
      at.at(),
      fmt::format(
          "'}}' is missing before {}: {}, which begins in line {}, column {}, is not closed{}",
          what, describe(open_.back()), begin.line, begin.column, more));
  keep_ = point.nodes;
  // If something other than braces was missing, the braces still follow: within the list or, if a
  // list ended too early, at the end of the file.
  (at.is(TokenKind::bracketClose) ? recoveryPoints_.front() : point).braces += nodes;
}

// Handles a node of a known type where a field is expected; `first` is its first token. The brace
// before it counts as missing if the recovery point would accept the node; otherwise the node is
// left out. Returns false, with the token consumed, if no node follows.
bool Parser::nodeInBody(const Token& first) {
  if (sink_.hasField(first.text)) return false;
  lexer_.seek(first.at());
  const bool use = first.is("USE");
  Token named;
  bool node;
  if (use) {
    lexer_.next();
    named = lexer_.nextName();
    node = named.is(TokenKind::identifier);
    lexer_.seek(first.at());
  } else {
    node = nodeAhead(named);
  }
  if (!node) {
    lexer_.next();
    return false;
  }
  if (recoveryPoints_.back().kind != RecoveryPoint::Kind::interface &&
      sink_.wouldAccept(recoveryPoints_.back().nodeTarget, named.text, use)) {
    closeNodesBefore(first, fmt::format("the node {}", describe(named)));
    return true;
  }
  lexer_.error(first.at(), fmt::format("expected a field or }}, found the node {}: it is left out",
                                       describe(named)));
  if (use) {
    lexer_.next();
    lexer_.nextName();
    return true;
  }
  for (Token token = lexer_.next(); !token.is(TokenKind::braceOpen); token = lexer_.next())
    noteLost(token);
  skipBlock();
  return true;
}

// Returns whether a node of a known type begins with the next token. Reads ahead and seeks back.
bool Parser::nodeAhead(Token& type) {
  const char* const start = lexer_.peek().at();
  type = lexer_.next();
  if (type.is("DEF")) {
    lexer_.nextName();
    type = lexer_.next();
  }
  const bool ahead = type.is(TokenKind::identifier) && lexer_.peek().is(TokenKind::braceOpen) &&
                     sink_.typeNamed(type.text);
  lexer_.seek(start);
  return ahead;
}

// Returns whether a body without its opening brace follows: a field of the type, or the closing
// brace.
bool Parser::bodyFollows(const Token& type) {
  const NodeType* known = sink_.typeNamed(type.text);
  const Token next = lexer_.peek();
  return known && (next.is(TokenKind::braceClose) ||
                   (next.is(TokenKind::identifier) && known->find(next.text)));
}

// Returns whether a list of nodes ends before this token, because it is the next field of the node
// that has the list. The lexer is then at the token again.
bool Parser::endsList(const Token& token, bool hasDef) {
  const RecoveryPoint& point = recoveryPoints_.back();
  if (hasDef || point.kind != RecoveryPoint::Kind::list || open_.size() != point.nodes)
    return false;
  if (!sink_.hasField(token.text) || sink_.typeNamed(token.text)) return false;
  lexer_.error(token.at(), fmt::format("']' is missing before {}", describe(token)));
  lexer_.seek(token.at());
  return listEnded_ = true;
}

// Handles a closing brace in a list of nodes: the list ends before it.
bool Parser::closeListBefore(const Token& brace) {
  const RecoveryPoint& around = recoveryPoints_[recoveryPoints_.size() - 2];
  if (around.kind == RecoveryPoint::Kind::interface && around.nodes == open_.size())
    return fail(brace, "a node or ]"); // a list that belongs to no node
  const SourcePosition begin = sink_.openNodePlace();
  lexer_.error(
      brace.at(),
      fmt::format("']' is missing before the '}}' of {}, which begins in line {}, column {}",
                  describe(open_.back()), begin.line, begin.column));
  ++recoveryPoints_.front().braces;
  ++brackets_; // in case this brace is superfluous
  return true;
}

// Handles a token that cannot begin a field. Braces and brackets are corrected; any other token is
// left out.
bool Parser::strayInBody(const Token& token) {
  if (token.is(TokenKind::bracketClose)) {
    if (recoveryPoints_.back().kind != RecoveryPoint::Kind::statements) {
      closeNodesBefore(token, "']'");
      ++brackets_; // in case this bracket is superfluous
      return true;
    }
    if (brackets_ > 0)
      --brackets_;
    else
      fail(token, "a field or }");
    lexer_.next();
    return true;
  }
  fail(token, "a field or }");
  if (!token.is(TokenKind::braceOpen)) {
    skipOne();
    return false;
  }
  lexer_.next();
  passBrace(true);
  return true;
}

// Handles a statement in a list of nodes, where old exporters write routes between the nodes. The
// grammar does not allow it there (A.2), but its meaning is certain. Returns false for other words.
bool Parser::strayStatement(const Token& token) {
  const bool route = token.is("ROUTE"), proto = token.is("PROTO") || token.is("EXTERNPROTO");
  if (!route && !proto) return false;
  lexer_.error(token.at(),
               fmt::format("{} cannot stand in a list of nodes (A.2); it is kept", token.text));
  if (!(route ? routeStatement() : protoStatement())) skipToNode();
  return true;
}

// Skips a brace or bracket that cannot begin a statement. Returns false for other tokens.
bool Parser::strayInStatements(const Token& token, TokenKind end) {
  constexpr auto expected = "a node, DEF, USE, PROTO, EXTERNPROTO or ROUTE";
  if (token.is(TokenKind::braceClose) && end != TokenKind::braceClose) {
    if (recoveryPoints_.back().braces > 0)
      --recoveryPoints_.back().braces;
    else
      fail(token, expected);
    lexer_.next();
  } else if (token.is(TokenKind::bracketClose) && brackets_ > 0) {
    --brackets_;
    lexer_.next();
  } else if (token.is(TokenKind::braceOpen)) {
    fail(token, expected);
    lexer_.next();
    passBrace(false);
  } else {
    return false;
  }
  return true;
}

// Called after a brace that opens nothing. If the next token makes sense here, only the brace is
// skipped; otherwise the whole block.
void Parser::passBrace(bool inNode) {
  const Token next = lexer_.peek();
  Token type;
  if (!inNode && lexer_.accept(TokenKind::braceClose)) return;
  bool here = next.is("ROUTE") || next.is("PROTO") || next.is("EXTERNPROTO");
  if (inNode)
    here = here || next.is(TokenKind::braceClose) ||
           (next.is(TokenKind::identifier) && sink_.hasField(next.text)) ||
           (sink_.declaresFields() && declares(next));
  else
    here = here || next.is("USE") || (next.is(TokenKind::identifier) && nodeAhead(type));
  if (!here) return skipBlock();
  ++recoveryPoints_.back().braces;
}

} // namespace xvrml
