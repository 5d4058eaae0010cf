#include "session/input/editor_keys.h"

#include <algorithm>
#include <string_view>

namespace vv {

namespace {

using enum EditorAction;

constexpr EditorKeyInfo table[] = {
    {"click", "selects the Shape there; Shift: adds it, or takes it out"},
    {"Ctrl click", "selects the group that the Shape is in"},
    {"Ctrl drag", "selects the Shapes that are seen in the rectangle; Shift: adds them"},
    {"middle drag", "moves the viewer as Ctrl drag does without the editor"},
    {"drag of a handle", "moves, turns or scales the selected node"},
    {"T", "handles that move, turn, scale, or none", {handles}},
    {"Alt press", "works the world's own sensors; without Alt they get no clicks"},
    {"drop of a file", "puts it into the world, as an Inline"},
    {"G, R, S", "move, turn, scale the selected node with the pointer", {move, turn, scale}},
    {"then X, Y, Z", "along or about an axis of the world; again: of the node; again: freely"},
    {"then digits, ., -", "a number instead of the pointer: lengths, degrees, a factor"},
    {"then Ctrl", "steps: a power of ten, 5 degrees, a tenth"},
    {"then click, Enter", "end it; right click, Escape: take it back"},
    {"Shift+A", "the menu of what can be added; type to find more", {menu}},
    {"Shift+D, Ctrl+G", "duplicate, group what is selected", {duplicate, group}},
    {"X, Delete", "remove what is selected", {remove, remove}},
    {"F2", "gives the selected node another name (DEF)", {rename}},
    {"Ctrl+Z, Ctrl+Y", "undo, redo", {undo, redo}},
    {"Ctrl+Shift+Z", "redo", {redo}},
    {"Ctrl+S", "saves the file in place", {save}},
    {"V, U", "a probe of luminance, or of illuminance, where the pointer is", {probe, sensor}},
    {"Shift+V", "the next drag measures a rectangle", {rectangle}},
    {"B", "keeps the picture and the light of the probes as A", {keep}},
    {"\\, W, D",
     "A in the place of the picture; beside it; what has changed since A",
     {showA, showWiper, showDifference}},
    {".", "goes to where what is selected fills the picture between the panels", {frame}},
    {"Tab", "hides the panels, or shows them again", {panels}, true},
    {"Ctrl+Tab",
     "keys work the next panel: arrows, Space, Enter; Escape ends it",
     {keyboard},
     true},
    {"Up, Down, Enter", "in a menu: choose an item; Escape: close it"},
    {"Escape", "ends a comparison, then selects nothing, then closes the panels", {escape}},
    {"E", "closes the panels"},
    {"F1, ?", "this text; with the panels closed: the keys of the window"},
};

bool matches(std::string_view key, const InputEvent& event) {
  const auto takes = [&key](std::string_view modifier) {
    if (!key.starts_with(modifier)) return false;
    key.remove_prefix(modifier.size());
    return true;
  };
  const bool control = takes("Ctrl+"), shift = takes("Shift+");
  return key == event.text && control == event.control && shift == event.shift && !event.alt;
}

} // namespace

std::span<const EditorKeyInfo> editorTable() { return table; }

EditorAction editorActionOf(const InputEvent& event) {
  constexpr std::string_view between = ", ";
  for (const EditorKeyInfo& info : table) {
    std::string_view rest = info.what;
    for (const EditorAction action : info.actions) {
      if (action == none) break;
      const size_t end = std::min(rest.find(between), rest.size());
      if (matches(rest.substr(0, end), event)) return action;
      rest.remove_prefix(std::min(end + between.size(), rest.size()));
    }
  }
  return none;
}

std::string listEditorKeys() {
  std::string out;
  for (const EditorKeyInfo& info : table) out += keyLine(info.what, info.text);
  return out;
}

} // namespace vv
