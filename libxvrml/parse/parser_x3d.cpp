// parser_x3d.cpp: the statements of X3D ClassicVRML that VRML97 does not have (ISO/IEC 19776-2
// Annex A.2). Each function begins behind the statement's keyword.
#include <charconv>

#include <fmt/format.h>

#include "parse/parser.h"

namespace xvrml {

// profileStatement | componentStatement | unitStatement | metaStatement | importStatement
// | exportStatement
bool Parser::x3dStatement() {
  const Token keyword = lexer_.next();
  if (keyword.text == "COMPONENT") return componentStatement();
  if (keyword.text == "META") return metaStatement(keyword);
  if (keyword.text == "UNIT") return unitStatement();
  if (keyword.text == "IMPORT") return importStatement(keyword);
  if (keyword.text == "EXPORT") return exportStatement();
  Token profile;
  if (!name(profile, "the name of a profile")) return false;
  sink_.profile(profile);
  return true;
}

// componentStatement ::= COMPONENT componentNameId : componentSupportLevel
// Files also have white space around the colon.
bool Parser::componentStatement() {
  const Token token = lexer_.nextName();
  if (!token.is(TokenKind::identifier)) return fail(token, "the name of a component");
  const size_t colon = token.text.find(':');
  std::string_view level;
  if (colon != std::string_view::npos) {
    level = token.text.substr(colon + 1);
  } else {
    const Token mark = lexer_.peek();
    if (!mark.text.starts_with(':')) return fail(mark, ": and the level of the component");
    level = lexer_.nextName().text.substr(1);
  }
  Token number{TokenKind::number, level};
  if (level.empty()) number = lexer_.nextName();
  int32_t value = 0;
  const char* const end = number.text.data() + number.text.size();
  const auto read = std::from_chars(number.text.data(), end, value);
  if (number.text.empty() || read.ec != std::errc() || read.ptr != end)
    return fail(number, "the level of the component, an integer");
  sink_.component({token.text.substr(0, colon), token.at()}, value);
  return true;
}

// metaStatement ::= META metakey metavalue
bool Parser::metaStatement(const Token& keyword) {
  std::string key, content;
  if (!values_.parse(FieldType::SFString, &key) || !values_.parse(FieldType::SFString, &content))
    return false;
  sink_.meta(keyword, std::move(key), std::move(content));
  return true;
}

// unitStatement ::= UNIT categoryName unitName unitConversionFactor
bool Parser::unitStatement() {
  Token category, unit;
  if (!name(category, "the category of a unit") || !name(unit, "the name of a unit")) return false;
  double factor = 1;
  if (!values_.parse(FieldType::SFTime, &factor)) return false;
  sink_.unit(category, unit, factor);
  return true;
}

// importStatement ::= IMPORT inlineNodeNameId . exportedNodeNameId [AS nodeNameId]
bool Parser::importStatement(const Token& keyword) {
  Token inlineName, exported, local;
  if (!routeEnd(inlineName, exported)) return false;
  local = exported;
  if (lexer_.peek().is("AS")) {
    lexer_.next();
    if (!name(local, "a name after AS")) return false;
  }
  sink_.importNode(keyword, {inlineName, exported, local});
  return true;
}

// exportStatement ::= EXPORT nodeNameId [AS exportedNodeNameId]
bool Parser::exportStatement() {
  Token node, exported;
  if (!name(node, "the name of a node")) return false;
  exported = node;
  if (lexer_.peek().is("AS")) {
    lexer_.next();
    if (!name(exported, "a name after AS")) return false;
  }
  sink_.exportNode(node, exported);
  return true;
}

} // namespace xvrml
