// parser.cpp: nodes, fields and routes of the VRML97 grammar (ISO/IEC 14772-1 Annex A.2).
// Prototypes are in parser_proto.cpp, error recovery in parser_recovery.cpp and parser_skip.cpp.
#include "parse/parser.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/x3d.h"
#include "nodes/registry.h"

namespace xvrml {

Parser::Parser(Lexer& lexer, const Limits& limits, ParseSink& sink, Budget* budget, bool x3d)
    : lexer_(lexer), values_(lexer, limits, budget), sink_(sink),
      nesting_(std::min(limits.nesting, maximumNesting)), x3d_(x3d) {
  if (x3d) values_.acceptLowerCase();
  values_.keepElements([this](const Token& word) {
    Token type;
    return sink_.hasField(word.text) || word.is("ROUTE") || word.is("PROTO") ||
           word.is("EXTERNPROTO") || declares(word) || nodeAhead(type);
  });
}

// vrmlScene ::= statements
void Parser::vrmlScene() { statements(TokenKind::end); }

// statements ::= statement | statement statements | empty
void Parser::statements(TokenKind end) {
  pushRecoveryPoint(RecoveryPoint::Kind::statements);
  while (!lexer_.peek().is(end) && !lexer_.peek().is(TokenKind::end)) {
    if (!strayInStatements(lexer_.peek(), end) && !statement()) skipToStatement(end);
  }
  recoveryPoints_.pop_back();
}

// statement ::= nodeStatement | protoStatement | routeStatement
bool Parser::statement() {
  const Token token = lexer_.peek();
  if (token.is("PROTO") || token.is("EXTERNPROTO")) return protoStatement();
  if (token.is("ROUTE")) return routeStatement();
  if (x3d_ && isX3dStatement(token)) return x3dStatement();
  if (token.is(TokenKind::identifier)) return nodeStatement();
  return fail(token, "a node, DEF, USE, PROTO, EXTERNPROTO or ROUTE");
}

// nodeStatement ::= node | DEF nodeNameId node | USE nodeNameId
bool Parser::nodeStatement() {
  const Token token = lexer_.peek();
  if (token.is("DEF")) {
    lexer_.next();
    Token def;
    if (!name(def, "a name after DEF")) return false;
    const Name named = def;
    if (!lexer_.peek().is(TokenKind::braceOpen)) return node(&named);
    lexer_.error(def.at(), fmt::format("expected a name after DEF before {}", describe(def)));
    lexer_.seek(def.at()); // the node exists, only its name is missing
    return node(nullptr);
  }
  if (token.is("USE")) {
    lexer_.next();
    Token use;
    if (!name(use, "a name after USE")) return false;
    sink_.useNode(use);
    return true;
  }
  return node(nullptr);
}

// node ::= nodeTypeId { nodeBody } | Script { scriptBody }; an ORTShader has a scriptBody, too.
bool Parser::node(const Name* def) {
  const Token type = lexer_.peek();
  if (!type.is(TokenKind::identifier)) return fail(type, "a node");
  lexer_.next();
  const bool opens = lexer_.peek().is(TokenKind::braceOpen);
  if (!opens) {
    if (leaveOutX3d(type) || endsList(type, def)) return false;
    fail(lexer_.peek(), fmt::format("{{ after {}", describe(type)));
    if (!bodyFollows(type)) return false; // else as if the brace were there
  }
  if (depth_ >= nesting_) {
    lexer_.error(type.at(),
                 fmt::format("nodes nested deeper than limit nesting={}{}; {} is left out",
                             nesting_, nesting_ == maximumNesting ? " (the most there can be)" : "",
                             describe(type)));
    if (def) sink_.lostName(*def);
    if (opens) lexer_.next();
    skipBlock();
    return true;
  }
  const bool known = sink_.openNode(type, def);
  if (opens) lexer_.next();
  if (known)
    openBody(type);
  else
    unknownNode(type);
  return true;
}

// Reads the body of a node that the sink has opened.
void Parser::openBody(const Token& type) {
  ++depth_;
  open_.push_back(type);
  const char* const begin = lexer_.consumed();
  nodeBody(type);
  open_.pop_back();
  if (open_.size() <= keep_) keep_ = SIZE_MAX;
  --depth_;
  sink_.placed(begin, lexer_.consumed());
  sink_.closeNode(true);
}

// Skips the body of a node that was not opened. A node of VRML97 whose type nobody knows may have a
// field `children`: a Group with these nodes then takes its place, if one may stand there. All its
// other fields are left out.
void Parser::unknownNode(const Token& type) {
  const nodes::AbsentNode* const absent = findAbsentNode(type.text);
  const bool ofX3d = absent && absent->origin.empty();
  const bool keeps = !x3d_ && !sink_.typeNamed(type.text) && !ofX3d &&
                     sink_.wouldAccept(sink_.nodeTarget(), "Group", false);
  bool atChildren = false;
  skipBlock('{', keeps ? &atChildren : nullptr);
  if (!atChildren) return;
  if (!sink_.openNode({"Group", type.at()}, nullptr)) return skipBlock();
  groups_.push_back(open_.size());
  openBody(type);
  groups_.pop_back();
}

// nodeBody ::= nodeBodyElement | nodeBodyElement nodeBody | empty
// Reads up to and including the closing brace. Text that cannot be read is left out up to the next
// field. If the text ends early, the open nodes keep what was read.
void Parser::nodeBody(const Token& type) {
  while (!isClosing() && !lexer_.accept(TokenKind::braceClose)) {
    if (lexer_.peek().is(TokenKind::end)) { return failAtEnd(type); }
    if (!nodeBodyElement()) skipToField();
  }
}

// nodeBodyElement ::= fieldId fieldValue | fieldId IS fieldId | eventInId IS eventInId
//                   | eventOutId IS eventOutId | routeStatement | protoStatement
bool Parser::nodeBodyElement() {
  const Token token = lexer_.peek();
  if (!token.is(TokenKind::identifier)) return strayInBody(token);
  if (token.text == "ROUTE") return routeStatement();
  if (token.text == "PROTO" || token.text == "EXTERNPROTO") return protoStatement();
  if (sink_.declaresFields() && declares(token)) return scriptBodyElement();
  return field();
}

bool Parser::field() {
  const Token id = lexer_.next();
  const bool foreign =
      !groups_.empty() && groups_.back() + 1 == open_.size() && id.text != "children";
  if (lexer_.peek().is("IS") && !foreign) {
    lexer_.next();
    Token interfaceName;
    if (!name(interfaceName, "a name of the prototype's interface after IS")) return false;
    sink_.connect(id, interfaceName);
    return true;
  }
  if ((lexer_.peek().is(TokenKind::braceOpen) || id.text == "DEF" || id.text == "USE") &&
      nodeInBody(id))
    return true;
  const FieldTarget target = foreign ? FieldTarget() : sink_.openField(id);
  if (!target.known) {
    skipField();
    return true;
  }
  const bool listOfValues = isMultiple(target.type) && target.type != FieldType::MFNode &&
                            lexer_.peek().is(TokenKind::bracketOpen);
  const char* const from = lexer_.cursor();
  bool good = fieldValue(target);
  if (good && target.stringLines)
    *target.stringLines = lexer_.linesOfStrings(from, lexer_.cursor());
  // If a known field follows, only the closing bracket of the list is missing, and its values are
  // kept.
  if (!good && listOfValues)
    good = lexer_.peek().is(TokenKind::identifier) && sink_.hasField(lexer_.peek().text);
  sink_.placed(from, lexer_.consumed());
  sink_.closeField(good);
  if (!good && listOfValues) skipRestOfList();
  const bool nodes = target.type == FieldType::SFNode || target.type == FieldType::MFNode;
  if (Token type; !good && nodes && nodeAhead(type)) { // it belongs to what is wrong
    for (Token token = lexer_.next(); !token.is(TokenKind::braceOpen); token = lexer_.next())
      noteLost(token);
    skipBlock();
  }
  return good;
}

// fieldValue ::= sfboolValue | sfcolorValue | ... | mfvec3fValue
bool Parser::fieldValue(const FieldTarget& target) {
  if (target.type == FieldType::SFNode) return nodeValue();
  if (target.type == FieldType::MFNode) return nodeValues();
  return values_.parse(target.type, target.storage);
}

// sfnodeValue ::= nodeStatement | NULL
bool Parser::nodeValue() {
  if (!lexer_.peek().is("NULL")) return nodeStatement();
  sink_.nullNode(lexer_.next());
  return true;
}

// mfnodeValue ::= nodeStatement | [ ] | [ nodeStatements ]
bool Parser::nodeValues() {
  if (!lexer_.accept(TokenKind::bracketOpen)) return nodeValue();
  pushRecoveryPoint(RecoveryPoint::Kind::list);
  const bool good = nodesOfList();
  recoveryPoints_.pop_back();
  return good;
}

bool Parser::nodesOfList() {
  while (!lexer_.accept(TokenKind::bracketClose)) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::end)) return true; // the node's body reports it
    if (token.is(TokenKind::identifier)) {
      if (strayStatement(token) || nodeValue()) continue;
      if (std::exchange(listEnded_, false)) return true;
      skipToNode();
    } else if (!token.is(TokenKind::braceClose)) {
      fail(token, "a node or ]");
      lexer_.next();
      if (token.is(TokenKind::braceOpen))
        passBrace(false);
      else if (!token.is(TokenKind::bracketOpen))
        skipToNode();
    } else if (recoveryPoints_.back().braces > 0) {
      --recoveryPoints_.back().braces;
      lexer_.next();
    } else {
      return closeListBefore(token);
    }
  }
  return true;
}

