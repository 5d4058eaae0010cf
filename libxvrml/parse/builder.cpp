// builder.cpp: nodes and their fields. See builder.h; names, routes and IS are in
// builder_names.cpp, prototypes in builder_proto.cpp.
#include "parse/builder.h"

#include <utility>

#include <fmt/format.h>

#include "base/rotation.h"
#include "graph/expander.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "graph/nearest.h"
#include "graph/node_kinds.h"
#include "graph/range.h"

namespace xvrml {

Builder::Builder(Lexer& lexer, LoadState& state, ParsedFile& file)
    : lexer_(lexer), state_(state), file_(file) {
  pushScope(&file.scope, nullptr, nullptr);
}

Builder::Mark Builder::mark() const {
  const ScopeFrame& frame = scopes_.back();
  return {file_.instances.size(), file_.inlines.size(), frame.defined.size(),
          frame.scope->routes.size(), frame.proto ? frame.proto->is.size() : 0};
}

void Builder::rollBack(const Mark& mark) {
  ScopeFrame& frame = scope();
  file_.instances.resize(mark.instances);
  file_.inlines.resize(mark.inlines);
  for (size_t i = mark.names; i < frame.defined.size(); ++i) {
    const auto name = frame.scope->names.find(frame.defined[i]);
    const auto before = name == frame.scope->names.end() ? frame.earlier.end()
                                                         : frame.earlier.find(name->second.get());
    if (before != frame.earlier.end()) {
      name->second = before->second; // the node that had the name before has it again
      continue;
    }
    frame.lost.insert(frame.defined[i]);
    if (name != frame.scope->names.end()) frame.scope->names.erase(name);
  }
  frame.defined.resize(mark.names);
  frame.scope->routes.resize(mark.routes);
  if (frame.proto) frame.proto->is.resize(mark.connections);
}

bool Builder::isScript() const {
  return nodes_.size() > scopes_.back().outerNodes && nodes_.back().scriptType;
}

// Makes the node of a type, or says why it cannot.
bool Builder::makeNode(const Token& type, NodeFrame& frame) {
  if (isBeingDeclared(type.text)) {
    lexer_.error(type.at(), fmt::format("prototype {} contains an instance of itself (4.8.3)",
                                        describe(type)));
    return false;
  }
  if (ProtoPtr proto = findPrototype(type.text)) {
    frame.node = NodeRef(new ProtoInstance(proto->type, proto));
    return true;
  }
  const NodeType* known = findNodeType(type.text);
  if (!known) {
    if (isLost(type.text)) {
      lexer_.warn(type.at(), fmt::format("no node: prototype {} was left out", describe(type)));
    } else {
      lexer_.error(type.at(), fmt::format("{} is not a known node type{}", describe(type),
                                          suggestion(type.text, nodeTypes())));
    }
    return false;
  }
  if (known->name == "Script") {
    ++state_.scripts;
    frame.scriptType = scriptType(*known);
    frame.node = NodeRef(new ScriptNode(frame.scriptType));
  } else {
    frame.node = makeStaticNode(*known);
  }
  return true;
}

// Takes memory from the world's budget. False, after one message, if there is not enough left.
bool Builder::takes(uint64_t bytes, const Token& at) {
  if (state_.budget.take(bytes)) return true;
  if (!std::exchange(state_.full, true))
    lexer_.error(at.at(),
                 fmt::format("the world takes more memory than {}; nodes from {} on are left out",
                             state_.budget.name(), describe(at)));
  return false;
}

bool Builder::openNode(const Token& type, const Token* def) {
  NodeFrame frame{{}, type, {}, mark(), 1, {}, nullptr, nullptr};
  const uint64_t limit = state_.options.limits.expandedNodes;
  bool made = false;
  if (state_.world.nodeCount >= limit) {
    lexer_.error(type.at(), fmt::format("more nodes than limit expandedNodes={}; {} is left out",
                                        limit, describe(type)));
  } else if (!takes((def ? bytesOfName + def->text.size() : 0), type)) {
    made = false;
  } else {
    made = makeNode(type, frame) && takes(nodeBytes(*frame.node), type);
  }
  if (!made) {
    if (def) lostName(*def);
    return false;
  }
  ++state_.world.nodeCount;
  Node& node = *frame.node;
  node.source = lexer_.place(type.at());
  if (!inTemplate()) {
    if (dynamic_cast<ProtoInstance*>(&node)) file_.instances.push_back(frame.node);
    if (dynamic_cast<InlineNode*>(&node)) file_.inlines.push_back(frame.node);
  }
  if (def) {
    node.defName = def->text;
    const auto [named, fresh] = scope().scope->names.try_emplace(node.defName, frame.node);
    if (!fresh) scope().earlier.emplace(&node, std::exchange(named->second, frame.node));
    scope().defined.push_back(def->text);
  }
  nodes_.push_back(std::move(frame));
  return true;
}

void Builder::closeNode(bool good) {
  NodeFrame frame = std::move(nodes_.back());
  nodes_.pop_back();
  const uint64_t limit = state_.options.limits.expandedNodes;
  if (good && frame.expanded > limit) {
    lexer_.error(
        frame.type.at(),
        fmt::format(
            "{} stands for {} nodes with all that is USEd in it: more than limit expandedNodes={}",
            describe(frame.type), frame.expanded, limit));
    good = false;
  }
  if (!good) return rollBack(frame.mark);
  if (frame.expanded > 1) expanded_.emplace(frame.node.get(), frame.expanded);
  // A node that is good, but in a wrong place, keeps its names: a later USE may have a right one.
  // In a prototype's body only if nothing of it is connected to the interface.
  const Mark now = mark();
  const bool keeps = now.names > frame.mark.names && now.connections == frame.mark.connections;
  if (!accepts(receivers_.back(), frame.type, *frame.node,
               keeps ? "; what DEF names in it can be USEd" : "")) {
    keeps ? keepNames(frame.mark) : rollBack(frame.mark);
  } else if (!place(frame.type, frame.node, frame.expanded)) {
    rollBack(frame.mark);
  }
}

uint64_t Builder::expandedCount(const Node* node) const {
  const auto found = expanded_.find(node);
  return found == expanded_.end() ? 1 : found->second;
}

SourcePosition Builder::openNodePlace() const {
  return nodes_.empty() ? SourcePosition() : nodes_.back().node->source;
}

const NodeType* Builder::typeNamed(std::string_view name) const {
  const ProtoPtr proto = findPrototype(name);
  return proto ? proto->type.get() : findNodeType(name);
}

bool Builder::wouldTake(size_t receiver, std::string_view name, bool use) const {
  const Node* node = nullptr;
  if (use) {
    const auto found = scopes_.back().scope->names.find(name);
    if (found == scopes_.back().scope->names.end() || isOpen(found->second.get())) return false;
    node = found->second.get();
  } else if (const ProtoPtr proto = findPrototype(name)) {
    node = firstNode(proto.get());
  } else {
    return suits(receivers_[receiver - 1], findNodeType(name));
  }
  return suits(receivers_[receiver - 1], node ? effectiveType(*node) : nullptr);
}

// The types of node that a receiver takes; empty: all.
std::string_view Builder::wantedBy(const Receiver& receiver) const {
  if (receiver.kind == Receiver::Kind::roots) return inTemplate() || state_.anyRoots ? "" : "child";
  return receiver.field ? std::string_view(receiver.field->nodeTypes) : "";
}

// A type that is null is an EXTERNPROTO's, known when it is loaded.
bool Builder::suits(const Receiver& receiver, const NodeType* type) const {
  const std::string_view wanted = wantedBy(receiver);
  return !type || wanted.empty() || typeAccepted(wanted, *type);
}

bool Builder::accepts(const Receiver& receiver, const Token& at, const Node& node,
                      std::string_view remedy) {
  const NodeType* type = effectiveType(node);
  if (suits(receiver, type)) return true;
  const bool root = receiver.kind == Receiver::Kind::roots;
  const std::string_view wanted = wantedBy(receiver);
  const std::string stands = type == &node.type() ? "" : fmt::format(" ({})", type->name);
  if (root) {
    lexer_.error(
        at.at(),
        fmt::format("{}{} cannot stand at the root of a file: expected a child node (4.6.5){}",
                    describe(at), stands, remedy));
  } else {
    lexer_.error(at.at(), fmt::format("{}{} cannot be in field {} of {}: expected {}{}",
                                      describe(at), stands, receiver.field->name,
                                      receiver.holder->type().name, wanted, remedy));
  }
  return false;
}

// False, after a message, if the node cannot stand where it is written.
bool Builder::deliver(const Token& at, const NodeRef& node, uint64_t expanded) {
  return accepts(receivers_.back(), at, *node, "") && place(at, node, expanded);
}

// False, after a message, if there are too many nodes.
bool Builder::place(const Token& at, const NodeRef& node, uint64_t expanded) {
  Receiver& receiver = receivers_.back();
  const bool root = receiver.kind == Receiver::Kind::roots;
  uint64_t& sum = root || nodes_.empty() || receiver.holder == nullptr ? scope().expanded
                                                                       : nodes_.back().expanded;
  const uint64_t limit = state_.options.limits.expandedNodes;
  if (root && saturatingAdd(sum, expanded) > limit) {
    lexer_.error(at.at(), fmt::format("more nodes, shared ones counted at each use, than limit "
                                      "expandedNodes={}; {} is left out",
                                      limit, describe(at)));
    return false;
  }
  sum = saturatingAdd(sum, expanded);
  switch (receiver.kind) {
  case Receiver::Kind::roots: scope().scope->roots.push_back(node); break;
  case Receiver::Kind::single: *static_cast<NodeRef*>(receiver.storage) = node; break;
  case Receiver::Kind::multiple: static_cast<MFNode*>(receiver.storage)->push_back(node); break;
  }
  return true;
}

void Builder::nullNode(const Token& token) {
  const Receiver& receiver = receivers_.back();
  if (receiver.kind == Receiver::Kind::single)
    *static_cast<NodeRef*>(receiver.storage) = {};
  else if (!receiver.field || keepsNull(*receiver.field) ||
           (receiver.holder && receiver.holder->type().index < 0))
    static_cast<MFNode*>(receiver.storage)
        ->emplace_back(); // an interface's value may become such a list
  else
    lexer_.warn(token.at(), "NULL is no node of a list; it is left out");
}

bool Builder::hasField(std::string_view name) const {
  return nodes_.size() > scopes_.back().outerNodes &&
         nodes_.back().node->type().find(name) != nullptr;
}

FieldTarget Builder::openField(const Token& name) {
  NodeFrame& frame = nodes_.back();
  Node& node = *frame.node;
  const FieldInfo* field = node.type().find(name.text);
  if (!field) {
    lexer_.error(name.at(), fmt::format("{} has no field {}{}", node.type().name, describe(name),
                                        suggestion(name.text, node.type().fields)));
    return {};
  }
  if (!holdsValue(*field)) {
    lexer_.error(name.at(),
                 fmt::format("{} is an {} of {}: it has no value in a file", describe(name),
                             field->access == Access::eventIn ? "eventIn" : "eventOut",
                             node.type().name));
    return {};
  }
  if (std::find(frame.given.begin(), frame.given.end(), name.text) != frame.given.end()) {
    lexer_.warn(name.at(),
                fmt::format("field {} is given twice; the last one counts", describe(name)));
  } else {
    frame.given.push_back(name.text);
  }
  frame.field = field;
  frame.fieldAt = name.at();
  if (auto* instance = dynamic_cast<ProtoInstance*>(&node)) instance->give(*field);
  void* storage = node.storage(*field);
  if (field->type == FieldType::SFNode) {
    *static_cast<NodeRef*>(storage) = {};
    receivers_.push_back({Receiver::Kind::single, storage, field, &node});
  } else if (field->type == FieldType::MFNode) {
    static_cast<MFNode*>(storage)->clear();
    receivers_.push_back({Receiver::Kind::multiple, storage, field, &node});
  }
  return {true, field->type, storage};
}

// The lines of a list of strings that has just been read, for the messages of programs in it.
std::vector<uint32_t> Builder::linesOfStrings(const char* from) {
  std::vector<uint32_t> lines;
  const char* end = lexer_.cursor();
  for (const char* p = lexer_.skipSpace(from); p < end; p = lexer_.skipSpace(p + 1)) {
    if (*p != '"') continue;
    lines.push_back(lexer_.place(p).line);
    for (++p; p < end && *p != '"'; ++p)
      if (*p == '\\') ++p;
  }
  return lines;
}

void Builder::closeField(bool good) {
  NodeFrame& frame = nodes_.back();
  const FieldInfo& field = *frame.field;
  if (frame.scriptType && field.name == "url" && good)
    static_cast<ScriptNode&>(*frame.node).urlLines =
        linesOfStrings(frame.fieldAt + field.name.size());
  if (holdsNodes(field)) {
    receivers_.pop_back();
  } else if (good && hasNormalizedAxes(field)) {
    Rotation first;
    const size_t outside = normalizeAxes(field.type, frame.node->storage(field), &first);
    if (outside > 0)
      lexer_.warn(
          frame.fieldAt,
          fmt::format("{}.{}: the axis {} {} {} has length {:.3g}, not 1; {} normalised",
                      frame.node->type().name, field.name, first.x, first.y, first.z,
                      axisLength(first),
                      outside == 1 ? "it is" : fmt::format("it and {} more are", outside - 1)));
  } else if (RangeFault fault; good && field.range.bounded() &&
                               !enforceRange(field, frame.node->storage(field), &fault)) {
    lexer_.warn(frame.fieldAt, xvrml::describe(frame.node->type(), field, fault));
  }
}

} // namespace xvrml
