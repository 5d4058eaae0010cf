// parser.h: the grammar of VRML97 (ISO/IEC 14772-1 Annex A.2), one function per production, against an abstract sink. Reports
// what is wrong and goes on at the next node. Recursive by nodes; limits.nesting and maximumNesting bound the stack. [any thread]
#pragma once

#include "base/value_parser.h"
#include "parse/sink.h"

namespace xvrml {

class Parser {
 public:
  // Nodes within nodes that no option can raise: what the thread's stack bears.
  static constexpr uint64_t maximumNesting = 2500;

  // budget: what values draw their memory from; null: nothing is counted.
  Parser(Lexer& lexer, const Limits& limits, ParseSink& sink, Budget* budget = nullptr);
  // Reads the whole text (the header is a comment to the lexer).
  void vrmlScene();

 private:
  // Each returns false after an error, with the lexer at the same depth of braces as before: the caller skips to where it knows
  // on.
  void statements(TokenKind end);
  bool statement();
  bool nodeStatement();
  bool node(const Token* def);
  bool nodeBody(const Token& type);
  bool nodeBodyElement();
  bool field();
  bool fieldValue(const FieldTarget& target);
  bool nodeValue();
  bool nodeValues();
  bool protoStatement();
  bool proto();
  bool externproto();
  bool interfaceDeclarations(bool isExtern);
  bool interfaceDeclaration(bool isExtern);
  bool scriptBodyElement();
  bool routeStatement();
  bool routeEnd(Token& node, Token& field);

  bool name(Token& out, const char* what);
  bool fail(const Token& at, std::string_view expected);
  void failAtEnd(const Token& opened);
  bool leaveOutX3d(const Token& keyword);
  void noteLost(const Token& token);
  void skipBlock();
  void skipField();
  void skipDeclaration();
  void skipProto();
  void skipToStatement(TokenKind end);

  Lexer& lexer_;
  ValueParser values_;
  ParseSink& sink_;
  const uint64_t nesting_;
  uint64_t depth_ = 0;
  bool endReported_ = false;
};

} // namespace xvrml
