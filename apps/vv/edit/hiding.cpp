#include "edit/hiding.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "edit/outline.h"
#include "xvrml/walk.h"

namespace vv {

using namespace xvrml;

namespace {

bool canHide(const Node& node) {
  const FieldInfo* const field = node.type().find("visible");
  return field && field->type == FieldType::SFBool && field->access == Access::exposedField;
}

// Returns the node that is hidden for a selected one: the node itself, or the Shape that a material
// or a geometry belongs to.
NodeRef toHide(WorldEditor& editor, const NodeRef& node) {
  if (canHide(*node)) return node;
  if (!node->type().is("child")) {
    const std::vector<Node*> path = pathTo(editor.browser(), *node);
    const auto found = std::find_if(path.rbegin(), path.rend(),
                                    [](const Node* one) { return one->type().is("child"); });
    if (found != path.rend() && canHide(**found)) return NodeRef(*found);
  }
  throw EditError(fmt::format("{} cannot be hidden: it has no field visible", labelOf(*node)));
}

} // namespace

bool Hiding::contains(const Node& node) const {
  return std::any_of(hidden_.begin(), hidden_.end(),
                     [&](const Hidden& one) { return one.node.get() == &node; });
}

void Hiding::hide(WorldEditor& editor, const NodeRef& node) {
  if (!std::get<bool>(editor.browser().get(*node, "visible"))) return;
  if (editor.browser().set(*node, "visible", false))
    hidden_.push_back({node, editor.editor().editsOf(*node, "visible")});
}

void Hiding::hideSelected(WorldEditor& editor) {
  if (editor.selection().empty()) throw EditError("nothing is selected");
  MFNode nodes;
  for (const NodeRef& node : editor.selection()) nodes.push_back(toHide(editor, node));
  for (const NodeRef& node : nodes) hide(editor, node);
}

void Hiding::isolateSelected(WorldEditor& editor) {
  if (editor.selection().empty()) throw EditError("nothing is selected");
  MFNode nodes;
  for (const NodeRef& node : editor.selection()) nodes.push_back(toHide(editor, node));
  showAll(editor);
  const World& world = editor.browser().world();
  std::vector<Node*> shown;
  SeenNodes kept, above;
  for (const NodeRef& node : nodes) {
    shown.push_back(node.get());
    for (Node* one : pathTo(editor.browser(), *node)) above.insert(one);
  }
  walk(shown, kept, [](Node& node, std::vector<Node*>& open) { appendChildren(node, open); });
  MFNode others; // hiding may change the world, so it comes last
  walk(rootsOf(world.scope), [&](Node& node, std::vector<Node*>& open) {
    if (kept.contains(&node)) return;
    if (canHide(node) && !above.contains(&node))
      others.push_back(NodeRef(&node));
    else
      appendChildren(node, open);
  });
  for (const NodeRef& node : others) hide(editor, node);
}

void Hiding::showAll(WorldEditor& editor) {
  for (const auto& [node, edits] : std::exchange(hidden_, {}))
    if (editor.editor().editsOf(*node, "visible") == edits)
      editor.browser().set(*node, "visible", true);
}

} // namespace vv