// routeStatement ::= ROUTE nodeNameId . eventOutId TO nodeNameId . eventInId
bool Parser::routeStatement() {
  const Token keyword = lexer_.next();
  Token from, fromField, to, toField;
  if (!routeEnd(from, fromField)) return false;
  if (!lexer_.peek().is("TO")) return fail(lexer_.peek(), "TO");
  lexer_.next();
  if (!routeEnd(to, toField)) return false;
  sink_.route(keyword, {from, fromField, to, toField});
  return true;
}

// nodeNameId . eventId
// A name with periods of its own, which DEF accepts with a warning, ends at the last period.
bool Parser::routeEnd(Token& node, Token& field) {
  const Token token = lexer_.nextName();
  if (!token.is(TokenKind::identifier) && !token.is(TokenKind::invalid))
    return fail(token, "NODE.event");
  const size_t period = token.text.rfind('.');
  if (period == std::string_view::npos) { // there is white space around the period
    node = token;
    if (!lexer_.accept(TokenKind::period)) {
      field = lexer_.peek(); // the period may be joined to the event's name
      if (!field.is(TokenKind::invalid) || field.text.size() < 2 || field.text[0] != '.')
        return fail(lexer_.peek(), "a period and an event");
      lexer_.nextName();
      field.text.remove_prefix(1);
      return true;
    }
    return name(field, "an event after the period");
  }
  node = {TokenKind::identifier, token.text.substr(0, period)};
  field = {TokenKind::identifier, token.text.substr(period + 1)};
  if (node.text.empty()) return fail(token, "a node's name before the period");
  if (field.text.empty()) return name(field, "an event after the period");
  return true;
}

} // namespace xvrml
