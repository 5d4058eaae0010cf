// reader.cpp: nodes, names and fields of VRML 1.0. Values are read in reader_values.cpp.
#include "parse/vrml1/reader.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/rotation.h"
#include "graph/inline_node.h"
#include "graph/load_state.h"
#include "graph/range.h"
#include "nearest.h"

namespace xvrml::vrml1 {
namespace {

// Nodes of VRML97 that browsers also accept in VRML 1.0, which has nothing for the same purpose.
const NodeType* foreignType(std::string_view name) {
  for (const char* known : {"Background", "Fog", "NavigationInfo", "Viewpoint", "WorldInfo"})
    if (name == known) return findNodeType(name);
  return nullptr;
}

} // namespace

Reader::Reader(Locator& locator, const Limits& limits, Budget& budget, uint64_t nesting)
    : locator_(locator), limits_(limits), lexer_(locator), values_(lexer_, limits, &budget),
      budget_(budget), nesting_(nesting) {
  // In a list of numbers a word begins what follows, except those that stand for no number.
  values_.keepElements([](const Token& word) {
    std::string lower(word.text.substr(0, 3));
    for (char& c : lower) c = char(c | 0x20);
    return lower != "nan" && lower != "inf";
  });
}

Tree Reader::read() {
  while (!lexer_.peek().is(TokenKind::end)) {
    const Token token = lexer_.peek();
    if (beginsNode(token)) {
      if (const TreeNode* root = statement()) tree_.roots.push_back(root);
      continue;
    }
    lexer_.error(token.at(), fmt::format("expected a node, DEF or USE, found {}", describe(token)));
    lexer_.next();
    while (!lexer_.peek().is(TokenKind::end) && !beginsNode(lexer_.peek())) lexer_.next();
  }
  return std::move(tree_);
}

// Returns whether a node begins here: DEF, USE, or a word before a brace.
bool Reader::beginsNode(Token token) {
  if (!token.is(TokenKind::identifier)) return false;
  if (token.text == "DEF" || token.text == "USE") return true;
  lexer_.next();
  const bool opens = lexer_.peek().is(TokenKind::braceOpen);
  lexer_.seek(token.at());
  return opens;
}

// Reads a node, DEF NAME node, or USE NAME. Returns null if nothing of it can be used.
const TreeNode* Reader::statement() {
  const Token token = lexer_.peek();
  if (token.text == "USE") return use();
  if (token.text != "DEF") return node({}, nullptr);
  lexer_.next();
  const Token name = lexer_.nextName();
  if (name.text.empty() || isVrmlSeparator(name.text[0])) {
    lexer_.error(name.at(), fmt::format("expected a name after DEF, found {}", describe(name)));
    lexer_.seek(name.at());
    return nullptr;
  }
  const Token next = lexer_.peek();
  if (beginsNode(next) && next.text != "DEF" && next.text != "USE")
    return node(name.text, name.at());
  lexer_.error(name.at(),
               fmt::format("expected a node after DEF {}, found {}", name.text, describe(next)));
  return nullptr;
}

const TreeNode* Reader::use() {
  lexer_.next();
  const Token name = lexer_.nextName();
  const auto found = names_.find(name.text);
  if (found == names_.end()) {
    std::vector<std::string> known;
    for (const auto& [text, node] : names_)
      if (known.size() < 200) known.push_back(text);
    lexer_.error(name.at(), fmt::format("no node is named {} by a DEF above{}", describe(name),
                                        nearest::suggestion(name.text, known)));
    return nullptr;
  }
  if (open_.contains(found->second)) {
    lexer_.error(name.at(), fmt::format("{} is USEd inside itself: a node cannot be its own "
                                        "descendant",
                                        describe(name)));
    return nullptr;
  }
  found->second->shared = true;
  return found->second;
}

void Reader::setType(TreeNode& node, const Type& type) {
  node.type = &type;
  node.kind = type.kind;
  node.values.clear();
  for (const Field& field : type.fields) node.values.push_back(field.value);
  node.given.assign(type.fields.size(), false);
}

// Reads nodeType { body }. The node keeps the name, which may be empty.
const TreeNode* Reader::node(std::string_view name, const char* nameAt) {
  const Token type = lexer_.next();
  lexer_.next(); // the brace
  if (depth_ >= nesting_) {
    lexer_.error(type.at(), fmt::format("nodes nested deeper than limit nesting={}; {} is left out",
                                        nesting_, describe(type)));
    skipBlock();
    return nullptr;
  }
  // Estimates of a node of the tree with its values, and of its name.
  if (!budget_.take(400 + (nameAt ? bytesOfName + name.size() : 0))) {
    if (!std::exchange(full_, true))
      lexer_.error(type.at(),
                   fmt::format("the world takes more memory than {}; nodes from {} on are left out",
                               budget_.name(), describe(type)));
    skipBlock();
    return nullptr;
  }
  TreeNode& node = tree_.nodes.emplace_back();
  node.at = type.at();
  node.source = locator_.place(type.at());
  node.name = name;
  if (const Type* known = findType(type.text)) {
    setType(node, *known);
  } else if (const NodeType* foreign = foreignType(type.text)) {
    node.kind = Kind::vrml97;
    node.vrml97 = makeStaticNode(*foreign);
    node.vrml97->source = node.source;
    node.vrml97->defName = node.name;
  }
  if (nameAt) names_.insert_or_assign(node.name, &node);
  open_.insert(&node);
  ++depth_;
  body(node, type);
  --depth_;
  open_.erase(&node);
  if (node.kind == Kind::unknown) leaveOut(type);
  return &node;
}

// Reports a node of a type that is not known, once for each name.
void Reader::leaveOut(const Token& type) {
  if (!isFirst(std::string(type.text))) return;
  lexer_.warn(type.at(), fmt::format("{} is not a node of VRML 1.0{}; it is left out",
                                     describe(type), nearest::suggestion(type.text, types())));
}

void Reader::body(TreeNode& node, const Token& type) {
  std::vector<Declared> declared;
  while (!lexer_.accept(TokenKind::braceClose)) {
    if (lexer_.peek().is(TokenKind::end)) {
      if (!std::exchange(endReported_, true))
        lexer_.error(
            type.at(),
            fmt::format("{} is not closed: }} is missing at the end of the file", describe(type)));
      return;
    }
    bodyElement(node, type, declared);
  }
}

// Reads a child, a field, or the declarations of an extension node.
void Reader::bodyElement(TreeNode& node, const Token& type, std::vector<Declared>& declared) {
  const Token token = lexer_.peek();
  if (beginsNode(token)) {
    if (const TreeNode* child = statement()) node.children.push_back(child);
    return;
  }
  lexer_.next();
  if (!token.is(TokenKind::identifier)) {
    lexer_.error(token.at(), fmt::format("expected a field or a node in {}, found {}",
                                         describe(type), describe(token)));
    skipValue(node, declared);
  } else if (token.text == "fields" && lexer_.peek().is(TokenKind::bracketOpen)) {
    declarations(declared);
  } else if (token.text == "isA") {
    parents(node);
  } else {
    field(node, token, declared);
  }
}

// Reads [ SFFloat a, MFString b ]. Every extension node declares its fields.
void Reader::declarations(std::vector<Declared>& declared) {
  lexer_.next();
  while (!lexer_.accept(TokenKind::bracketClose)) {
    const Token typeName = lexer_.peek();
    Declared one{};
    if (!typeName.is(TokenKind::identifier) ||
        !fieldTypeNamed(typeName.text, one.type, one.spelling)) {
      lexer_.error(typeName.at(),
                   fmt::format("expected a type of a field or ], found {}", describe(typeName)));
      while (!lexer_.peek().is(TokenKind::bracketClose) && !lexer_.peek().is(TokenKind::end) &&
             !lexer_.peek().is(TokenKind::braceClose))
        lexer_.next();
      lexer_.accept(TokenKind::bracketClose);
      return;
    }
    lexer_.next();
    one.name = lexer_.nextName().text;
    if (declared.size() < limits_.interfaceFields) declared.push_back(one);
  }
}

// Reads the value of isA. A node of an unknown type is read as the first type that is known.
void Reader::parents(TreeNode& node) {
  Value names;
  if (!texts(names)) return;
  for (const std::string& name : std::get<MFString>(names)) {
    const Type* type = findType(name);
    if (!type || node.kind != Kind::unknown) continue;
    setType(node, *type);
  }
}

void Reader::field(TreeNode& node, const Token& name, const std::vector<Declared>& declared) {
  if (node.kind == Kind::vrml97) return vrml97Field(node, name);
  const int number = node.type ? node.type->find(name.text) : -1;
  if (number >= 0) {
    const Field& known = node.type->fields[static_cast<size_t>(number)];
    if (known.extension && isFirst(fmt::format("{}.{}", node.type->name, name.text)))
      lexer_.warn(name.at(), fmt::format("{} is not a field of {} in VRML 1.0; it is read as other "
                                         "browsers read it",
                                         describe(name), node.type->name));
    Value read = known.value;
    if (!value(known.type, known.spelling, read)) return skipValue(node, declared);
    if (known.type == FieldType::SFRotation) normalizeAxis(std::get<Rotation>(read));
    node.values[static_cast<size_t>(number)] = std::move(read);
    node.given[static_cast<size_t>(number)] = true;
    return;
  }
  for (const Declared& one : declared) {
    if (one.name != name.text) continue;
    Value ignored;
    if (!value(one.type, one.spelling, ignored)) skipValue(node, declared);
    return;
  }
  if (node.type && isFirst(fmt::format("{}.{}", node.type->name, name.text)))
    lexer_.warn(name.at(),
                fmt::format("{} has no field {}{}; it is left out", node.type->name, describe(name),
                            nearest::suggestion(name.text, node.type->fields)));
  skipValue(node, declared);
}

void Reader::vrml97Field(TreeNode& node, const Token& name) {
  const NodeType& type = node.vrml97->type();
  const FieldInfo* field = type.find(name.text);
  if (!field || !holdsValue(*field) || field->type == FieldType::SFNode ||
      field->type == FieldType::MFNode) {
    if (isFirst(fmt::format("{}.{}", type.name, name.text)))
      lexer_.warn(name.at(),
                  fmt::format("{} has no field {}{}; it is left out", type.name, describe(name),
                              nearest::suggestion(name.text, type.fields)));
    return skipValue(node, {});
  }
  Value read;
  if (!value(field->type, Spelling::plain, read)) return skipValue(node, {});
  node.vrml97->set(*field, std::move(read));
  normalizeAxes(field->type, node.vrml97->storage(*field));
  RangeFault fault;
  if (field->range.bounded() && field->type != FieldType::SFRotation &&
      !enforceRange(*field, nullptr, node.vrml97->storage(*field), &fault))
    lexer_.warn(name.at(), xvrml::describe(type, *field, fault));
}

// Returns whether a token cannot belong to a value: it ends the node, or begins a field or a node.
bool Reader::endsValue(const TreeNode& node, Token token, const std::vector<Declared>& declared) {
  if (token.is(TokenKind::end) || token.is(TokenKind::braceClose)) return true;
  if (!token.is(TokenKind::identifier)) return false;
  if (beginsNode(token) || (node.type && node.type->find(token.text) >= 0)) return true;
  if (node.vrml97 && node.vrml97->type().find(token.text)) return true;
  return std::any_of(declared.begin(), declared.end(),
                     [&](const Declared& one) { return one.name == token.text; });
}

// Skips the value of an unknown field, or what is left of one that could not be read. A list ends
// with its bracket, other values with the next field or node. A second word is the next field.
void Reader::skipValue(const TreeNode& node, const std::vector<Declared>& declared) {
  bool first = true;
  while (!endsValue(node, lexer_.peek(), declared)) {
    const Token token = lexer_.peek();
    if (token.is(TokenKind::identifier) && !first) return;
    lexer_.next();
    first = false;
    if (token.is(TokenKind::braceOpen)) return skipBlock();
    if (token.text.starts_with('(')) return skipMask(token);
    if (!token.is(TokenKind::bracketOpen)) continue;
    while (!lexer_.peek().is(TokenKind::bracketClose) && !lexer_.peek().is(TokenKind::end) &&
           !lexer_.peek().is(TokenKind::braceClose)) {
      if (lexer_.next().is(TokenKind::braceOpen)) skipBlock();
    }
    lexer_.accept(TokenKind::bracketClose);
    return;
  }
}

// Skips to behind the parenthesis that closes a bit mask, or to the end of its line.
void Reader::skipMask(const Token& opened) {
  const char* p = opened.at();
  while (p < lexer_.end() && *p != ')' && *p != '}' && *p != '\n' && *p != '\r') ++p;
  lexer_.seek(p < lexer_.end() && *p == ')' ? p + 1 : p);
}

// Skips to behind the brace that closes the present block.
void Reader::skipBlock() {
  for (uint64_t open = 1; open > 0 && !lexer_.peek().is(TokenKind::end);) {
    const Token token = lexer_.next();
    if (token.is(TokenKind::braceOpen)) ++open;
    if (token.is(TokenKind::braceClose)) --open;
  }
}

} // namespace xvrml::vrml1
