// parser.h: the grammar of VRML97 (ISO/IEC 14772-1 Annex A.2), one function per production, against
// an abstract sink. Reports what is wrong and goes on at the next node. Recursive by nodes;
// limits.nesting and maximumNesting bound the stack. [any thread]
#pragma once

#include <vector>

#include "base/value_parser.h"
#include "parse/sink.h"

namespace xvrml {

// Whether a token begins a declaration of an interface.
inline bool declares(const Token& token) {
  return token.is("field") || token.is("eventIn") || token.is("eventOut") ||
         token.is("exposedField");
}

class Parser {
 public:
  // Nodes within nodes that no option can raise: what the thread's stack bears.
  static constexpr uint64_t maximumNesting = 2500;

  // budget: what values draw their memory from; null: nothing is counted.
  Parser(Lexer& lexer, const Limits& limits, ParseSink& sink, Budget* budget = nullptr);
  // Reads the whole text (the header is a comment to the lexer).
  void vrmlScene();

 private:
  // What takes complete nodes where the text stands: statements of the file or of a prototype's
  // body, the list of a field, a value in a prototype's interface. An error closes open nodes up to
  // the innermost of these, never beyond.
  struct Taker {
    enum class Kind : uint8_t { statements, list, interface } kind;
    size_t nodes;        // that were open when it began
    size_t receiver;     // the sink's number for it
    uint64_t braces = 0; // that may come without a partner: one was taken as missing, or an opening
                         // one was passed over
  };

  // Each returns false after an error, with the lexer at the same depth of braces as before: the
  // caller skips to where it knows on.
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
  bool nodesOfList();
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
  static bool isX3dStatement(const Token& token);
  bool leaveOutX3d(const Token& keyword);

  // Recovery: decisions in parser_recovery.cpp, what skips text in parser_skip.cpp.
  void openTaker(Taker::Kind kind) { takers_.push_back({kind, open_.size(), sink_.receiver()}); }
  bool isClosing() const { return open_.size() > keep_; }
  void closeNodesBefore(const Token& at, std::string_view what);
  bool nodeInBody(const Token& first);
  bool nodeAhead(Token& type);
  bool bodyFollows(const Token& type);
  bool endsList(const Token& token, bool hasDef);
  bool strayInBody(const Token& token);
  bool strayInStatements(const Token& token, TokenKind end);
  bool closeListBefore(const Token& brace);
  void passBrace(bool holdsFields);
  void noteLost(const Token& token);
  void skipBlock(char kind = '{');
  bool skipNested(char opened, bool inList);
  void skipOne();
  void skipToNode();
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
  std::vector<Taker> takers_;
  std::vector<Token> open_; // types of the nodes that are being read
  size_t keep_ = SIZE_MAX; // open nodes that stay open; those within them end where the text stands
  uint64_t brackets_ =
      0; // closing ones that may come without a partner: their lists were taken as closed
  bool listEnded_ = false; // a list was taken as closed before the field that follows
};

} // namespace xvrml
