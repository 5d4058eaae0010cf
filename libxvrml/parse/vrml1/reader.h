// reader.h: reads the text of a VRML 1.0 file into a tree: the grammar of "File Syntax and
// Formatting" of its specification. After an error it continues with the next field or node. One
// reader per file, on the thread that loads.
#pragma once

#include <map>
#include <unordered_set>

#include "base/lexer.h"
#include "base/value_parser.h"
#include "parse/vrml1/tree.h"

namespace xvrml::vrml1 {

class Reader {
 public:
  // budget: the memory budget that nodes and values are counted against. nesting: greatest depth of
  // nodes within nodes.
  Reader(Locator& locator, const Limits& limits, Budget& budget, uint64_t nesting);
  // Reads the whole text. Values that cannot be read are reported, and keep their defaults.
  Tree read();
  // Reports the name once for each file. Returns whether this is the first time.
  bool isFirst(const std::string& name) { return reported_.insert(name).second; }

 private:
  // A field that an extension node declares: fields [ SFFloat a, MFString b ].
  struct Declared {
    std::string_view name;
    FieldType type;
    Spelling spelling;
  };

  const TreeNode* statement();
  const TreeNode* node(std::string_view name, const char* nameAt);
  const TreeNode* use();
  void body(TreeNode& node, const Token& type);
  void bodyElement(TreeNode& node, const Token& type, std::vector<Declared>& declared);
  void field(TreeNode& node, const Token& name, const std::vector<Declared>& declared);
  void declarations(std::vector<Declared>& declared);
  void parents(TreeNode& node);
  void setType(TreeNode& node, const Type& type);
  void vrml97Field(TreeNode& node, const Token& name);
  bool beginsNode(Token token);
  bool endsValue(const TreeNode& node, Token token, const std::vector<Declared>& declared);
  void skipValue(const TreeNode& node, const std::vector<Declared>& declared);
  void skipBlock();
  void skipMask(const Token& opened);
  void leaveOut(const Token& type);

  bool value(FieldType type, Spelling spelling, Value& value);
  bool truth(Value& value);
  bool text(std::string& value);
  bool texts(Value& value);
  bool enumeration(Value& value);
  bool bitMask(Value& value);
  bool matrix(Value& value);

  Locator& locator_;
  const Limits& limits_;
  Lexer lexer_;
  ValueParser values_;
  Budget& budget_;
  const uint64_t nesting_;
  Tree tree_;
  std::map<std::string, TreeNode*, std::less<>> names_;
  std::unordered_set<const TreeNode*> open_;
  std::unordered_set<std::string> reported_;
  uint64_t depth_ = 0;
  bool endReported_ = false;
  bool full_ = false; // the budget has refused a node; reported once
};

} // namespace xvrml::vrml1
