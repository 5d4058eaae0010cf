// expander.cpp: copies prototype bodies. Nodes that nothing can change are shared by all copies.
#include "graph/expander.h"

#include <utility>

#include <fmt/format.h>

#include "graph/crossing.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Returns whether events, names and the viewer never single out the node: it only draws or places
// something. If no connection, route or Script reaches such a node, it is the same in every copy.
bool isPassive(const Node& node) {
  const NodeType& type = node.type();
  if (type.index < 0) return false;
  if (!type.is("child")) return true;
  return type.name == "Shape" || type.name == "Group" || type.name == "Transform";
}

void appendNodes(const Value& value, std::vector<Node*>& nodes) {
  if (const auto* single = std::get_if<NodeRef>(&value)) nodes.push_back(single->get());
  if (const auto* many = std::get_if<MFNode>(&value)) {
    for (const NodeRef& node : *many) nodes.push_back(node.get());
  }
}

// The bytes that an element holds outside of its object.
uint64_t bytesOutside(const std::string& text) { return text.size() > 15 ? text.size() + 1 : 0; }
uint64_t bytesOutside(const Image& image) { return image.pixels.size(); }
template <class T> uint64_t bytesOutside(const T&) { return 0; }

} // namespace

uint64_t valueBytes(FieldType type, const void* storage) {
  return visitStorage(type, storage, [](const auto& value) -> uint64_t {
    using T = std::remove_cvref_t<decltype(value)>;
    if constexpr (isList<T>) {
      uint64_t bytes = value.size() * sizeof(ElementOf<T>);
      if constexpr (!Numeric<ElementOf<T>>)
        for (const auto& element : value) bytes += bytesOutside(element);
      return bytes;
    } else {
      return bytesOutside(value);
    }
  });
}

uint64_t nodeBytes(const Node& node) {
  const bool dynamic = node.type().index < 0;
  uint64_t bytes = dynamic ? 600 : 300;
  for (const FieldInfo& field : node.type().fields) {
    if (!holdsValue(field)) continue;
    bytes += valueBytes(field.type, node.storage(field)) +
             (dynamic || field.declared ? sizeof(Value) : 0);
  }
  return bytes;
}

void collectNodes(const std::vector<Node*>& roots, std::vector<Node*>& nodes,
                  std::unordered_map<const Node*, uint32_t>& index) {
  const auto add = [&](Node* node) {
    if (node && index.try_emplace(node, static_cast<uint32_t>(nodes.size())).second)
      nodes.push_back(node);
  };
  for (size_t i = nodes.size(); Node * root : roots) {
    add(root);
    for (; i < nodes.size(); ++i)
      forEachChild(*nodes[i], [&](NodeRef& child, const FieldInfo&) { add(child.get()); });
  }
}

// Returns the declaration that has the body, or null.
ProtoPtr Expander::definition(ProtoInstance& instance) {
  return instance.declaration->isExtern ? resolve_(*instance.declaration) : instance.declaration;
}

bool Expander::addNested(Plan& plan, ProtoInstance& nested, const SourcePosition& where) {
  const ProtoPtr inner = definition(nested);
  if (!inner) return true; // the instance expands to nothing
  const PlanPtr innerPlan = this->plan(inner, where);
  if (!innerPlan->usable) {
    if (innerPlan->computing && nested.declaration->isExtern)
      // Avoids a cycle of shared pointers.
      nested.declaration->resolved = nullptr;
    return false;
  }
  findUrlFields(*nested.declaration);
  plan.expandedNodes = saturatingAdd(plan.expandedNodes, innerPlan->expandedNodes);
  plan.bytes = saturatingAdd(plan.bytes, innerPlan->bytes);
  return true;
}

