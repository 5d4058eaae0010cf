#include "edit/document.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "graph/field_access.h"
#include "parse/loader.h"

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
}

Document::~Document() = default;

const DocumentText& Document::read(const std::string& text, const std::string& name) {
  DocumentText& made = texts_.emplace_back();
  made.text = text;
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

// Forgets the places of nodes that the world did not take, so that their text is left as it is.
static void keepThoseIn(const MFNode& list, std::vector<NodePlace>& places) {
  size_t next = 0;
  std::erase_if(places, [&](const NodePlace& place) {
    const bool taken = next < list.size() && list[next].get() == place.node;
    next += taken;
    return !taken;
  });
}

// Returns whether a field holds what its text has, and nothing else.
static bool isWhole(const Node& node, const FieldInfo& field,
                    const std::vector<NodePlace>& places) {
  if (field.type == FieldType::SFNode) {
    const Node* const child = static_cast<const NodeRef*>(node.storage(field))->get();
    return places.size() <= 1 && (places.empty() ? nullptr : places[0].node) == child;
  }
  const MFNode& list = *static_cast<const MFNode*>(node.storage(field));
  return std::equal(
      list.begin(), list.end(), places.begin(), places.end(),
      [](const NodeRef& one, const NodePlace& place) { return one.get() == place.node; });
}

void Document::index(DocumentText& text) {
  std::unordered_set<uint64_t> routes;
  for (const Route& route : text.world->scope.routes)
    routes.insert(placeKey(route.source.line, route.source.column));
  for (RouteText& route : text.layout.routes)
    route.valid = routes.contains(placeKey(route.line, route.column));
  keepThoseIn(text.world->scope.roots, text.layout.roots);
  std::set<std::string, std::less<>> names;
  for (auto& [node, place] : text.layout.nodes) {
    for (FieldText& field : place.fields) {
      const FieldInfo* const info = node->type().find(field.name);
      field.faithful =
          info && (holdsNodes(*info) ? isWhole(*node, *info, field.nodes) : field.readable);
    }
    text.byPlace.emplace(placeKey(node->source.line, node->source.column), const_cast<Node*>(node));
    owners_.emplace(node, &text);
    names_.emplace(node, node->defName);
    if (!node->defName.empty() && !names.insert(node->defName).second)
      repeated_.insert(node->defName);
  }
}

Node* Document::find(const SourcePosition& place) const {
  if (!place.file) return nullptr;
  const auto text = byName_.find(*place.file);
  if (text == byName_.end()) return nullptr;
  const auto found = text->second->byPlace.find(placeKey(place.line, place.column));
  return found == text->second->byPlace.end() ? nullptr : found->second;
}

const DocumentText& Document::textOf(const Node& node) const { return *owners_.at(&node); }
const FieldText* Document::textOf(const Node& node, const FieldInfo& field) const {
  const std::vector<FieldText>& fields = placeOf(node).fields;
  const auto last = std::find_if(fields.rbegin(), fields.rend(),
                                 [&](const FieldText& one) { return one.name == field.name; });
  return last == fields.rend() ? nullptr : &*last;
}

const NodeText& Document::placeOf(const Node& node) const {
  return textOf(node).layout.nodes.at(&node);
}

// Keeps the value of a field that is about to be changed.
void Document::touch(Node& node, const FieldInfo& field) {
  originals_[&node].try_emplace(field.name, node.get(field));
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
  return found == known->second.end() ? nullptr : &found->second;
}

MFNode& Document::listToChange(Node* parent, const FieldInfo* field) {
  if (!parent) return scope().roots;
  touch(*parent, *field);
  return *static_cast<MFNode*>(parent->storage(*field));
}

const MFNode& Document::listOf(const Node* parent, const FieldInfo* field) const {
  return parent ? *static_cast<const MFNode*>(parent->storage(*field)) : scope().roots;
}

void Document::insert(Node* parent, const FieldInfo* field, size_t index, const NodeRef& node) {
  MFNode& list = listToChange(parent, field);
  list.insert(list.begin() + std::ptrdiff_t(std::min(index, list.size())), node);
}

void Document::erase(Node* parent, const FieldInfo* field, size_t index) {
  MFNode& list = listToChange(parent, field);
  if (index < list.size()) list.erase(list.begin() + std::ptrdiff_t(index));
}

void Document::setNode(Node& parent, const FieldInfo& field, NodeRef child) {
  touch(parent, field);
  *static_cast<NodeRef*>(parent.storage(field)) = std::move(child);
}

void Document::rename(Node& node, const std::string& name) {
  auto& names = scope().names;
  const auto known = names.find(node.defName);
  const bool isNamed = known != names.end() && known->second.get() == &node;
  if (isNamed) names.erase(known);
  if (!name.empty() && (isNamed || node.defName.empty())) names[name] = NodeRef(&node);
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

SeenNodes Document::standing() const {
  SeenNodes seen;
  walk(rootsOf(scope()), seen,
       [](Node& node, std::vector<Node*>& open) { appendChildren(node, open); });
  return seen;
}

} // namespace xvrml
