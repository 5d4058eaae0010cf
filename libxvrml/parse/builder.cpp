// builder.cpp: builds nodes and their fields. Names, routes and IS are in builder_names.cpp,
// prototypes in builder_proto.cpp.
#include "parse/builder.h"

#include <utility>

#include <fmt/format.h>

#include "base/rotation.h"
#include "base/x3d.h"
#include "graph/expander.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "graph/node_kinds.h"
#include "graph/range.h"
#include "nearest.h"
#include "nodes/registry.h"
#include "xvrml/versions.h"

namespace xvrml {

Builder::Builder(Locator& locator, LoadState& state, ParsedFile& file)
    : locator_(locator), state_(state), file_(file) {
  pushScope(&file.scope, nullptr, nullptr);
  for (const ProtoPtr& prototype : state.known)
    scope().types.emplace(prototype->type->name, prototype);
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
      name->second = before->second; // the former owner gets the name back
      continue;
    }
    frame.lost.insert(frame.defined[i]);
    if (name != frame.scope->names.end()) frame.scope->names.erase(name);
  }
  frame.defined.resize(mark.names);
  frame.scope->routes.resize(mark.routes);
  if (frame.proto) frame.proto->is.resize(mark.connections);
}

bool Builder::declaresFields() const {
  return nodes_.size() > scopes_.back().outerNodes && nodes_.back().declares;
}