Expander::PlanPtr Expander::plan(const ProtoPtr& declaration, const SourcePosition& where) {
  PlanPtr& known = plans_[declaration.get()];
  const std::string& name = declaration->type->name;
  if (known) {
    if (known->computing) {
      state_.diagnostics.error(
          where, fmt::format("prototype '{}' contains an instance of itself (4.8.3)", name));
    }
    return known;
  }
  known = std::make_shared<Plan>();
  PlanPtr plan = known; // a copy of the pointer, because the table may move
  plan->declaration = declaration;
  plan->computing = true;
  std::vector<Node*> roots = rootsOf(declaration->body);
  for (const Route& route : declaration->body.routes) {
    roots.push_back(route.from.get());
    roots.push_back(route.to.get());
  }
  collectNodes(roots, plan->nodes, plan->index);
  markShared(*plan, *declaration);
  plan->expandedNodes = plan->nodes.size();
  bool good = true;
  const uint64_t limit = state_.options.limits.protoDepth;
  if (++depth_ > limit) {
    state_.diagnostics.error(
        where, fmt::format("prototypes within prototypes deeper than limit protoDepth={}", limit));
    good = false;
  }
  for (size_t i = 0; i < plan->nodes.size(); ++i)
    plan->ownBytes += plan->shared[i] ? 0 : nodeBytes(*plan->nodes[i]);
  plan->ownBytes += bytesOfConnection * declaration->is.size() +
                    bytesOfRoute * declaration->body.routes.size() +
                    bytesOfName * declaration->body.names.size();
  plan->bytes = plan->ownBytes;
  for (size_t i = 0; good && i < plan->nodes.size(); ++i) {
    if (auto* nested = nodeCast<ProtoInstance>(plan->nodes[i]))
      good = addNested(*plan, *nested, where);
  }
  good = good && addDefaults(*plan, where);
  --depth_;
  if (good) findUrlFields(*declaration);
  plan->usable = good;
  plan->computing = false;
  return plan;
}

// Adds the cost of the nodes in the interface's defaults, which are copied for each instance, too.
bool Expander::addDefaults(Plan& plan, const SourcePosition& where) {
  std::vector<Node*> roots, nodes;
  for (const FieldInfo& field : plan.declaration->type->fields)
    appendNodes(field.defaultValue, roots);
  std::unordered_map<const Node*, uint32_t> index;
  collectNodes(roots, nodes, index);
  plan.expandedNodes = saturatingAdd(plan.expandedNodes, nodes.size());
  for (Node* node : nodes) {
    plan.bytes = saturatingAdd(plan.bytes, nodeBytes(*node));
    if (auto* nested = nodeCast<ProtoInstance>(node); nested && !addNested(plan, *nested, where))
      return false;
  }
  return true;
}

void Expander::markShared(Plan& plan, const ProtoDeclaration& declaration) const {
  std::unordered_map<const Node*, uint32_t> reached;
  // Scripts and prototype instances. The nodes that they hold or get passed cannot be shared.
  std::vector<Node*> script;
  for (Node* node : plan.nodes) {
    if (node->type().index < 0) script.push_back(node);
  }
  std::vector<Node*> byScript;
  collectNodes(script, byScript, reached);
  plan.shared.resize(plan.nodes.size());
  for (size_t i = 0; i < plan.nodes.size(); ++i)
    plan.shared[i] = isPassive(*plan.nodes[i]) && !reached.contains(plan.nodes[i]);
  const auto exclude = [&](const NodeRef& node) {
    if (const auto found = plan.index.find(node.get()); found != plan.index.end())
      plan.shared[found->second] = false;
  };
  for (const IsConnection& connection : declaration.is) exclude(connection.node);
  for (const Route& route : declaration.body.routes) {
    exclude(route.from);
    exclude(route.to);
  }
  for (const Node* node : plan.nodes) { // each instance has a pose of its own
    if (const auto* figure = nodeCast<nodes::HAnimHumanoid>(node)) {
      exclude(figure->skinCoord);
      exclude(figure->skinNormal);
    } else if (const auto* segment = nodeCast<nodes::HAnimSegment>(node)) {
      exclude(segment->coord);
    }
  }
  // A node that holds an unshared node is not shared either.
  std::vector<std::vector<uint32_t>> holders(plan.nodes.size());
  std::vector<uint32_t> changed;
  for (uint32_t i = 0; i < plan.nodes.size(); ++i) {
    if (!plan.shared[i]) changed.push_back(i);
    forEachChild(*plan.nodes[i], [&](NodeRef& child, const FieldInfo&) {
      holders[plan.index.at(child.get())].push_back(i);
    });
  }
  while (!changed.empty()) {
    const uint32_t node = changed.back();
    changed.pop_back();
    for (const uint32_t holder : holders[node]) {
      if (plan.shared[holder]) {
        plan.shared[holder] = false;
        changed.push_back(holder);
      }
    }
  }
}

