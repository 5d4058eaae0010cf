#include "edit/world_editor.h"

#include "libpicture/files/save_edits.h"

namespace vv {

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
  ++saves_;
}

} // namespace vv
