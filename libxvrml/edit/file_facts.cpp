// file_facts.cpp: what can be asked about the file of an edited world: the nodes at places of its
// text, and the fields that edits have changed.
#include <algorithm>

#include <fmt/format.h>

#include "edit/edited_file.h"
#include "edit/nodes_at.h"
#include "graph/field_access.h"
#include "write/value_writer.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

constexpr size_t longestValue = 200; // bytes

std::string countText(size_t nodes) {
  return fmt::format("{} node{}", nodes, nodes == 1 ? "" : "s");
}

// Returns a value as text, or how many nodes it holds.
std::string textOf(const FieldInfo& field, Value value) {
  if (field.type == FieldType::SFNode) return std::get<SFNode>(value) ? "1 node" : "NULL";
  if (field.type == FieldType::MFNode) return countText(std::get<MFNode>(value).size());
  std::string text;
  writeValue(text, field.type, std::visit([](auto& v) -> void* { return &v; }, value), 0);
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() <= longestValue) return text;
  size_t end = longestValue;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end) + "...";
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
  document_->forEachChanged([&](const Node& node, const FieldInfo& field, const Value& before) {
    if (!document_->stands(node) || !document_->hasText(node) || !document_->isOwn(node)) return;
    if (const Value now = node.get(field); now != before)
      add(node, field.name, textOf(field, before), textOf(field, now));
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
  const MFNode& roots = document_->listOf(nullptr, nullptr);
  std::vector<NodePlace> read = document_->file().layout.roots;
  std::erase_if(read, [](const NodePlace& place) { return !place.taken; });
  if (!std::equal(
          roots.begin(), roots.end(), read.begin(), read.end(),
          [](const NodeRef& node, const NodePlace& place) { return node.get() == place.node; }))
    changed.push_back({0, "", "", "", countText(read.size()), countText(roots.size())});
  for (auto& [place, field] : fields) changed.push_back(std::move(field));
  return changed;
}

} // namespace xvrml