NodeRef Expander::copyNode(Node& original) {
  NodeRef copy;
  if (auto* instance = nodeCast<ProtoInstance>(&original)) {
    auto* made = new ProtoInstance(instance->typePtr, instance->declaration);
    copy = NodeRef(made);
    made->given = instance->given;
    made->urlBases = instance->urlBases;
  } else if (auto* script = nodeCast<ScriptNode>(&original)) {
    auto* made = new ScriptNode(script->typePtr);
    copy = NodeRef(made);
    made->urlLines = script->urlLines;
  } else {
    copy = makeLike(original);
  }
  copy->defName = original.defName;
  copy->source = original.source;
  ++state_.world.nodeCount;
  return copy;
}

void Expander::copyFields(const Node& original, Node& copy,
                          const std::unordered_map<const Node*, uint32_t>& index,
                          const std::vector<NodeRef>& copies) {
  const auto mapped = [&](const NodeRef& node) {
    const auto found = index.find(node.get());
    return found == index.end() ? node : copies[found->second];
  };
  for (const FieldInfo& field : original.type().fields) {
    if (!holdsValue(field) || original.isUnset(field)) continue;
    visitStorage(field.type, copy.storage(field), [&](auto& target) {
      using T = std::remove_reference_t<decltype(target)>;
      const T& source = *static_cast<const T*>(original.storage(field));
      if constexpr (std::is_same_v<T, NodeRef>) {
        target = mapped(source);
      } else if constexpr (std::is_same_v<T, MFNode>) {
        target.clear();
        for (const NodeRef& node : source) target.push_back(mapped(node));
      } else {
        target = source;
      }
    });
  }
}

std::vector<NodeRef> Expander::copyAll(const std::vector<Node*>& nodes,
                                       const std::unordered_map<const Node*, uint32_t>& index,
                                       const std::vector<bool>& shared,
                                       std::vector<NodeRef>& inlines) {
  std::vector<NodeRef> copies;
  copies.reserve(nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i)
    copies.push_back(!shared.empty() && shared[i] ? NodeRef(nodes[i]) : copyNode(*nodes[i]));
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (copies[i].get() == nodes[i]) continue;
    copyFields(*nodes[i], *copies[i], index, copies);
    if (state_.selfContaining.contains(nodes[i])) state_.selfContaining.insert(copies[i].get());
    if (nodeCast<ProtoInstance>(copies[i])) todo_.push_back(copies[i]);
    if (nodeCast<InlineNode>(copies[i])) inlines.push_back(copies[i]);
    // A copy of a node that may hold itself may hold itself, too.
    if (state_.cycleHolders.contains(nodes[i])) addCyclic(copies[i]);
  }
  return copies;
}

// Returns a copy of an interface's default, with nodes of its own.
Value Expander::copyDefault(const FieldInfo& declared, std::vector<NodeRef>& inlines) {
  Value value = declared.defaultValue;
  if (!holdsNodes(declared)) return value;
  std::vector<Node*> roots, nodes;
  appendNodes(value, roots);
  std::unordered_map<const Node*, uint32_t> index;
  collectNodes(roots, nodes, index);
  const std::vector<NodeRef> copies = copyAll(nodes, index, {}, inlines);
  const auto map = [&](NodeRef& node) {
    if (node) node = copies[index.at(node.get())];
  };
  if (auto* single = std::get_if<NodeRef>(&value)) map(*single);
  if (auto* many = std::get_if<MFNode>(&value)) std::for_each(many->begin(), many->end(), map);
  return value;
}

