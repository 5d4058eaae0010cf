// parser.h: a recursive descent parser for VRML97 (ISO/IEC 14772-1 Annex A.2) and X3D ClassicVRML
// (ISO/IEC 19776-2 Annex A), one function per production. It reports to an abstract sink. After an
// error it continues at the next node. Recursion follows the nesting of nodes; limits.nesting and
// maximumNesting bound the stack. [any thread]
#pragma once

#include <bitset>
#include <vector>

#include "base/lexer.h"
#include "base/value_parser.h"
#include "parse/sink.h"

namespace xvrml {

// Wide because there is one function for each rule of the grammar.
class Parser {
 public:
  // Limit for the nesting of nodes that no option can exceed: the thread's stack allows no more.
  static constexpr uint64_t maximumNesting = 2500;

  // budget: the memory budget of the values; null: memory is not counted.
  // x3d: the text is X3D ClassicVRML.
  Parser(Lexer& lexer, const Limits& limits, ParseSink& sink, Budget* budget = nullptr,
         bool x3d = false);
  // Parses the whole text. The header is a comment to the lexer.
  void vrmlScene();

 private:
  // A place that holds complete nodes: the statements of a file or of a prototype's body, a list of
  // nodes, or a value in a prototype's interface. An error closes the open nodes within the
  // innermost of these places, never beyond it.
  struct RecoveryPoint {
    enum class Kind : uint8_t { statements, list, interface } kind;
    size_t nodes;      // number of nodes that were open when the place began
    size_t nodeTarget; // the sink's number for this place
    // Closing braces to ignore here: the parser has already taken one as missing, or has skipped an
    // opening brace.
    uint64_t braces = 0;
  };

  // Each function returns false after an error, with the lexer at the same brace depth as before.
  // The caller then skips to a token where it can continue.
  void statements(TokenKind end);
  bool statement();
  bool nodeStatement();
  bool node(const Name* def);
  void unknownNode(const Token& type);
  void openBody(const Token& type);
  void nodeBody(const Token& type);
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
  bool declares(const Token& token) const;
  bool readAccess(const Token& keyword, Access& access);
  bool fieldType(FieldType& type);
  bool x3dStatement();
  bool componentStatement();
  bool metaStatement(const Token& keyword);
  bool unitStatement();
  bool importStatement(const Token& keyword);
  bool exportStatement();
  bool routeStatement();
  bool routeEnd(Token& node, Token& field);

  bool name(Token& out, const char* what);
  bool fail(const Token& at, std::string_view expected);
  void failAtEnd(const Token& opened);
  static bool isX3dStatement(const Token& token);
  bool leaveOutX3d(const Token& keyword);

  // Error recovery: decisions in parser_recovery.cpp, skipping of text in parser_skip.cpp.
  void pushRecoveryPoint(RecoveryPoint::Kind kind) {
    recoveryPoints_.push_back({kind, open_.size(), sink_.nodeTarget()});
  }
  bool isClosing() const { return open_.size() > keep_; }
  void closeNodesBefore(const Token& at, std::string_view what);
  bool nodeInBody(const Token& first);
  bool nodeAhead(Token& type);
  bool bodyFollows(const Token& type);
  bool endsList(const Token& token, bool hasDef);
  bool strayInBody(const Token& token);
  bool strayStatement(const Token& token);
  bool strayInStatements(const Token& token, TokenKind end);
  bool closeListBefore(const Token& brace);
  void passBrace(bool holdsFields);
  void noteLost(const Token& token);
  void skipBlock(char kind = '{', bool* atChildren = nullptr);
  bool skipNested(char opened, bool inList, bool* atChildren = nullptr);
  bool childrenFollow();
  void skipOne();
  void skipToNode();
  void skipField();
  void skipToField();
  void skipRestOfList();
  void skipInterfaceValue();
  void skipDeclaration();
  void skipProto();
  void skipToStatement(TokenKind end);

  Lexer& lexer_;
  ValueParser values_;
  ParseSink& sink_;
  const uint64_t nesting_;
  const bool x3d_;
  std::bitset<fieldTypeCount> foreignTypes_; // types of X3D that were reported
  uint64_t depth_ = 0;
  bool endReported_ = false;
  std::vector<RecoveryPoint> recoveryPoints_;
  std::vector<Token> open_; // types of the open nodes
  // Number of open nodes that stay open; nodes within them end at the present token. SIZE_MAX: none
  // ends.
  size_t keep_ = SIZE_MAX;
  // Closing brackets to ignore, because their lists were already taken as closed.
  uint64_t brackets_ = 0;
  bool listEnded_ = false;     // a list was taken as closed before the field that follows
  std::vector<size_t> groups_; // numbers in open_ of unknown nodes that a Group stands for
};

} // namespace xvrml
