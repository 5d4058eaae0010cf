#include "edit/document.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "graph/field_access.h"
#include "parse/loader.h"

namespace xvrml {
namespace {

uint64_t keyOf(const SourcePosition& place) { return uint64_t(place.line) << 32 | place.column; }

} // namespace

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

void Document::index(DocumentText& text) {
  std::unordered_set<uint64_t> routes;
  for (const Route& route : text.world->scope.routes) routes.insert(keyOf(route.source));
  for (RouteText& route : text.layout.routes)
    route.valid = routes.contains(uint64_t(route.line) << 32 | route.column);
  keepThoseIn(text.world->scope.roots, text.layout.roots);
  for (auto& [node, place] : text.layout.nodes) {
    for (FieldText& field : place.fields)
      if (const FieldInfo* info = node->type().find(field.name);
          info && info->type == FieldType::MFNode)
        keepThoseIn(*static_cast<const MFNode*>(node->storage(*info)), field.nodes);
    text.byPlace.emplace(keyOf(node->source), const_cast<Node*>(node));
    owners_.emplace(node, &text);
  }
}

Node* Document::find(const SourcePosition& place) const {
  if (!place.file) return nullptr;
  const auto text = byName_.find(*place.file);
  if (text == byName_.end()) return nullptr;
  const auto found = text->second->byPlace.find(keyOf(place));
  return found == text->second->byPlace.end() ? nullptr : found->second;
}

const DocumentText& Document::textOf(const Node& node) const { return *owners_.at(&node); }
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
  namesAreOld_ = true;
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
  namesAreOld_ = true;
  touch(parent, field);
  *static_cast<NodeRef*>(parent.storage(field)) = std::move(child);
}

void Document::rename(Node& node, const std::string& name) {
  node.defName = name;
  namesAreOld_ = true;
}

const std::map<std::string, NodeRef, std::less<>>& Document::names() {
  auto& names = scope().names;
  if (!std::exchange(namesAreOld_, false)) return names;
  names.clear();
  // In the order of the file, so that the last node of a name has it.
  const std::vector<Node*> roots = rootsOf(scope());
  walk(std::vector<Node*>(roots.rbegin(), roots.rend()), [&](Node& node, std::vector<Node*>& open) {
    if (!node.defName.empty() && hasText(node)) names[node.defName] = NodeRef(&node);
    std::vector<Node*> children;
    appendChildren(node, children);
    open.insert(open.end(), children.rbegin(), children.rend());
  });
  return names;
}

std::string Document::freshName(const std::string& wish,
                                const std::set<std::string, std::less<>>& taken) {
  const auto& known = names();
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
