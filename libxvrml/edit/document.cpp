#include "edit/document.h"

#include <algorithm>
#include <span>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "edit/lines.h"
#include "graph/field_access.h"
#include "parse/loader.h"
#include "parse/parser.h"

namespace xvrml {

Document::Document(std::string text, const std::string& path, const LoadOptions& options)
    : options_([&] {
        LoadOptions own = options;
        own.loadInlines = false; // what other files hold is not part of this one
        return own;
      }()) {
  DocumentText& made = texts_.emplace_back();
  made.text = std::move(text);
  made.world = loadWithLayout(made.text, path, options_, made.layout);
  byName_.emplace(path, &made);
  index(made);
  for (const NodeRef& root : scope().roots) standing_.add(root.get(), nullptr);
}

Document::~Document() = default;

const DocumentText& Document::read(const std::string& text, const std::string& name) {
  DocumentText& made = texts_.emplace_back();
  made.text = withLineFeed(text, lineFeedOf(file().text), isXml());
  try {
    made.world = loadWithLayout(made.text, name, options_, made.layout, world().head.version);
  } catch (...) {
    texts_.pop_back();
    throw;
  }
  byName_.emplace(name, &made);
  index(made);
  return made;
}

void Document::forgetLastText() {
  const DocumentText& last = texts_.back();
  for (const NodeText& place : last.layout.nodes) {
    const Node* const node = place.node.get();
    known_.erase(node);
    renamed_.erase(node);
    originals_.erase(node);
    putIn_.erase(node);
    takenOut_.erase(node);
  }
  std::erase_if(byName_, [&last](const auto& one) { return one.second == &last; });
  texts_.pop_back();
}

uint64_t Document::mostNested() const {
  return std::min(options_.limits.nesting, Parser::maximumNesting);
}

// Notes which places of a list the world has taken. Returns whether these give all of the list.
static bool noteTaken(std::span<const NodeRef> list, std::vector<NodePlace>& places) {
  size_t next = 0;
  for (NodePlace& place : places) {
    place.taken = next < list.size() && list[next].get() == place.node;
    next += place.taken;
  }
  return next == list.size();
}

// Returns whether a field can be edited: it holds what its text has. A list may have more in its
// text, which is kept.
static bool isFaithful(const DocumentText& text, const Node& node, const FieldInfo& field,
                       FieldText& place) {
  if (!holdsNodes(field)) return place.readable;
  const bool isList = field.type == FieldType::MFNode;
  std::span<const NodeRef> nodes;
  if (isList)
    nodes = *static_cast<const MFNode*>(node.storage(field));
  else if (const auto* const child = static_cast<const NodeRef*>(node.storage(field)); *child)
    nodes = {child, 1};
  const bool whole = noteTaken(nodes, place.nodes);
  const auto taken = std::count_if(place.nodes.begin(), place.nodes.end(),
                                   [](const NodePlace& one) { return one.taken; });
  const bool hasOthers = size_t(taken) < place.nodes.size();
  if (!whole || !hasOthers) return whole;
  const bool isOpen = place.form == FieldForm::children ||
                      (place.form == FieldForm::element && place.value.begin == 0) ||
                      text.text[place.value.begin] == '[';
  const bool isNull = !isList && place.nodes.size() == 1 && !place.nodes[0].node;
  return isNull || (isList && isOpen && (place.readable || place.form != FieldForm::statement));
}

void Document::index(DocumentText& text) {
  std::unordered_set<uint64_t> routes;
  for (const Route& route : text.world->scope.routes)
    routes.insert(placeKey(route.source.line, route.source.column));
  for (RouteText& route : text.layout.routes)
    route.valid = routes.contains(placeKey(route.line, route.column));
  noteTaken(text.world->scope.roots, text.layout.roots);
  if (!text.world->cyclic.empty()) standing_.expectLoops();
  std::unordered_set<std::string_view> names;
  text.byPlace.reserve(text.layout.nodes.size());
  known_.reserve(known_.size() + text.layout.nodes.size());
  for (NodeText& place : text.layout.nodes) {
    Node& node = *place.node;
    for (FieldText& field : place.fields) {
      const FieldInfo* const info = node.type().find(field.name);
      field.faithful = info && isFaithful(text, node, *info, field);
    }
    text.byPlace.emplace_back(placeKey(node.source.line, node.source.column), &node);
    known_.insert(&node, {&text, &place});
    if (!node.defName.empty() && !names.insert(node.defName).second) repeated_.insert(node.defName);
  }
  std::sort(text.byPlace.begin(), text.byPlace.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
}

Node* Document::find(const SourcePosition& place) const {
  if (!place.file) return nullptr;
  const auto text = byName_.find(*place.file);
  if (text == byName_.end()) return nullptr;
  const auto& places = text->second->byPlace;
  const uint64_t key = placeKey(place.line, place.column);
  const auto found =
      std::lower_bound(places.begin(), places.end(), key,
                       [](const auto& one, uint64_t wanted) { return one.first < wanted; });
  return found == places.end() || found->first != key ? nullptr : found->second;
}

const FieldText* Document::textOf(const Node& node, const FieldInfo& field) const {
  const std::vector<FieldText>& fields = placeOf(node).fields;
  const auto last = std::find_if(fields.rbegin(), fields.rend(),
                                 [&](const FieldText& one) { return one.name == field.name; });
  return last == fields.rend() ? nullptr : &*last;
}

// Keeps the value of a field that is about to be changed. The text itself says which nodes a field
// had that it gives.
void Document::touch(Node& node, const FieldInfo& field) {
  auto& kept = originals_[&node];
  if (!kept.contains(field.name)) {
    const bool isInText = holdsNodes(field) && textOf(node, field);
    kept.emplace(field.name, isInText ? std::nullopt : std::optional<Value>(node.get(field)));
  }
  if (auto* instance = nodeCast<ProtoInstance>(&node)) instance->give(field);
}

void Document::set(Node& node, const FieldInfo& field, Value value) {
  touch(node, field);
  node.set(field, std::move(value));
}

const Value* Document::originalOf(const Node& node, const FieldInfo& field) const {
  const auto known = originals_.find(&node);
  if (known == originals_.end()) return nullptr;
  const auto found = known->second.find(field.name);
  return found == known->second.end() || !found->second ? nullptr : &*found->second;
}

// Returns the nodes that a text gives a field.
Value Document::nodesInText(const Node& node, const FieldInfo& field) const {
  MFNode nodes;
  for (const NodePlace& one : textOf(node, field)->nodes)
    if (one.taken) nodes.emplace_back(const_cast<Node*>(one.node));
  if (field.type == FieldType::MFNode) return nodes;
  return nodes.empty() ? NodeRef() : nodes.front();
}

MFNode& Document::listToChange(Node* parent, const FieldInfo* field) {
  if (!parent) return scope().roots;
  touch(*parent, *field);
  return *static_cast<MFNode*>(parent->storage(*field));
}

const MFNode& Document::listOf(const Node* parent, const FieldInfo* field) const {
  return parent ? *static_cast<const MFNode*>(parent->storage(*field)) : scope().roots;
}

// Nodes are counted where they stand: a parent may have been taken out itself.
void Document::insert(Node* parent, const FieldInfo* field, size_t index, const NodeRef& node) {
  MFNode& list = listToChange(parent, field);
  list.insert(list.begin() + std::ptrdiff_t(std::min(index, list.size())), node);
  putIn_.insert(node.get());
  if (!parent || stands(*parent)) standing_.add(node.get(), parent);
}

void Document::erase(Node* parent, const FieldInfo* field, size_t index) {
  MFNode& list = listToChange(parent, field);
  if (index >= list.size()) return;
  const NodeRef gone = list[index];
  const bool stood = !parent || stands(*parent);
  list.erase(list.begin() + std::ptrdiff_t(index));
  takenOut_.insert(gone.get());
  if (stood) standing_.remove(gone.get());
}

void Document::setNode(Node& parent, const FieldInfo& field, NodeRef child) {
  touch(parent, field);
  NodeRef& place = *static_cast<NodeRef*>(parent.storage(field));
  const bool stands = this->stands(parent);
  const NodeRef before = std::exchange(place, std::move(child));
  putIn_.insert(place.get());
  takenOut_.insert(before.get());
  if (!stands) return;
  standing_.add(place.get(), &parent);
  standing_.remove(before.get());
}

void Document::rename(Node& node, const std::string& name) {
  auto& names = scope().names;
  const auto known = names.find(node.defName);
  const bool isNamed = known != names.end() && known->second.get() == &node;
  if (isNamed) names.erase(known);
  if (!name.empty() && (isNamed || node.defName.empty())) names[name] = NodeRef(&node);
  renamed_.try_emplace(&node, node.defName);
  node.defName = name;
}

std::string Document::freshName(const std::string& wish,
                                const std::set<std::string, std::less<>>& taken) {
  const auto& known = scope().names;
  std::string name = wish;
  for (size_t i = 2; known.contains(name) || taken.contains(name); ++i)
    name = fmt::format("{}_{}", wish, i);
  return name;
}

} // namespace xvrml
