#include "edit/unchanged.h"

#include <algorithm>
#include <functional>
#include <unordered_set>

#include "xvrml/walk.h"

namespace xvrml {
namespace {

constexpr size_t none = ~size_t(0);

// The nodes of a document that stand in other places than in their texts.
class Moves {
 public:
  explicit Moves(const Document& document) : document_(document) {
    walk(nodesOf(document.putIn()), reached_,
         [](const Node& node, std::vector<const Node*>& open) { appendChildren(node, open); });
    walk(nodesOf(document.takenOut()), displaced_,
         [&](const Node& node, std::vector<const Node*>& open) { appendDefined(node, open); });
  }
  // Tells whether the text of a node may not stay as it is: the node, or what it is within, has
  // been taken out, or what has been put in somewhere holds it and may come before it.
  bool affectText(const Node& node) const {
    return reached_.contains(&node) || displaced_.contains(&node);
  }
  // Tells whether a reference may have to become the node itself, because that has gone.
  bool affectUse(const Node& node) const { return displaced_.contains(&node); }

 private:
  static std::vector<const Node*> nodesOf(const std::unordered_set<const Node*>& nodes) {
    return {nodes.begin(), nodes.end()};
  }
  // Appends the nodes that the text of a node holds.
  void appendDefined(const Node& node, std::vector<const Node*>& open) const {
    if (!document_.hasText(node)) return;
    for (const FieldText& field : document_.placeOf(node).fields)
      for (const NodePlace& place : field.nodes)
        if (!place.isUse) open.push_back(place.node);
  }

  const Document& document_;
  SeenNodes reached_, displaced_;
};

// Returns whether a node itself may have to be written otherwise.
bool isChanged(const Document& document, const Moves& moves, const NodeText& text) {
  if (document.hasChanged(*text.node) || moves.affectText(*text.node)) return true;
  const auto isOtherUse = [&](const NodePlace& place) {
    return place.isUse && place.node &&
           (document.isRenamed(*place.node) || moves.affectUse(*place.node));
  };
  return std::any_of(text.fields.begin(), text.fields.end(), [&](const FieldText& field) {
    return std::any_of(field.nodes.begin(), field.nodes.end(), isOtherUse);
  });
}

} // namespace

Unchanged::Unchanged(const Document& document) : document_(document) {
  const std::vector<NodeText>& nodes = document.file().layout.nodes;
  const Moves moves(document);
  first_.reserve(nodes.size());
  std::vector<size_t> outer; // nodes that are within none so far
  for (const NodeText& text : nodes) {
    const auto isWithin = [&](const NodeText& one) {
      return one.whole.begin >= text.whole.begin && one.whole.end <= text.whole.end;
    };
    size_t first = isChanged(document, moves, text) ? none : first_.size();
    for (; !outer.empty() && isWithin(nodes[outer.back()]); outer.pop_back())
      first = first == none ? none : first_[outer.back()];
    outer.push_back(first_.size());
    first_.push_back(first);
  }
}

std::span<const NodeText> Unchanged::within(const Node& node) const {
  const std::vector<NodeText>& nodes = document_.file().layout.nodes;
  const NodeText* const text = &document_.placeOf(node);
  const std::less<> isBefore;
  if (isBefore(text, nodes.data()) || !isBefore(text, nodes.data() + nodes.size())) return {};
  const size_t first = first_[size_t(text - nodes.data())];
  if (first == none) return {};
  return {nodes.data() + first, text + 1};
}

} // namespace xvrml
