// builder_names.cpp: the scopes of files and prototypes: DEF and USE, routes, IS (ISO/IEC 14772-1
// 4.4.6, 4.6.2, 4.8.2, 4.10.2).
#include <fmt/format.h>

#include "graph/field_access.h"
#include "nearest.h"
#include "parse/builder.h"

namespace xvrml {
namespace {

// Returns whether a node's field or event may be connected to an interface declaration by IS (Table
// 4.4).
bool mayConnect(Access ofNode, Access ofInterface) {
  return ofNode == Access::exposedField || ofNode == ofInterface;
}

// Returns what a connection that Table 4.4 forbids still does: it connects one half of an
// exposedField. "" if it does nothing.
std::string_view intendedMeaning(Access ofNode, Access ofInterface) {
  if (ofInterface != Access::exposedField) return {};
  if (ofNode == Access::field) return "it takes the value of the instance, but no events";
  return ofNode == Access::eventIn ? "it takes the events" : "it sends the events";
}

std::vector<std::string> namesOf(const Scope& scope) {
  std::vector<std::string> names;
  for (const auto& [name, node] : scope.names) {
    if (names.size() == 200) break;
    names.push_back(name);
  }
  return names;
}

} // namespace

void Builder::pushScope(Scope* target, ProtoPtr proto, std::shared_ptr<NodeType> type) {
  ScopeFrame& frame = scopes_.emplace_back();
  if (!target) {
    frame.own = std::make_unique<Scope>();
    target = frame.own.get();
  }
  frame.scope = target;
  frame.proto = std::move(proto);
  frame.protoType = std::move(type);
  frame.outerNodes = nodes_.size();
  nodeTargets_.push_back({NodeTarget::Kind::roots, nullptr, nullptr, nullptr});
}

void Builder::popScope() {
  dropUnplacedNames();
  nodeTargets_.pop_back();
  scopes_.pop_back();
}

// Remembers the names of a node in a wrong place, because they may be USEd further down.
void Builder::keepNames(const Mark& mark) {
  auto& names = scope().misplaced.emplace_back();
  for (size_t i = mark.names; i < scope().defined.size(); ++i)
    if (const auto found = scope().scope->names.find(scope().defined[i]);
        found != scope().scope->names.end())
      names.emplace_back(scope().defined[i], found->second);
}

// Ends the file: its statements EXPORT may name nodes that were defined after them.
void Builder::finish() {
  dropUnplacedNames();
  for (const auto& [name, exported] : exports_) {
    if (isImported(name.text)) {
      locator_.error(name.at, fmt::format("{} is imported: a file exports its own nodes only "
                                          "(ISO/IEC 19775-1 4.4.6)",
                                          describe(name)));
    } else if (const NodeRef node = findName(name)) {
      if (reserveMemory(bytesOfName + exported.text.size(), name))
        exchange().exports.push_back({node, std::string(exported.text)});
    }
  }
}

// Drops the names of misplaced nodes that no USE and no ROUTE has put in a better place. Such nodes
// belong to no world, and a written file could not contain them. The former owner of a name gets it
// back.
void Builder::dropUnplacedNames() {
  ScopeFrame& frame = scope();
  std::unordered_set<const Node*> dropped;
  std::vector<std::string_view> theirs;
  for (const auto& names : frame.misplaced) {
    if (std::any_of(names.begin(), names.end(),
                    [&](const auto& one) { return frame.placed.contains(one.first); }))
      continue;
    for (const auto& [name, node] : names) {
      dropped.insert(node.get());
      theirs.push_back(name);
    }
  }
  for (const std::string_view name : theirs) {
    auto found = frame.scope->names.find(name);
    while (found != frame.scope->names.end() && dropped.contains(found->second.get())) {
      const auto before = frame.earlier.find(found->second.get());
      if (before == frame.earlier.end()) {
        frame.scope->names.erase(found);
        break;
      }
      found->second = before->second;
    }
  }
}

void Builder::lostName(const Name& name) { scope().lost.insert(name.text); }

bool Builder::isLost(std::string_view name) const {
  return std::any_of(scopes_.begin(), scopes_.end(),
                     [&](const ScopeFrame& frame) { return frame.lost.contains(name); });
}

bool Builder::isOpen(const Node* node) const {
  return std::any_of(nodes_.rbegin(), nodes_.rend(),
                     [&](const NodeFrame& frame) { return frame.node.get() == node; });
}

const Node* Builder::named(std::string_view name) const {
  const auto& names = scopes_.back().scope->names;
  const auto found = names.find(name);
  return found == names.end() ? nullptr : found->second.get();
}

// Returns the node that a name refers to here, or null after a message.
NodeRef Builder::findName(const Name& name) {
  const auto& names = scope().scope->names;
  const auto found = names.find(name.text);
  if (found != names.end()) return found->second;
  if (isImported(name.text)) {
    locator_.error(name.at, fmt::format("{} is imported: only routes can refer to it (ISO/IEC "
                                        "19775-1 4.4.6)",
                                        describe(name)));
    return {};
  }
  if (scope().lost.contains(name.text)) {
    if (scope().lostTold.insert(name.text).second)
      locator_.warn(name.at, fmt::format("{} was left out above", describe(name)));
    return {};
  }
  std::string hint = nearest::suggestion(name.text, namesOf(*scope().scope));
  if (inTemplate() && scopes_.front().scope->names.contains(name.text))
    hint = "; a prototype has names of its own (4.8.4)";
  locator_.error(name.at,
                 fmt::format("no node is named {} by a DEF above{}", describe(name), hint));
  return {};
}

// USE nodeNameId. Only the transformation hierarchy must have no cycle (4.4.4); the fields of
// Scripts and prototype instances are not part of it. A node may therefore be USEd within itself if
// a Script or an instance is in between. Expansion finds out whether a prototype passes the field
// into its body.
void Builder::useNode(const Name& name) {
  const NodeRef node = findName(name);
  if (!node) return;
  if (!isOpen(node.get())) {
    if (deliver(name, node, expandedCount(node.get()))) scope().placed.insert(name.text);
    return;
  }
  Node* between = nullptr;
  for (auto frame = nodes_.rbegin(); frame != nodes_.rend() && !between; ++frame) {
    if (frame->node->type().index < 0) between = frame->node.get();
    if (frame->node == node) break;
  }
  if (!between || !nodeTargets_.back().holder) {
    locator_.error(
        name.at,
        fmt::format("{} is USEd inside itself: a node cannot be its own descendant (4.4.4)",
                    describe(name)));
    return;
  }
  if (!deliver(name, node, 0)) return;
  state_.selfContaining.insert(node.get());
  state_.cycleHolders.insert(between);
  state_.world.cyclic.emplace_back(between);
}

// Return the event of our own name, if the node has it in this file's version.
const FieldInfo* Builder::eventIn(const NodeType& type, std::string_view own) const {
  const FieldInfo* const field = type.findEventIn(own);
  return field && field->exposedSince > file_.head.version.major ? nullptr : field;
}
const FieldInfo* Builder::eventOut(const NodeType& type, std::string_view own) const {
  const FieldInfo* const field = type.findEventOut(own);
  return field && field->exposedSince > file_.head.version.major ? nullptr : field;
}

void Builder::route(const Name& keyword, const RouteNames& names) {
  if (importedRoute(keyword, names)) return;
  const NodeRef from = findName(names.from);
  const NodeRef to = findName(names.to);
  if (!from || !to) return;
  const std::string_view fromField = spelled(from->type(), names.fromField.text);
  const std::string_view toField = spelled(to->type(), names.toField.text);
  const FieldInfo* out = eventOut(from->type(), fromField);
  const FieldInfo* in = eventIn(to->type(), toField);
  if (!out && isMissingField(from->type(), names.fromField)) return;
  if (!in && isMissingField(to->type(), names.toField)) return;
  if (!out) {
    locator_.error(names.fromField.at,
                   fmt::format("{} has no {} {}", from->type().name, word(Access::eventOut),
                               describe(names.fromField)));
  }
  if (!in)
    locator_.error(names.toField.at, fmt::format("{} has no {} {}", to->type().name,
                                                 word(Access::eventIn), describe(names.toField)));
  if (!out || !in) return;
  warnOfX3d(from->type(), *out, names.fromField);
  warnOfX3d(to->type(), *in, names.toField);
  if (out->type != in->type) {
    locator_.error(names.toField.at,
                   fmt::format("a route joins events of one type: {} is {}, {} is {}",
                               describe(names.fromField), fieldTypeName(out->type),
                               describe(names.toField), fieldTypeName(in->type)));
    return;
  }
  if (!reserveMemory(bytesOfRoute, keyword)) return;
  ++state_.routes;
  scope().placed.insert({names.from.text, names.to.text});
  scope().scope->routes.push_back(
      {from, std::string(fromField), to, std::string(toField), locator_.place(keyword.at)});
}

Builder::ScopeFrame* Builder::protoFrame() {
  return scope().proto && !scope().proto->isExtern ? &scope() : nullptr;
}

void Builder::connect(const Name& name, const Name& interfaceName) {
  NodeFrame& frame = nodes_.back();
  Node& node = *frame.node;
  const NodeType& type = node.type();
  const std::string_view own = spelled(type, name.text);
  const FieldInfo* field = type.find(own);
  Access access = field ? field->access : Access::eventIn;
  if (field && field->exposedSince > file_.head.version.major) access = Access::field;
  if (!field) { // set_x and x_changed of an exposedField x refer to its events
    if ((field = eventIn(type, own)))
      access = Access::eventIn;
    else if ((field = eventOut(type, own)))
      access = Access::eventOut;
  }
  if (!field && isMissingField(type, name)) return;
  if (!field) {
    locator_.error(name.at, fmt::format("{} has no field or event {}{}", type.name, describe(name),
                                        nearest::suggestion(name.text, type.fields)));
    return;
  }
  warnOfX3d(type, *field, name);
  ScopeFrame* proto = protoFrame();
  if (!proto) {
    locator_.error(name.at,
                   fmt::format("{} IS {}: IS stands in the body of a prototype only (4.8.2)",
                               describe(name), describe(interfaceName)));
    return;
  }
  const FieldInfo* declared = proto->protoType->find(interfaceName.text);
  if (!declared) {
    locator_.error(interfaceName.at,
                   fmt::format("prototype {} declares no {}{}", proto->protoType->name,
                               describe(interfaceName),
                               nearest::suggestion(interfaceName.text, proto->protoType->fields)));
    return;
  }
  if (declared->type != field->type) {
    locator_.error(interfaceName.at,
                   fmt::format("IS joins one type: {} of {} is {}, {} of the interface is {}",
                               describe(name), type.name, fieldTypeName(field->type),
                               describe(interfaceName), fieldTypeName(declared->type)));
    return;
  }
  if (!mayConnect(access, declared->access)) {
    const std::string_view meant = intendedMeaning(access, declared->access);
    // An inputOutput of a Script was read as initializeOnly, and reported there.
    const bool reported =
        isX3d() && nodeCast<ScriptNode>(frame.node) && access == Access::field && !meant.empty();
    const std::string text =
        fmt::format("{} {} of {} cannot be {} {} of the interface (4.8.2){}{}", word(access),
                    describe(name), type.name, word(declared->access), describe(interfaceName),
                    meant.empty() ? "" : ": ", meant);
    if (meant.empty()) return locator_.error(interfaceName.at, text);
    if (!reported) locator_.warn(interfaceName.at, text);
  }
  proto->proto->is.push_back({frame.node, std::string(own), std::string(interfaceName.text)});
}

} // namespace xvrml
