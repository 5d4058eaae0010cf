#include "edit/outline.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <unordered_map>

#include "printable.h"
#include "xvrml/walk.h"

namespace vv {

using namespace xvrml;

namespace {

// Calls visit(slot, child) for each node that a node's fields hold. Metadata has no effect and is
// left out.
template <class Visit> void forEachChild(Node& parent, const Visit& visit) {
  for (const FieldInfo& field : parent.type().fields) {
    if (!holdsValue(field) || field.isMetadata) continue;
    if (field.type == FieldType::SFNode) {
      const NodeRef& child = *static_cast<const SFNode*>(parent.storage(field));
      if (child) visit(NodeSlot{&parent, field.name, 0}, child);
    } else if (field.type == FieldType::MFNode) {
      const MFNode& list = *static_cast<const MFNode*>(parent.storage(field));
      for (size_t i = 0; i < list.size(); ++i)
        if (list[i]) visit(NodeSlot{&parent, field.name, i}, list[i]);
    }
  }
}

bool hasChildren(const Node& node) {
  return std::any_of(
      node.type().fields.begin(), node.type().fields.end(), [&node](const FieldInfo& field) {
        if (!holdsValue(field) || field.isMetadata) return false;
        if (field.type == FieldType::SFNode)
          return static_cast<const SFNode*>(node.storage(field))->get() != nullptr;
        if (field.type != FieldType::MFNode) return false;
        const MFNode& list = *static_cast<const MFNode*>(node.storage(field));
        return std::any_of(list.begin(), list.end(), [](const NodeRef& one) { return bool(one); });
      });
}

bool contains(std::string_view text, std::string_view part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

// Looks for a text in nodes. Each type is looked at once: a million nodes have a few types.
class Search {
 public:
  explicit Search(std::string_view text) : text_(text) {}
  bool matches(const Node& node) {
    const NodeType& type = node.type();
    const auto [known, isNew] = types_.try_emplace(&type, false);
    if (isNew) known->second = matchesType(type);
    return known->second || contains(node.defName, text_);
  }

 private:
  bool matchesType(const NodeType& type) const {
    return contains(type.name, text_) ||
           std::any_of(type.fields.begin(), type.fields.end(), [this](const FieldInfo& field) {
             return holdsValue(field) && contains(field.name, text_);
           });
  }
  const std::string_view text_;
  std::unordered_map<const NodeType*, bool> types_;
};

// A place that is still to be visited.
struct Open {
  NodeSlot slot;
  NodeRef node;
  int depth;
};

PlacedNode placed(const Open& open) {
  return {open.node, NodeRef(open.slot.parent), open.slot.field, open.slot.index};
}

// Calls visit(place) for each root, until it returns false.
template <class Visit> void forEachRoot(const World& world, const Visit& visit) {
  const std::vector<NodeRef>& roots = world.scope.roots;
  for (size_t i = 0; i < roots.size(); ++i)
    if (roots[i] && !visit(Open{{nullptr, "", i}, roots[i], 0})) return;
}

// Appends the children of a node, so that the first one is visited next.
void appendChildPlaces(std::vector<Open>& open, const Open& parent) {
  const auto first = std::ptrdiff_t(open.size());
  forEachChild(*parent.node, [&](const NodeSlot& slot, const NodeRef& child) {
    open.push_back({slot, child, parent.depth + 1});
  });
  std::reverse(open.begin() + first, open.end());
}

// Returns the row of a place, which is closed.
OutlineRow closedRow(const Open& place) {
  return {place.node, place.depth, hasChildren(*place.node), false, false, placed(place)};
}

// Appends the rows of places, the last one first, and of what is open in them, and empties the
// places. seen: receives their nodes.
void addRowsOf(std::vector<Open>& open, const OpenNodes& opened, SeenNodes& seen,
               std::vector<OutlineRow>& rows) {
  while (!open.empty()) {
    const Open place = std::move(open.back());
    open.pop_back();
    OutlineRow row = closedRow(place);
    row.isUse = !seen.insert(place.node.get());
    row.isOpen = row.canOpen && !row.isUse && opened.contains(place.node.get());
    if (row.isOpen) appendChildPlaces(open, place);
    rows.push_back(std::move(row));
  }
}

} // namespace

std::string labelOf(const Node& node) {
  // Names may be long, and hold anything.
  constexpr size_t longest = 64;
  std::string name = node.defName.substr(0, longest);
  if (name.size() < node.defName.size()) name += "...";
  return name.empty() ? node.type().name : printable(name) + "  " + node.type().name;
}

std::string OutlineRow::label() const {
  const bool isInField = depth > 0 && !place.field.empty() && place.field != "children";
  return (isInField ? place.field + ": " : "") + labelOf(*node);
}

std::vector<OutlineRow> Outline::rows(const World& world) const {
  SeenNodes seen;
  std::vector<OutlineRow> rows;
  rows.reserve(world.scope.roots.size());
  std::vector<Open> places;
  forEachRoot(world, [&](const Open& root) {
    places.push_back(root);
    addRowsOf(places, open_, seen, rows);
    return true;
  });
  return rows;
}

void Outline::setOpen(const NodeRef& node, bool open) {
  if (open)
    open_.emplace(node.get(), node);
  else
    open_.erase(node.get());
}

std::optional<MFNode> Outline::reveal(Browser& browser, Node& node) {
  const std::vector<Node*> path = pathTo(browser, node);
  if (path.empty()) return {};
  MFNode opened;
  for (Node* one : path)
    if (one != &node && !open_.contains(one)) {
      setOpen(NodeRef(one), true);
      opened.emplace_back(one);
    }
  return opened;
}

bool Outline::changeRowsOf(const Node& node, std::vector<OutlineRow>& rows) const {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const OutlineRow& one) {
    return one.node.get() == &node && !one.isUse;
  });
  if (row == rows.end()) return false;
  row->canOpen = hasChildren(node);
  const bool opens = row->canOpen && open_.contains(&node);
  if (row->isOpen == opens) return true;
  // The rows in it begin here.
  const auto first = row + 1;
  SeenNodes seen;
  const auto standsIn = [&seen](const OutlineRow& one) { return seen.contains(one.node.get()); };
  if (!opens) {
    const auto last = std::find_if(
        first, rows.end(), [&row](const OutlineRow& one) { return one.depth <= row->depth; });
    for (auto at = first; at != last; ++at) seen.insert(at->node.get());
    // Another place of such a node would become its first one.
    if (std::any_of(last, rows.end(),
                    [&](const OutlineRow& one) { return one.isUse && standsIn(one); }))
      return false;
    row->isOpen = false;
    rows.erase(first, last);
    return true;
  }
  std::vector<Open> places;
  appendChildPlaces(places, {{}, row->node, row->depth});
  std::vector<OutlineRow> added;
  addRowsOf(places, open_, seen, added);
  if (std::any_of(rows.begin(), rows.end(), standsIn)) return false;
  row->isOpen = true;
  rows.insert(first, std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
  return true;
}

std::vector<OutlineRow> Outline::find(const World& world, std::string_view text, size_t most) {
  std::vector<OutlineRow> found;
  SeenNodes seen;
  Search search(text);
  std::vector<Open> open;
  forEachRoot(world, [&](const Open& root) {
    open.push_back(root);
    while (!open.empty() && found.size() < most) {
      const Open place = std::move(open.back());
      open.pop_back();
      if (!seen.insert(place.node.get())) continue;
      if (search.matches(*place.node))
        found.push_back({place.node, 0, false, false, false, placed(place)});
      appendChildPlaces(open, place);
    }
    return found.size() < most;
  });
  return found;
}

// Returns whether a node is in a field of another.
static bool holds(const Node& parent, const Node& searched) {
  const auto is = [&searched](const NodeRef& one) { return one.get() == &searched; };
  return std::any_of(parent.type().fields.begin(), parent.type().fields.end(),
                     [&](const FieldInfo& field) {
                       if (!holdsValue(field)) return false;
                       if (field.type == FieldType::SFNode)
                         return is(*static_cast<const SFNode*>(parent.storage(field)));
                       if (field.type != FieldType::MFNode) return false;
                       const MFNode& list = *static_cast<const MFNode*>(parent.storage(field));
                       return std::any_of(list.begin(), list.end(), is);
                     });
}

MFNode nodesOfFile(const World& world, const std::vector<PickHit::Step>& path) {
  MFNode nodes;
  const MFNode& roots = world.scope.roots;
  for (const PickHit::Step& step : path) {
    const bool stands =
        nodes.empty() ? std::find(roots.begin(), roots.end(), step.node) != roots.end()
                      : std::any_of(nodes.rbegin(), nodes.rend(),
                                    [&](const NodeRef& one) { return holds(*one, *step.node); });
    if (stands) nodes.push_back(step.node);
  }
  return nodes;
}

// Finds a node by a walk over the file.
static std::vector<Node*> searchFor(const World& world, const Node& node) {
  std::unordered_map<const Node*, Node*> parents;
  std::vector<Open> open;
  forEachRoot(world, [&](const Open& root) {
    open.push_back(root);
    while (!open.empty() && !parents.contains(&node)) {
      const Open place = std::move(open.back());
      open.pop_back();
      if (parents.emplace(place.node.get(), place.slot.parent).second)
        appendChildPlaces(open, place);
    }
    return !parents.contains(&node);
  });
  std::vector<Node*> path;
  if (!parents.contains(&node)) return path;
  for (Node* at = const_cast<Node*>(&node); at; at = parents[at]) path.push_back(at);
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<Node*> pathTo(Browser& browser, Node& node) {
  if (NodePlacement placement; browser.locate(node, placement)) {
    const MFNode nodes = nodesOfFile(browser.world(), placement.path);
    if (!nodes.empty() && nodes.back().get() == &node) {
      std::vector<Node*> path;
      for (const NodeRef& one : nodes) path.push_back(one.get());
      return path;
    }
  }
  return searchFor(browser.world(), node);
}

} // namespace vv
