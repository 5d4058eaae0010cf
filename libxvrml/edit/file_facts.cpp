// file_facts.cpp: what can be asked about the file of an edited world: the nodes at places of its
// text, and the fields that edits have changed.
#include <algorithm>

#include <fmt/format.h>

#include "edit/edited_file.h"
#include "edit/nodes_at.h"
#include "graph/field_access.h"
#include "write/value_writer.h"
#include "xvrml/numbers.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

constexpr size_t longestValue = 200; // bytes

std::string countText(size_t nodes) {
  return fmt::format("{} node{}", nodes, nodes == 1 ? "" : "s");
}

// Shortens a list to more elements than are shown, so that a long one is not written as a whole.
template <class T> void shorten(T& value) {
  if constexpr (isList<T>)
    if (value.size() > longestValue) value.resize(longestValue);
}

// Returns a value as VRML97 writes it, if it is not too long.
std::string textOf(FieldType type, Value value) {
  std::visit([](auto& one) { shorten(one); }, value);
  std::string text;
  writeValue(text, type, std::visit([](auto& v) -> void* { return &v; }, value), 0);
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() <= longestValue) return text;
  size_t end = longestValue;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

// The nodes that a field, or the roots, had in the text of the file, and those that it has now.
struct NodesOfField {
  std::vector<const Node*> before, now;

  NodesOfField(const std::vector<NodePlace>& places, const MFNode& list) {
    for (const NodePlace& place : places)
      if (place.taken) before.push_back(place.node);
    for (const NodeRef& node : list) now.push_back(node.get());
  }
  bool differ() const { return before != now; }
  std::string textBefore() const { return countText(before.size()); }
  std::string textNow() const {
    return countText(now.size()) + (before.size() == now.size() ? ", not the same" : "");
  }
};

MFNode nodesOf(const Node& node, const FieldInfo& field) {
  if (field.type == FieldType::MFNode) return *static_cast<const MFNode*>(node.storage(field));
  const NodeRef& child = *static_cast<const NodeRef*>(node.storage(field));
  return child ? MFNode{child} : MFNode();
}

} // namespace

std::unordered_map<uint64_t, NodeRef>
EditedFile::liveNodesAt(const std::unordered_set<uint64_t>& places) {
  std::unordered_map<uint64_t, NodeRef> found;
  if (places.empty()) return found;
  walk(rootsOf(world().scope), [&](Node& node, std::vector<Node*>& open) {
    appendChildren(node, open);
    const SourcePosition& at = node.source;
    if (!at.file || *at.file != world().path) return;
    if (document_ && fileStamp(at.file) != read_) return; // the text is another one
    if (const uint64_t key = placeKey(at.line, at.column); places.contains(key))
      found.emplace(key, NodeRef(&node));
  });
  return found;
}

std::vector<NodeRef> EditedFile::nodesAt(std::span<const SourcePosition> places) {
  std::vector<NodeRef> nodes(places.size());
  if (live_->isReplaced()) return nodes;
  std::vector<uint64_t> keys(places.size());
  if (whyNot().empty()) {
    const std::vector<const Node*> found = xvrml::nodesAt(*document_, places);
    for (size_t i = 0; i < found.size(); ++i)
      if (found[i]) keys[i] = placeKey(found[i]->source.line, found[i]->source.column);
  } else {
    std::transform(places.begin(), places.end(), keys.begin(),
                   [](const SourcePosition& one) { return placeKey(one.line, one.column); });
  }
  std::unordered_set<uint64_t> wanted;
  for (size_t i = 0; i < keys.size(); ++i) {
    const bool isHere = places[i].file && *places[i].file == world().path && places[i].line > 0;
    if (!isHere) keys[i] = 0;
    if (keys[i] != 0) wanted.insert(keys[i]);
  }
  const std::unordered_map<uint64_t, NodeRef> live = liveNodesAt(wanted);
  for (size_t i = 0; i < keys.size(); ++i)
    if (const auto known = live.find(keys[i]); known != live.end()) nodes[i] = known->second;
  return nodes;
}

std::vector<ChangedField> EditedFile::changedFields() const {
  std::vector<ChangedField> changed;
  if (!document_) return changed;
  std::vector<std::pair<uint64_t, ChangedField>> fields; // by the places of their nodes
  const auto add = [&](const Node& node, std::string field, std::string before, std::string now) {
    fields.emplace_back(placeKey(node.source.line, node.source.column),
                        ChangedField{node.source.line, node.type().name, node.defName,
                                     std::move(field), std::move(before), std::move(now)});
  };
  document_->forEachChanged([&](const Node& node, const auto& originals) {
    if (!document_->stands(node) || !document_->hasText(node) || !document_->isOwn(node)) return;
    for (const auto& [name, before] : originals) {
      const FieldInfo& field = *node.type().find(name);
      if (!before) continue; // nodes that the text has: they follow
      const Value now = node.get(field);
      if (now == *before) continue;
      if (holdsNodes(field)) // the text does not have the field
        add(node, name, "", countText(nodesOf(node, field).size()));
      else
        add(node, name, textOf(field.type, *before), textOf(field.type, now));
    }
    for (const FieldText& text : document_->placeOf(node).fields) {
      const FieldInfo* const field = node.type().find(text.name);
      if (!field || !holdsNodes(*field) || document_->textOf(node, *field) != &text) continue;
      const NodesOfField nodes(text.nodes, nodesOf(node, *field));
      if (nodes.differ()) add(node, text.name, nodes.textBefore(), nodes.textNow());
    }
  });
  for (const NodeText& text : document_->file().layout.nodes) {
    const Node& node = *text.node;
    if (const std::string& before = document_->nameInText(node);
        before != node.defName && document_->stands(node))
      add(node, "DEF", before, node.defName);
  }
  std::sort(fields.begin(), fields.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second.field < b.second.field;
  });
  const NodesOfField roots(document_->file().layout.roots, document_->listOf(nullptr, nullptr));
  if (roots.differ()) changed.push_back({0, "", "", "", roots.textBefore(), roots.textNow()});
  for (auto& [place, field] : fields) changed.push_back(std::move(field));
  return changed;
}

} // namespace xvrml
