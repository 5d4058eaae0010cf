// parser_proto.cpp: prototypes, interface declarations and Script bodies of the VRML97 grammar
// (Annex A.2).
#include <algorithm>

#include <fmt/format.h>

#include "base/x3d.h"
#include "parse/parser.h"

namespace xvrml {

namespace {

constexpr Access accesses[] = {Access::field, Access::exposedField, Access::eventIn,
                               Access::eventOut};

} // namespace

// Returns whether a token begins a declaration of an interface.
bool Parser::declares(const Token& token) const {
  return token.is(TokenKind::identifier) &&
         std::any_of(std::begin(accesses), std::end(accesses), [&](Access access) {
           return token.text == accessName(access) || (x3d_ && token.text == x3dAccessName(access));
         });
}

// Reads what a word says about an access. Returns false for other words.
bool Parser::readAccess(const Token& keyword, Access& access) {
  if (!declares(keyword)) return false;
  for (const Access one : accesses)
    if (keyword.text == accessName(one) || keyword.text == x3dAccessName(one)) access = one;
  if (x3d_ && keyword.text == accessName(access))
    lexer_.warn(keyword.at(), fmt::format("{} is VRML97's word: X3D writes {}", describe(keyword),
                                          x3dAccessName(access)));
  return true;
}

// fieldType ::= MFBool | MFColor | ... | SFVec4f
// In a file of VRML97, a type that only X3D has is read with a warning, once for each type.
bool Parser::fieldType(FieldType& type) {
  const Token token = lexer_.peek();
  if (!token.is(TokenKind::identifier) || !fieldTypeFromName(token.text, type))
    return fail(token, "a field type");
  lexer_.next();
  if (!x3d_ && !isVrml97Type(type) && !foreignTypes_.test(size_t(type))) {
    foreignTypes_.set(size_t(type));
    lexer_.warn(token.at(), fmt::format("{} is a type of X3D: other browsers of VRML97 do not know "
                                        "it",
                                        token.text));
  }
  return true;
}

// protoStatement ::= proto | externproto
bool Parser::protoStatement() {
  const Token keyword = lexer_.next();
  if (depth_ >= nesting_) {
    lexer_.error(keyword.at(),
                 fmt::format("prototypes nested deeper than limit nesting={}", nesting_));
    return false;
  }
  ++depth_;
  const bool good = keyword.text == "PROTO" ? proto() : externproto();
  --depth_;
  return good;
}

// proto ::= PROTO nodeTypeId [ interfaceDeclarations ] { protoBody }
bool Parser::proto() {
  Token id;
  if (!name(id, "a name after PROTO")) return false;
  sink_.openProto(id);
  const bool good = interfaceDeclarations(false);
  if (!good || !lexer_.peek().is(TokenKind::braceOpen)) {
    if (good) fail(lexer_.peek(), "{ and the prototype's body");
    sink_.closeProto(false);
    sink_.lostName(id);
    if (!good) skipProto();
    return true;
  }
  // protoBody ::= protoStatements rootNodeStatement statements
  lexer_.next();
  sink_.openProtoBody();
  statements(TokenKind::braceClose);
  if (!lexer_.accept(TokenKind::braceClose)) failAtEnd(id);
  sink_.placed(id.at(), lexer_.consumed());
  sink_.closeProto(true);
  return true;
}

// externproto ::= EXTERNPROTO nodeTypeId [ externInterfaceDeclarations ] URLList
bool Parser::externproto() {
  Token id;
  if (!name(id, "a name after EXTERNPROTO")) return false;
  sink_.openExternProto(id);
  bool good = interfaceDeclarations(true);
  if (good) good = values_.parse(FieldType::MFString, &sink_.externUrls());
  sink_.placed(id.at(), lexer_.consumed());
  sink_.closeExternProto(good);
  if (!good) sink_.lostName(id);
  return good;
}

// interfaceDeclarations ::= interfaceDeclaration
//                         | interfaceDeclaration interfaceDeclarations | empty
// Reads the brackets, too.
bool Parser::interfaceDeclarations(bool isExtern) {
  if (!lexer_.accept(TokenKind::bracketOpen)) {
    fail(lexer_.peek(), "[ and the interface");
    if (!declares(lexer_.peek())) return false;
  }
  pushRecoveryPoint(RecoveryPoint::Kind::interface);
  bool good = true;
  while (good && !lexer_.accept(TokenKind::bracketClose)) {
    const Token token = lexer_.peek();
    const bool ends = isExtern ? token.is(TokenKind::string) || token.is(TokenKind::bracketOpen)
                               : token.is(TokenKind::braceOpen);
    if (ends) {
      lexer_.error(token.at(), fmt::format("']' is missing before {}",
                                           isExtern ? "the URLs" : "the prototype's body"));
      break;
    }
    good = interfaceDeclaration(isExtern);
  }
  recoveryPoints_.pop_back();
  return good;
}

// interfaceDeclaration ::= restrictedInterfaceDeclaration
//                        | exposedField fieldType fieldId fieldValue
// restrictedInterfaceDeclaration ::= eventIn fieldType eventInId | eventOut fieldType eventOutId
//                                  | field fieldType fieldId fieldValue
// externInterfaceDeclaration: the same without values
bool Parser::interfaceDeclaration(bool isExtern) {
  const Token keyword = lexer_.peek();
  Access access{};
  if (!readAccess(keyword, access)) {
    return fail(keyword, x3d_ ? "inputOnly, outputOnly, initializeOnly, inputOutput or ]"
                              : "eventIn, eventOut, field, exposedField or ]");
  }
  lexer_.next();
  FieldType type;
  if (!fieldType(type)) return false;
  Token id;
  if (!name(id, "a name for the interface")) return false;
  const bool hasValue = !isExtern && (access == Access::field || access == Access::exposedField);
  const FieldTarget target = sink_.openDeclaration(access, type, id, hasValue);
  const bool list = isMultiple(type) && lexer_.peek().is(TokenKind::bracketOpen);
  const bool good = !hasValue || fieldValue(target);
  sink_.closeDeclaration(good);
  if (good) return true;
  if (type == FieldType::SFNode || type == FieldType::MFNode) return false;
  if (list) skipRestOfList();
  skipInterfaceValue();
  return true;
}

// scriptBodyElement ::= nodeBodyElement | restrictedInterfaceDeclaration
//                     | eventIn fieldType eventInId IS eventInId
//                     | eventOut fieldType eventOutId IS eventOutId
//                     | field fieldType fieldId IS fieldId
// X3D also has exposedField, which it calls inputOutput (29.2.2). The sink says what a node may
// declare.
bool Parser::scriptBodyElement() {
  const Token keyword = lexer_.next();
  Access access{};
  readAccess(keyword, access);
  FieldType type;
  if (!fieldType(type)) {
    skipDeclaration();
    return true;
  }
  Token id;
  if (!name(id, "a name for the interface")) return false;
  const bool isConnection = lexer_.peek().is("IS");
  const bool hasValue =
      (access == Access::field || access == Access::exposedField) && !isConnection;
  const FieldTarget target = sink_.openDeclaration(access, type, id, hasValue);
  const bool list = isMultiple(type) && lexer_.peek().is(TokenKind::bracketOpen);
  const char* const from = lexer_.peek().at();
  const bool good = !hasValue || fieldValue(target);
  sink_.placed(from, lexer_.consumed());
  sink_.closeDeclaration(good);
  if (!good && list && type != FieldType::MFNode) skipRestOfList();
  if (good && isConnection) {
    lexer_.next();
    Token interfaceName;
    if (!name(interfaceName, "a name of the prototype's interface after IS")) return false;
    sink_.connect(id, interfaceName);
  }
  return good;
}

} // namespace xvrml
