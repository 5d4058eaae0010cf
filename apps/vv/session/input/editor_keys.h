// editor_keys.h: Defines what keys and mouse do in the editor of the window, in one table. The
// window asks it, and F1, vv --list-keys and docs/editor.md show it. [any thread]
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "session/input/keys.h"

namespace vv {

enum class EditorAction : uint8_t {
  none,
  handles,
  move,
  turn,
  scale,
  menu,
  duplicate,
  group,
  remove,
  rename,
  undo,
  redo,
  save,
  probe,
  sensor,
  rectangle,
  keep,
  showA,
  showWiper,
  showDifference,
  frame,
  panels,
  keyboard,
  escape
};

struct EditorKeyInfo {
  const char* what; // keys, separated by ", ", or what is done with the mouse
  const char* text;
  // The actions of the keys, in their order. Rows without actions are explained only: the mouse,
  // keys of a tool that is in use, of menus and of the window.
  std::array<EditorAction, 3> actions{};
  bool isOfWindow = false; // pages leave it to their browser
};
std::span<const EditorKeyInfo> editorTable();

// Returns the action for a key that goes down.
EditorAction editorActionOf(const InputEvent& event);

std::string listEditorKeys(); // for people, as listKeys()

} // namespace vv
