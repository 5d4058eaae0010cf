#include "session/input/editor_keys.h"

namespace vv {

namespace {

constexpr MouseInfo table[] = {
    {"click", "selects the Shape there; Shift: adds it, or takes it out"},
    {"Ctrl click", "selects the group that the Shape is in"},
    {"Ctrl drag", "selects the Shapes that are seen in the rectangle; Shift: adds them"},
    {"middle drag", "moves the viewer as Ctrl drag does without the editor"},
    {"drag of a handle", "moves, turns or scales the selected node"},
    {"T", "handles that move, turn, scale, or none"},
    {"Alt press", "works the world's own sensors; without Alt they get no clicks"},
    {"drop of a file", "puts it into the world, as an Inline"},
    {"G, R, S", "move, turn, scale the selected node with the pointer"},
    {"then X, Y, Z", "along or about an axis of the world; again: of the node; again: freely"},
    {"then digits, ., -", "a number instead of the pointer: lengths, degrees, a factor"},
    {"then Ctrl", "steps: a power of ten, 5 degrees, a tenth"},
    {"then click, Enter", "end it; right click, Escape: take it back"},
    {"Shift+A", "the menu of what can be added; type to find more"},
    {"Shift+D, Ctrl+G", "duplicate, group what is selected"},
    {"X, Delete", "remove what is selected"},
    {"Ctrl+Z, Ctrl+Y", "undo, redo"},
    {"Ctrl+S", "saves the file in place"},
    {"V, U", "a probe of luminance, or of illuminance, where the pointer is"},
    {"Shift+V", "the next drag measures a rectangle"},
    {"B", "keeps the picture and the light of the probes as A"},
    {"\\, W, D", "A in the place of the picture; beside it; what has changed since A"},
    {".", "goes to where what is selected fills the picture between the panels"},
    {"Up, Down, Enter", "in a menu: choose an item; Escape: close it"},
    {"Escape", "ends a comparison, then selects nothing, then closes the panels"},
    {"E", "closes the panels"},
    {"F1, ?", "this text; with the panels closed: the keys of the window"},
};

} // namespace

std::span<const MouseInfo> editorTable() { return table; }

std::string listEditorKeys() {
  std::string out;
  for (const MouseInfo& info : table) out += keyLine(info.what, info.text);
  return out;
}

} // namespace vv