// Makes a node of a type. Returns false, with a message, if it cannot.
bool Builder::makeNode(const Name& type, NodeFrame& frame) {
  if (isBeingDeclared(type.text)) {
    locator_.error(type.at, fmt::format("prototype {} contains an instance of itself (4.8.3)",
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
      locator_.warn(type.at, fmt::format("this node is left out, because prototype {} was left out",
                                         describe(type)));
    } else {
      reportUnknownNode(type);
    }
    return false;
  }
  warnOfX3d(*known, type);
  warnOfLack(*known, type);
  if (known->name == "Script") {
    ++state_.scripts;
    frame.ownType = makeOwnType(*known);
    frame.node = NodeRef(new ScriptNode(frame.ownType));
  } else {
    frame.node = makeStaticNode(*known);
    if (isX3d())
      for (const FieldInfo& field : known->fields)
        if (const auto* revision = revisionOf(*known, field, file_.head.version))
          frame.node->set(field, revision->defaultValue);
  }
  frame.declares = known->is("declaring");
  return true;
}

// Reserves memory from the world's budget. Returns false, after one message, if not enough is left.
bool Builder::reserveMemory(uint64_t bytes, const Name& at) {
  if (state_.budget.take(bytes)) return true;
  if (!std::exchange(state_.full, true))
    locator_.error(at.at,
                   fmt::format("the world takes more memory than {}; nodes from {} on are left out",
                               state_.budget.name(), describe(at)));
  return false;
}

bool Builder::openNode(const Name& type, const Name* def) {
  NodeFrame frame{{}, type, {}, mark(), 1, {}, nullptr, nullptr, false};
  const uint64_t limit = state_.options.limits.expandedNodes;
  bool made = false;
  if (state_.world.nodeCount >= limit) {
    locator_.error(type.at, fmt::format("more nodes than limit expandedNodes={}; {} is left out",
                                        limit, describe(type)));
  } else if (!reserveMemory((def ? bytesOfName + def->text.size() : 0), type)) {
    made = false;
  } else {
    made = makeNode(type, frame) && reserveMemory(nodeBytes(*frame.node), type);
  }
  if (!made) {
    if (def) lostName(*def);
    return false;
  }
  ++state_.world.nodeCount;
  Node& node = *frame.node;
  node.source = locator_.place(type.at);
  if (!inTemplate()) {
    if (nodeCast<ProtoInstance>(&node)) file_.instances.push_back(frame.node);
    if (node.type().index == nodes::Inline::typeIndex) file_.inlines.push_back(frame.node);
  }
  if (def) {
    node.defName = def->text;
    const auto [named, fresh] = scope().scope->names.try_emplace(node.defName, frame.node);
    if (!fresh) scope().earlier.emplace(&node, std::exchange(named->second, frame.node));
    scope().defined.push_back(def->text);
  }
  frame.firstGiven = given_.size();
  nodes_.push_back(std::move(frame));
  return true;
}

void Builder::closeNode(bool good) {
  NodeFrame frame = std::move(nodes_.back());
  given_.resize(nodes_.back().firstGiven);
  nodes_.pop_back();
  if (good) noteGlobe(frame);
  const uint64_t limit = state_.options.limits.expandedNodes;
  if (good && frame.expanded > limit) {
    locator_.error(frame.type.at, fmt::format("{} contains {} nodes, shared ones counted at each "
                                              "USE: more than limit expandedNodes={}",
                                              describe(frame.type), frame.expanded, limit));
    good = false;
  }
  if (!good) return rollBack(frame.mark);
  // Only a USE asks for the count.
  if (frame.expanded > 1 && !frame.node->defName.empty())
    expanded_.emplace(frame.node.get(), frame.expanded);
  // A node that is good but in a wrong place keeps its names, because a later USE may put it in a
  // right one. In a prototype's body it keeps them only if none of its fields is connected to the
  // interface.
  const Mark now = mark();
  const bool keeps = now.names > frame.mark.names && now.connections == frame.mark.connections;
  if (!accepts(nodeTargets_.back(), frame.type, *frame.node,
               keeps ? "; the DEF names in it can still be USEd" : "")) {
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

// Returns the type that a node of the named type stands for, or the node with that DEF name. Null
// if it is not known, as for a prototype in another file.
const NodeType* Builder::typeOf(std::string_view name, bool use) const {
  const Node* node = nullptr;
  if (use) {
    const auto found = scopes_.back().scope->names.find(name);
    node = found == scopes_.back().scope->names.end() ? nullptr : found->second.get();
  } else if (const ProtoPtr proto = findPrototype(name)) {
    node = firstNode(proto.get());
  } else {
    return findNodeType(name);
  }
  return node ? effectiveType(*node) : nullptr;
}

bool Builder::wouldAccept(size_t nodeTarget, std::string_view name, bool use) const {
  if (use) {
    const auto found = scopes_.back().scope->names.find(name);
    if (found == scopes_.back().scope->names.end() || isOpen(found->second.get())) return false;
  }
  return acceptsType(nodeTargets_[nodeTarget - 1], typeOf(name, use));
}

std::string_view Builder::fieldFor(std::string_view name, bool use) const {
  if (use ? !scopes_.back().scope->names.contains(name) : !typeNamed(name)) return {};
  return usualField(nodes_.back().node->type(), typeOf(name, use), file_.head.version);
}

// Returns the node types that may be added here; "" means all.
std::string_view Builder::acceptedTypes(const NodeTarget& nodeTarget) const {
  if (nodeTarget.kind == NodeTarget::Kind::roots)
    return inTemplate() || state_.anyRoots ? "" : "child";
  return nodeTarget.field ? std::string_view(nodeTarget.field->nodeTypes) : "";
}

// Returns whether a node of the type may be added. A null type is that of an EXTERNPROTO, which is
// known only when it is loaded.
bool Builder::acceptsType(const NodeTarget& nodeTarget, const NodeType* type) const {
  const std::string_view wanted = acceptedTypes(nodeTarget);
  return !type || wanted.empty() || typeAccepted(wanted, *type);
}

bool Builder::accepts(const NodeTarget& nodeTarget, const Name& at, const Node& node,
                      std::string_view remedy) {
  const NodeType* type = effectiveType(node);
  if (acceptsType(nodeTarget, type)) return true;
  const bool root = nodeTarget.kind == NodeTarget::Kind::roots;
  const std::string_view wanted = acceptedTypes(nodeTarget);
  const std::string stands = type == &node.type() ? "" : fmt::format(" ({})", type->name);
  if (root) {
    locator_.error(
        at.at,
        fmt::format("{}{} cannot stand at the root of a file: expected a child node (4.6.5){}",
                    describe(at), stands, remedy));
  } else {
    locator_.error(at.at, fmt::format("{}{} cannot be in field {} of {}: expected {}{}",
                                      describe(at), stands, nodeTarget.field->name,
                                      nodeTarget.holder->type().name, wanted, remedy));
  }
  return false;
}

// Adds a node. Returns false, after a message, if it is not accepted where it is written.
bool Builder::deliver(const Name& at, const NodeRef& node, uint64_t expanded) {
  return accepts(nodeTargets_.back(), at, *node, "") && place(at, node, expanded);
}

// Adds an accepted node. Returns false, after a message, if there are too many nodes.
bool Builder::place(const Name& at, const NodeRef& node, uint64_t expanded) {
  NodeTarget& nodeTarget = nodeTargets_.back();
  const bool root = nodeTarget.kind == NodeTarget::Kind::roots;
  uint64_t& sum = root || nodes_.empty() || nodeTarget.holder == nullptr ? scope().expanded
                                                                         : nodes_.back().expanded;
  const uint64_t limit = state_.options.limits.expandedNodes;
  if (root && saturatingAdd(sum, expanded) > limit) {
    locator_.error(at.at, fmt::format("more nodes, shared ones counted at each use, than limit "
                                      "expandedNodes={}; {} is left out",
                                      limit, describe(at)));
    return false;
  }
  sum = saturatingAdd(sum, expanded);
  switch (nodeTarget.kind) {
  case NodeTarget::Kind::roots: scope().scope->roots.push_back(node); break;
  case NodeTarget::Kind::single: *static_cast<NodeRef*>(nodeTarget.storage) = node; break;
  case NodeTarget::Kind::multiple: static_cast<MFNode*>(nodeTarget.storage)->push_back(node); break;
  }
  return true;
}

void Builder::nullNode(const Name& token) {
  const NodeTarget& nodeTarget = nodeTargets_.back();
  if (nodeTarget.kind == NodeTarget::Kind::single)
    *static_cast<NodeRef*>(nodeTarget.storage) = {};
  else if (!nodeTarget.field || keepsNull(nodeTarget.holder->type()) ||
           // A list in an interface may become the value of a field that keeps NULL.
           nodeTarget.holder->type().index < 0)
    static_cast<MFNode*>(nodeTarget.storage)->emplace_back();
  else
    locator_.warn(token.at, "NULL cannot be in a list of nodes; it is left out");
}

bool Builder::hasField(std::string_view name) const {
  if (nodes_.size() <= scopes_.back().outerNodes) return false;
  const NodeType& type = nodes_.back().node->type();
  return type.find(spelled(type, name)) || lacksField(type, name);
}

// Returns whether the field of the innermost open node has been read before.
bool Builder::isGiven(const Name& name) const {
  const auto first = given_.begin() + ptrdiff_t(nodes_.back().firstGiven);
  return std::find(first, given_.end(), name.text) != given_.end();
}

FieldTarget Builder::openField(const Name& name) {
  NodeFrame& frame = nodes_.back();
  Node& node = *frame.node;
  const FieldInfo* field = node.type().find(spelled(node.type(), name.text));
  if (!field) {
    if (isMissingField(node.type(), name)) return {};
    const std::string near = nearest::suggestion(name.text, node.type().fields);
    // A field of X3D that we lack: a file of VRML97 may not have it in any case.
    const char* dialect = isX3dField(node.type().name, name.text) ? " (it is X3D's)" : "";
    locator_.error(name.at,
                   fmt::format("{} has no field {}{}{}{}he field is ignored", node.type().name,
                               describe(name), dialect, near, near.empty() ? "; t" : " T"));
    return {};
  }
  warnOfX3d(node.type(), *field, name);
  if (!holdsValue(*field)) {
    locator_.error(name.at, fmt::format("{} is an {} of {}: it has no value in a file",
                                        describe(name), word(field->access), node.type().name));
    return {};
  }
  if (isGiven(name)) {
    locator_.warn(name.at,
                  fmt::format("field {} is given twice; the last one counts", describe(name)));
  } else {
    given_.push_back(name.text);
  }
  frame.fieldAt = name.at;
  return targetOf(*field, false);
}

FieldTarget Builder::resumeField(const Name& name) {
  NodeFrame& frame = nodes_.back();
  const NodeType& type = frame.node->type();
  const FieldInfo* field = type.find(spelled(type, name.text));
  if (!field || !isGiven(name) || !isMultiple(field->type)) return openField(name);
  frame.fieldAt = name.at;
  return targetOf(*field, true);
}

// Makes a field of the open node the one that is read. `resumed`: its value stays.
FieldTarget Builder::targetOf(const FieldInfo& field, bool resumed) {
  NodeFrame& frame = nodes_.back();
  Node& node = *frame.node;
  frame.field = &field;
  if (auto* instance = nodeCast<ProtoInstance>(&node)) instance->give(field);
  void* storage = node.storage(field);
  if (field.type == FieldType::SFNode) {
    *static_cast<NodeRef*>(storage) = {};
    nodeTargets_.push_back({NodeTarget::Kind::single, storage, &field, &node});
  } else if (field.type == FieldType::MFNode) {
    if (!resumed) static_cast<MFNode*>(storage)->clear();
    nodeTargets_.push_back({NodeTarget::Kind::multiple, storage, &field, &node});
  }
  FieldTarget target{true, field.type, storage};
  if (auto* script = nodeCast<ScriptNode>(&node); script && field.name == "url")
    target.stringLines = &script->urlLines;
  return target;
}

void Builder::closeField(bool good) {
  NodeFrame& frame = nodes_.back();
  const FieldInfo& field = *frame.field;
  if (holdsNodes(field)) {
    nodeTargets_.pop_back();
    return;
  }
  if (!good) {
    frame.node->set(field, defaultIn(frame.node->type(), field, file_.head.version));
    return;
  }
  if (angle_ != 1 && isAngle(*frame.node, field))
    convertAngles(field.type, frame.node->storage(field));
  if (hasNormalizedAxes(field)) {
    Rotation first;
    const size_t outside = normalizeAxes(field.type, frame.node->storage(field), &first);
    if (outside > 0)
      locator_.warn(
          frame.fieldAt,
          fmt::format("{}.{}: the axis {} {} {} has length {:.3g}, not 1; {} normalised",
                      frame.node->type().name, field.name, first.x, first.y, first.z,
                      axisLength(first),
                      outside == 1 ? "it is" : fmt::format("it and {} more are", outside - 1)));
  } else if (field.range.bounded()) {
    const NodeType& type = frame.node->type();
    RangeFault fault;
    if (!enforceRange(field, revisionOf(type, field, file_.head.version),
                      frame.node->storage(field), &fault))
      locator_.warn(frame.fieldAt, xvrml::describe(type, field, fault));
  }
}

} // namespace xvrml