// Finds a field as NodeType::find does, but in constant time for types of many fields: instances of
// such a prototype look up every one of them.
const FieldInfo* Expander::fieldOf(const NodeType& type, std::string_view name) {
  constexpr size_t few = 32;
  if (type.fields.size() <= few) return type.find(name);
  auto& byName = fieldsByName_[&type];
  if (byName.size() != type.fields.size()) {
    byName.clear();
    for (uint32_t i = 0; i < type.fields.size(); ++i) byName.emplace(type.fields[i].name, i);
  }
  const auto found = byName.find(std::string(name));
  if (found != byName.end() && type.fields[found->second].name == name)
    return &type.fields[found->second];
  return type.find(name);
}

// Sets the fields that the instance does not give to the declaration's defaults. For an
// EXTERNPROTO, whose interface has none, these are all such fields.
void Expander::completeFields(ProtoInstance& instance, const ProtoDeclaration& definition,
                              std::vector<NodeRef>& inlines) {
  for (const FieldInfo& field : instance.type().fields) {
    if (!holdsValue(field) || instance.isGiven(field)) continue;
    const FieldInfo* declared = fieldOf(*definition.type, field.name);
    if (declared && declared->type == field.type && holdsValue(*declared)) {
      instance.values[field.offset] = copyDefault(*declared, inlines);
      if (field.type == FieldType::MFString) instance.setUrlBase(field, definition.source.file);
    }
  }
}

void Expander::expandOne(ProtoInstance& instance, std::vector<NodeRef>& inlines) {
  const ProtoPtr definition = this->definition(instance);
  if (!definition) return;
  const PlanPtr plan = this->plan(definition, instance.source);
  if (!plan->usable) return;
  findUrlFields(*instance.declaration);
  const Limits& limits = state_.options.limits;
  const std::string& name = definition->type->name;
  if (saturatingAdd(state_.world.nodeCount, plan->expandedNodes) > limits.expandedNodes) {
    state_.diagnostics.error(
        instance.source,
        fmt::format(
            "prototype '{}' expands to {} nodes: more than limit expandedNodes={}; not expanded",
            name, plan->expandedNodes, limits.expandedNodes));
    return;
  }
  if (plan->bytes > state_.budget.left() || !state_.budget.take(plan->ownBytes)) {
    state_.diagnostics.error(instance.source,
                             fmt::format("copies of prototype '{}' and the rest of the world take "
                                         "more memory than {}; not expanded",
                                         name, state_.budget.name()));
    return;
  }
  completeFields(instance, *definition, inlines);
  const std::vector<NodeRef> copies = copyAll(plan->nodes, plan->index, plan->shared, inlines);
  const auto map = [&](const NodeRef& node) {
    const auto found = plan->index.find(node.get());
    return found == plan->index.end() ? node : copies[found->second];
  };
  Scope& body = instance.body;
  body.prototypes = definition->body.prototypes;
  for (const NodeRef& root : definition->body.roots) body.roots.push_back(map(root));
  for (const Route& route : definition->body.routes) {
    body.routes.push_back(
        {map(route.from), route.fromField, map(route.to), route.toField, route.source});
    ++state_.routes;
  }
  for (const auto& [key, node] : definition->body.names) body.names.emplace(key, map(node));
  for (const IsConnection& connection : definition->is) {
    instance.is.push_back({map(connection.node), connection.field, connection.interfaceName});
  }
  applyConnections(instance, *definition, inlines);
}

void Expander::expand(const std::vector<NodeRef>& instances, std::vector<NodeRef>& inlines) {
  // The stack keeps the order of the file.
  todo_.assign(instances.rbegin(), instances.rend());
  while (!todo_.empty()) {
    const NodeRef next = std::move(todo_.back());
    todo_.pop_back();
    auto& instance = *nodeCast<ProtoInstance>(next);
    if (instance.body.roots.empty()) expandOne(instance, inlines);
  }
}

