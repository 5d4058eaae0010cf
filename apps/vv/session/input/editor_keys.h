// editor_keys.h: Lists what keys and mouse do in the editor of the window, in one table, which F1,
// vv --list-keys and docs/editor.md show. [any thread]
#pragma once

#include <span>
#include <string>

#include "session/input/keys.h"

namespace vv {

std::span<const MouseInfo> editorTable();

std::string listEditorKeys(); // for people, as listKeys()

} // namespace vv
