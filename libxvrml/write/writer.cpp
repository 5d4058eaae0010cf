// writer.cpp: writes a world as VRML97 text. Content of other files stays a reference to them.
// Prototype declarations are written, the bodies of instances are not. A pure function of the
// world. [the thread that owns the world]
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "base/lexer.h"
#include "base/rotation.h"
#include "enough_stack.h"
#include "graph/expander.h"
#include "graph/field_access.h"
#include "graph/url.h"
#include "write/value_writer.h"
#include "xvrml/comments.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Nodes nested deeper are refused: the writer is recursive, and no parser reads such a file (its
// own limit is Parser::maximumNesting).
constexpr size_t deepestNode = 2500;

using Connections = std::unordered_map<const Node*, std::vector<const IsConnection*>>;

// Returns a name that parses. The file's own spelling stays if the parser accepts it.
std::string nameText(const std::string& name) {
  if (isIdentifier(name)) return name;
  std::string text;
  for (const char c : name)
    text += isVrmlSeparator(c) || static_cast<unsigned char>(c) < 0x20 ? '_' : c;
  return text;
}

// The names of one scope: which nodes have been written, and under which names.
class Names {
 public:
  Names(const std::vector<Node*>& roots, const std::vector<Route>& routes) {
    std::vector<Node*> nodes;
    std::unordered_map<const Node*, uint32_t> index;
    collectNodes(roots, nodes, index);
    std::unordered_map<const Node*, size_t> uses;
    for (Node* root : roots) ++uses[root];
    for (Node* node : nodes)
      forEachChild(*node, [&](NodeRef& child, const FieldInfo&) { ++uses[child.get()]; });
    for (const Route& route : routes) {
      uses[route.from.get()] += 2;
      uses[route.to.get()] += 2;
    }
    std::unordered_map<std::string, int> given;
    for (Node* node : nodes) {
      if (node->defName.empty()) continue;
      names_.emplace(node, nameText(node->defName));
      if (++given[names_[node]] > 1) repeated_.insert(names_[node]);
    }
    size_t number = 0;
    for (Node* node : nodes) {
      if (uses[node] < 2 || names_.contains(node)) continue;
      std::string name;
      do name = fmt::format("_{}{}", node->type().name, ++number);
      while (given.contains(name));
      names_.emplace(node, std::move(name));
    }
  }
  // Marks a node as written. Returns false if it has been written before.
  bool begin(const Node* node) { return written_.insert(node).second; }
  bool isWritten(const Node* node) const { return written_.contains(node); }
  const std::string* find(const Node* node) const {
    const auto found = names_.find(node);
    return found == names_.end() ? nullptr : &found->second;
  }
  // Returns whether the name refers to several nodes, one after the other.
  bool isRepeated(const Node* node) const {
    const std::string* name = find(node);
    return name && repeated_.contains(*name);
  }

 private:
  std::unordered_map<const Node*, std::string> names_;
  std::unordered_set<std::string> repeated_;
  std::unordered_set<const Node*> written_;
};

class Writer {
 public:
  // target: the file that will hold the text; empty: relative URLs stay as they are
  Writer(const World& world, std::string target)
      : text(heading(world)), target_(std::move(target)) {}

  std::string text;

  void scope(const Scope& scope, const Connections* connections) {
    const std::vector<Node*> roots = rootsOf(scope);
    Names names(roots, scope.routes);
    // Routes are written at the end. A route with a repeated name is written as soon as both nodes
    // exist, while the name still refers to them.
    std::vector<const Route*> early, late;
    for (const Route& route : scope.routes) {
      const bool repeated = names.isRepeated(route.from.get()) || names.isRepeated(route.to.get());
      (repeated ? early : late).push_back(&route);
    }
    std::unordered_map<const ProtoDeclaration*, size_t> prototypes;
    for (size_t i = 0; i < scope.prototypes.size(); ++i)
      prototypes.emplace(scope.prototypes[i].get(), i + 1);
    size_t declared = 0;
    for (Node* root : roots) {
      const size_t needed = lastPrototypeOf(root, prototypes);
      for (; declared < needed; ++declared) prototype(*scope.prototypes[declared]);
      line();
      node(root, names, connections);
      std::erase_if(early, [&](const Route* written) { return route(*written, names); });
    }
    for (; declared < scope.prototypes.size(); ++declared) prototype(*scope.prototypes[declared]);
    for (const Route* written : late) route(*written, names);
  }

