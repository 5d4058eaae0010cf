// parser_recovery.cpp: messages of the parser, and how it goes on where a brace, a bracket or a
// name is missing or too much. What only skips text is in parser_skip.cpp. See parser.h.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "parse/parser.h"

namespace xvrml {

namespace {

// Statements that X3D has and VRML97 has not, and what a world lacks without them. Nothing that is
// seen depends on most of them.
struct X3dStatement {
  std::string_view keyword;
  const char* lost; // null: nothing
};
constexpr X3dStatement x3dStatements[] = {
    {"PROFILE", nullptr},
    {"COMPONENT", nullptr},
    {"META", nullptr},
    {"UNIT", "lengths and angles are taken as metres and radians"},
    {"IMPORT", "the name that it brings is unknown"},
    {"EXPORT", "the name stays the file's own"}};

const X3dStatement* x3dStatement(const Token& token) {
  if (!token.is(TokenKind::identifier)) return nullptr;
  const auto found =
      std::find_if(std::begin(x3dStatements), std::end(x3dStatements),
                   [&](const X3dStatement& one) { return one.keyword == token.text; });
  return found == std::end(x3dStatements) ? nullptr : found;
}

} // namespace

bool Parser::isX3dStatement(const Token& token) { return x3dStatement(token) != nullptr; }

// Says so if it is the keyword of a statement of X3D; skipToStatement() leaves the rest of it out.
bool Parser::leaveOutX3d(const Token& keyword) {
  const X3dStatement* statement = x3dStatement(keyword);
  if (!statement) return false;
  const std::string text =
      fmt::format("{} is a statement of X3D, not of VRML97: it is left out", statement->keyword);
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

// A name the grammar forbids but files use is taken with a warning: nothing else could be meant
// where only a name may stand.
bool Parser::name(Token& out, const char* what) {
  const Token token = lexer_.peek();
  out = lexer_.nextName();
  if (out.is(TokenKind::identifier)) return true;
  const bool control = std::any_of(out.text.begin(), out.text.end(),
                                   [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (!out.is(TokenKind::invalid) || control || (!out.text.empty() && out.text[0] == '"')) {
    lexer_.seek(token.at()); // a brace belongs to whoever counts them
    return fail(token, what);
  }
  lexer_.warn(out.at(), fmt::format("{} is not a name as VRML97 spells them (A.3)", describe(out)));
  return true;
}

// Ends the nodes that are open within what takes nodes here, as if their braces had been there.
void Parser::closeNodesBefore(const Token& at, std::string_view what) {
  Taker& taker = takers_.back();
  const size_t nodes = open_.size() - taker.nodes;
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
  keep_ = taker.nodes;
  // If it was no brace that was missing but something else, the braces are still to come: within
  // the list, or where it was ended too early, at the end of all.
  (at.is(TokenKind::bracketClose) ? takers_.front() : taker).braces += nodes;
}

// A node of a known type where a field is expected, which begins with this token: the brace before
// it is missing, unless what takes nodes here cannot hold it. False, with the token consumed, if it
// is something else.
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
  if (takers_.back().kind != Taker::Kind::interface &&
      sink_.wouldTake(takers_.back().receiver, named.text, use)) {
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

// Whether a node of a known type begins with the next token. Reads on and comes back.
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

// Whether a body follows whose opening brace is missing: a field of the type, or the closing brace.
bool Parser::bodyFollows(const Token& type) {
  const NodeType* known = sink_.typeNamed(type.text);
  const Token next = lexer_.peek();
  return known && (next.is(TokenKind::braceClose) ||
                   (next.is(TokenKind::identifier) && known->find(next.text)));
}

// Whether a list of nodes ends before this token, which stands where a node may: it is the next
// field of the node that has the list. The lexer then stands at the token again.
bool Parser::endsList(const Token& token, bool hasDef) {
  const Taker& taker = takers_.back();
  if (hasDef || taker.kind != Taker::Kind::list || open_.size() != taker.nodes) return false;
  if (!sink_.hasField(token.text) || sink_.typeNamed(token.text)) return false;
  lexer_.error(token.at(), fmt::format("']' is missing before {}", describe(token)));
  lexer_.seek(token.at());
  return listEnded_ = true;
}

// A closing brace in a list of nodes: the list ends before it.
bool Parser::closeListBefore(const Token& brace) {
  const Taker& around = takers_[takers_.size() - 2];
  if (around.kind == Taker::Kind::interface && around.nodes == open_.size())
    return fail(brace, "a node or ]"); // no node's list
  const SourcePosition begin = sink_.openNodePlace();
  lexer_.error(
      brace.at(),
      fmt::format("']' is missing before the '}}' of {}, which begins in line {}, column {}",
                  describe(open_.back()), begin.line, begin.column));
  ++takers_.front().braces;
  ++brackets_; // if it was this brace that was too many
  return true;
}

// What cannot begin a field. Braces and brackets are put right; after anything else the node is
// left out.
bool Parser::strayInBody(const Token& token) {
  if (token.is(TokenKind::bracketClose)) {
    if (takers_.back().kind != Taker::Kind::statements) {
      closeNodesBefore(token, "']'");
      ++brackets_; // if it was this bracket that was too many
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
  if (!token.is(TokenKind::braceOpen)) return false;
  lexer_.next();
  passBrace(true);
  return true;
}

// Passes over a brace or bracket that can begin no statement. False if the token is something else.
bool Parser::strayInStatements(const Token& token, TokenKind end) {
  constexpr auto expected = "a node, DEF, USE, PROTO, EXTERNPROTO or ROUTE";
  if (token.is(TokenKind::braceClose) && end != TokenKind::braceClose) {
    if (takers_.back().braces > 0)
      --takers_.back().braces;
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

// Behind a brace that opens nothing: it alone is passed over if what follows can stand here without
// it, else all that it holds.
void Parser::passBrace(bool inNode) {
  const Token next = lexer_.peek();
  Token type;
  if (!inNode && lexer_.accept(TokenKind::braceClose)) return;
  bool here = next.is("ROUTE") || next.is("PROTO") || next.is("EXTERNPROTO");
  if (inNode)
    here = here || next.is(TokenKind::braceClose) ||
           (next.is(TokenKind::identifier) && sink_.hasField(next.text)) ||
           (sink_.isScript() && declares(next));
  else
    here = here || next.is("USE") || (next.is(TokenKind::identifier) && nodeAhead(type));
  if (!here) return skipBlock();
  ++takers_.back().braces;
}

} // namespace xvrml