// Applies "field IS name": the node in the body gets the instance's value (4.8.2).
void Expander::applyConnections(ProtoInstance& instance, const ProtoDeclaration& definition,
                                std::vector<NodeRef>& inlines) {
  // Fields that the EXTERNPROTO's interface leaves out, with their defaults.
  std::unordered_map<std::string_view, Value> undeclared;
  for (const IsConnection& connection : instance.is) {
    const FieldInfo* to = fieldOf(connection.node->type(), connection.field);
    if (!to || !holdsValue(*to)) continue;
    const FieldInfo* from = fieldOf(instance.type(), connection.interfaceName);
    if (from && holdsValue(*from) && from->type == to->type) {
      connect(instance, *from, instance.values[from->offset], connection, urlBase(instance, *from));
      continue;
    }
    const FieldInfo* declared = fieldOf(*definition.type, connection.interfaceName);
    if (!declared || !holdsValue(*declared) || declared->type != to->type ||
        &definition == instance.declaration.get())
      continue;
    auto found = undeclared.find(declared->name);
    if (found == undeclared.end())
      found = undeclared.emplace(declared->name, copyDefault(*declared, inlines)).first;
    connect(instance, *declared, found->second, connection, definition.source.file);
  }
}

// Finds the declaration's fields that hold URLs (ProtoDeclaration::urlFields): those of a PROTO are
// connected to such fields of the body, those of an EXTERNPROTO belong to its definition. The
// prototypes that the body uses, and the definition, must have been looked at before.
void Expander::findUrlFields(ProtoDeclaration& declaration) {
  std::vector<bool>& urls = declaration.urlFields;
  if (!urls.empty() || declaration.type->fields.empty()) return;
  urls.resize(declaration.type->fields.size());
  const auto listNamed = [&](const NodeType& type, std::string_view name) {
    const FieldInfo* field = fieldOf(type, name);
    return field && field->type == FieldType::MFString && holdsValue(*field) ? field : nullptr;
  };
  if (const ProtoDeclaration* definition = declaration.resolved.get()) {
    for (const FieldInfo& field : declaration.type->fields) {
      if (field.type != FieldType::MFString || !holdsValue(field)) continue;
      const FieldInfo* defined = listNamed(*definition->type, field.name);
      urls[field.offset] = defined && definition->holdsUrls(*defined);
    }
    return;
  }
  for (const IsConnection& connection : declaration.is) {
    const FieldInfo* from = listNamed(*declaration.type, connection.interfaceName);
    const FieldInfo* to = listNamed(connection.node->type(), connection.field);
    if (from && to && holdsUrls(*connection.node, *to)) urls[from->offset] = true;
  }
}

void Expander::addCyclic(const NodeRef& node) {
  if (state_.cycleHolders.insert(node.get()).second) state_.world.cyclic.push_back(node);
}

void Expander::connect(const ProtoInstance& instance, const FieldInfo& from, const Value& value,
                       const IsConnection& connection,
                       const std::shared_ptr<const std::string>& base) {
  Node& node = *connection.node;
  const FieldInfo& to = *fieldOf(node.type(), connection.field);
  if (auto* inner = nodeCast<ProtoInstance>(&node)) inner->give(to);
  if (!state_.selfContaining.empty() && node.type().index < 0 && holdsNodes(to))
    addCyclic(connection.node); // it may hold itself; more is not known
  const void* const storage =
      std::visit([](const auto& alternative) -> const void* { return &alternative; }, value);
  if (!state_.budget.take(valueBytes(to.type, storage))) {
    if (!std::exchange(state_.full, true))
      state_.diagnostics.error(instance.source,
                               fmt::format("the world takes more memory than {}; values of "
                                           "prototype '{}' from {} on are left out",
                                           state_.budget.name(), instance.type().name, from.name));
    return;
  }
  const IsAssignment assignment{instance, from, node, to, base, !state_.selfContaining.empty()};
  assignThroughIs(assignment, value, state_.diagnostics);
}

} // namespace xvrml