 private:
  // Returns the header and the comments at the top of the file. They name the program that wrote
  // it, which can decide the up axis.
  static std::string heading(const World& world) {
    constexpr std::string_view header = "VRML V2.0 utf8";
    std::string_view comments = openingComments(world);
    std::string text = '#' + std::string(header);
    if (comments.starts_with("VRML")) {
      const std::string_view first = comments.substr(0, comments.find('\n'));
      if (first.starts_with(header)) text += first.substr(header.size());
      comments.remove_prefix(std::min(first.size() + 1, comments.size()));
    }
    if (comments.starts_with("X3D V")) // the text is VRML97 now
      comments.remove_prefix(std::min(comments.find('\n'), comments.size() - 1) + 1);
    for (text += '\n'; !comments.empty();) {
      const std::string_view one = comments.substr(0, comments.find('\n'));
      text += fmt::format("#{}\n", one);
      comments.remove_prefix(std::min(one.size() + 1, comments.size()));
    }
    std::erase(text, '\r');
    return text;
  }

  void writeUrls(MFString urls, const std::string& base) {
    rebaseUrls(urls, base, target_);
    writeValue(text, FieldType::MFString, &urls, indent_);
  }

  void line() {
    text += '\n';
    text.append(indent_, ' ');
  }

  // Returns how many prototypes must be written before a root. They keep their order, because a
  // name may be declared again later.
  static size_t
  lastPrototypeOf(Node* root,
                  const std::unordered_map<const ProtoDeclaration*, size_t>& prototypes) {
    size_t last = 0;
    if (prototypes.empty()) return last;
    std::vector<Node*> nodes;
    std::unordered_map<const Node*, uint32_t> index;
    collectNodes({root}, nodes, index);
    for (Node* node : nodes) {
      const auto* instance = dynamic_cast<ProtoInstance*>(node);
      const auto found = instance ? prototypes.find(instance->declaration.get()) : prototypes.end();
      if (found != prototypes.end()) last = std::max(last, found->second);
    }
    return last;
  }

  // Writes a route. Returns false if one of its nodes has not been written yet.
  bool route(const Route& route, const Names& names) {
    const Node *from = route.from.get(), *to = route.to.get();
    if (!names.isWritten(from) || !names.isWritten(to)) return false;
    line();
    text += fmt::format("ROUTE {}.{} TO {}.{}", *names.find(from), route.fromField, *names.find(to),
                        route.toField);
    return true;
  }

  void node(Node* node, Names& names, const Connections* connections) {
    if (!node) {
      text += "NULL";
      return;
    }
    const std::string* name = names.find(node);
    if (!names.begin(node)) {
      text += "USE " + *name;
      return;
    }
    if (name) text += "DEF " + *name + " ";
    if (++depth_ > deepestNode)
      throw std::length_error(fmt::format("the world cannot be written: nodes are nested more than "
                                          "{} deep, and no program could read the file",
                                          deepestNode));
    text += node->type().name + " {";
    const size_t before = text.size();
    indent_ += 2;
    for (const FieldInfo& field : node->type().fields) fieldOf(*node, field, names, connections);
    otherConnections(*node, connections);
    indent_ -= 2;
    --depth_;
    if (text.size() > before) line();
    text += text.size() > before ? "}" : " }";
  }

  void fieldOf(Node& node, const FieldInfo& field, Names& names, const Connections* connections) {
    const bool declared = isDeclared(node, field);
    std::vector<const IsConnection*> own;
    for (const IsConnection* connection : connectionsOf(node, connections)) {
      if (connection->field == field.name) own.push_back(connection);
    }
    const bool value = holdsValue(field) && (declared ? own.empty() : hasOwnValue(node, field));
    if (value || declared) {
      line();
      if (declared)
        text += fmt::format("{} {} ", accessName(field.access), fieldTypeName(field.type));
      text += field.name;
      if (value && hasNormalizedAxes(field)) // a program may have written to the struct
        visitStorage(field.type, node.storage(field), [&](auto copy) {
          normalizeAxes(field.type, &copy);
          fieldValue(&copy, field.type, names, connections);
        });
      else if (const auto& base = urlBase(node, field);
               value && base && !target_.empty() && holdsUrls(node, field)) {
        text += ' ';
        writeUrls(*static_cast<const MFString*>(node.storage(field)), *base);
      } else if (value)
        fieldValue(node.storage(field), field.type, names, connections);
    }
    for (size_t i = 0; i < own.size(); ++i) {
      if (i > 0 || !declared) {
        line();
        text += field.name;
      }
      text += " IS " + own[i]->interfaceName;
    }
  }

  static std::span<const IsConnection* const> connectionsOf(const Node& node,
                                                            const Connections* connections) {
    if (!connections) return {};
    const auto found = connections->find(&node);
    return found == connections->end() ? std::span<const IsConnection* const>() : found->second;
  }

