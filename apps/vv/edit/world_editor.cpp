#include "edit/world_editor.h"

#include <algorithm>

#include <fmt/format.h>

#include "libpicture/files/save_edits.h"

namespace vv {

using namespace xvrml;

void WorldEditor::choose(const NodeRef& node, bool add) {
  if (!add) selection_.clear();
  const auto known = std::find(selection_.begin(), selection_.end(), node);
  if (known != selection_.end())
    selection_.erase(known);
  else if (node)
    selection_.push_back(node);
}

void WorldEditor::step(const std::string& name, const std::function<void()>& edits) {
  editor_.begin(name);
  try {
    edits();
  } catch (...) {
    editor_.cancel();
    throw;
  }
  editor_.end();
}

NodeSlot WorldEditor::placeOf(const Node& node, const Accepts& accepts) {
  std::vector<NodeSlot> places = editor_.placesOf(node);
  if (accepts) std::erase_if(places, [&](const NodeSlot& place) { return !accepts(place); });
  if (places.size() == 1) return places.front();
  throw EditError(places.empty()
                      ? fmt::format("this {} does not stand {}", node.type().name,
                                    accepts ? "there" : "in the world's own file")
                      : fmt::format("this {} stands in {} places: say which one is meant",
                                    node.type().name, places.size()));
}

NodeSlot WorldEditor::endOf(Node* parent, const std::string& field) const {
  if (!parent) return {nullptr, "", browser_.world().scope.roots.size()};
  const FieldInfo* info = parent->type().find(field);
  const bool isList = info && info->type == FieldType::MFNode && holdsValue(*info);
  return {parent, field, isList ? static_cast<const MFNode*>(parent->storage(*info))->size() : 0};
}

std::string WorldEditor::undo() {
  const std::string name = editor_.undoName();
  return editor_.undo() ? name : std::string();
}

std::string WorldEditor::redo() {
  const std::string name = editor_.redoName();
  return editor_.redo() ? name : std::string();
}

void WorldEditor::save(const std::string& path, bool overwrite) {
  picture::saveEdits(editor_, browser_.world(), path, overwrite);
  journal_.settle();
  ++saves_;
}

} // namespace vv
