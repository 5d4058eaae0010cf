// hiding.h: The nodes that a user hides for now. It sets the field `visible` of the running
// world, and not of the file: it is not saved, and is no step that can be undone. [the browser's
// thread, while the world can be used]
#pragma once

#include <cstdint>
#include <vector>

#include "edit/world_editor.h"

namespace vv {

class Hiding {
 public:
  // Hides what is selected: groups and Shapes, and the Shapes of other nodes. Throws
  // xvrml::EditError for nodes that cannot be hidden.
  void hideSelected(WorldEditor& editor);
  // Hides all Shapes and groups but those that are selected, with what is in them. Lights, views
  // and instances of prototypes stay.
  void isolateSelected(WorldEditor& editor);
  // Shows all again that has been hidden, unless an edit has set the field `visible` since.
  void showAll(WorldEditor& editor);

  size_t count() const { return hidden_.size(); }
  bool contains(const xvrml::Node& node) const;

 private:
  void hide(WorldEditor& editor, const xvrml::NodeRef& node);

  struct Hidden {
    xvrml::NodeRef node;
    uint64_t edits = 0; // Editor::editsOf() its field `visible`, when it was hidden
  };
  std::vector<Hidden> hidden_;
};

} // namespace vv