  // Writes connections such as "set_x IS y", which do not use a field's own name.
  void otherConnections(const Node& node, const Connections* connections) {
    for (const IsConnection* connection : connectionsOf(node, connections)) {
      if (node.type().find(connection->field)) continue;
      line();
      text += connection->field + " IS " + connection->interfaceName;
    }
  }

  // Returns whether the Script itself declares the field.
  static bool isDeclared(const Node& node, const FieldInfo& field) {
    if (!dynamic_cast<const ScriptNode*>(&node)) return false;
    const NodeType* script = findNodeType("Script");
    return !script || !script->find(field.name);
  }

  static bool hasOwnValue(Node& node, const FieldInfo& field) {
    const Value* standard = &field.defaultValue;
    if (const auto* instance = dynamic_cast<ProtoInstance*>(&node)) {
      // A default of the prototype's file that a program has assigned again stays a default.
      if (instance->isGiven(field) && instance->hasOwnUrlBase(field)) return true;
      if (holdsNodes(field)) return false;
      if (const ProtoPtr& resolved = instance->declaration->resolved) {
        const FieldInfo* declared = resolved->type->find(field.name);
        if (declared && declared->type == field.type) standard = &declared->defaultValue;
      }
    }
    return visitStorage(field.type, node.storage(field), [&](auto& value) {
      const auto* other = std::get_if<std::remove_reference_t<decltype(value)>>(standard);
      return !other || !(value == *other);
    });
  }

  void fieldValue(void* storage, FieldType type, Names& names, const Connections* connections) {
    text += ' ';
    if (type == FieldType::SFNode) {
      node(static_cast<NodeRef*>(storage)->get(), names, connections);
    } else if (type == FieldType::MFNode) {
      const auto& list = *static_cast<MFNode*>(storage);
      text += '[';
      indent_ += 2;
      for (const NodeRef& child : list) {
        line();
        node(child.get(), names, connections);
      }
      indent_ -= 2;
      if (!list.empty()) line();
      text += list.empty() ? " ]" : "]";
    } else {
      writeValue(text, type, storage, indent_);
    }
  }

  void prototype(const ProtoDeclaration& declaration) {
    line();
    text += fmt::format("{} {} [", declaration.isExtern ? "EXTERNPROTO" : "PROTO",
                        nameText(declaration.type->name));
    indent_ += 2;
    for (const FieldInfo& field : declaration.type->fields) {
      line();
      text +=
          fmt::format("{} {} {}", accessName(field.access), fieldTypeName(field.type), field.name);
      if (declaration.isExtern || !holdsValue(field)) continue;
      if (!target_.empty() && declaration.holdsUrls(field)) {
        text += ' ';
        writeUrls(std::get<MFString>(field.defaultValue), declaration.baseUrl);
        continue;
      }
      Value value = field.defaultValue; // nodes are shared, not copied
      std::vector<Node*> roots;
      if (auto* single = std::get_if<NodeRef>(&value)) roots.push_back(single->get());
      if (auto* many = std::get_if<MFNode>(&value)) {
        for (const NodeRef& node : *many) roots.push_back(node.get());
      }
      Names names(roots, {});
      fieldValue(std::visit([](auto& stored) -> void* { return &stored; }, value), field.type,
                 names, nullptr);
    }
    indent_ -= 2;
    if (!declaration.type->fields.empty()) line();
    text += ']';
    if (declaration.isExtern) {
      text += ' ';
      if (target_.empty())
        writeValue(text, FieldType::MFString, &declaration.urls, indent_);
      else
        writeUrls(declaration.urls, declaration.baseUrl);
      return;
    }
    Connections connections;
    for (const IsConnection& connection : declaration.is)
      connections[connection.node.get()].push_back(&connection);
    text += " {";
    indent_ += 2;
    scope(declaration.body, &connections);
    indent_ -= 2;
    line();
    text += '}';
  }

  const std::string target_;
  size_t indent_ = 0;
  size_t depth_ = 0; // number of nodes around the one that is being written
};

} // namespace

std::string writeWorld(const World& world) { return writeWorld(world, ""); }

std::string writeWorld(const World& world, const std::string& path) {
  constexpr size_t deepestStack = size_t(6) << 20; // bytes; a level uses about 1 kB
  return onStackOf(deepestStack, [&] {
    Writer writer(world, path);
    writer.scope(world.scope, nullptr);
    writer.text += '\n';
    return std::move(writer.text);
  });
}

} // namespace xvrml
