// page_tool.h: The handles over the picture of one page, and the tool that moves, turns or scales
// the selected node with its pointer. Owned by the editor of a page. [main thread, while the world
// can be used]
#pragma once

#include <memory>
#include <string>

#include "edit/gizmo.h"
#include "edit/transform_tool.h"
#include "server/edit_command.h"

namespace vv::server {

class PageTool {
 public:
  // Does a command of the page. No other step may be open when a tool begins. A tool that has been
  // ended by somebody else gets the rest of its commands, too, which do nothing then. Throws
  // xvrml::EditError.
  void take(const edit::ToolCommand& command, WorldEditor& editor, const EditView& view);
  // Ends the tool, if one is in use. Its changes stay, and are one step.
  void accept(WorldEditor& editor);
  // Places the handles in the picture. There are none in a file that cannot be edited.
  void place(WorldEditor& editor, const EditView& view, bool isEditable);

  const Gizmo& gizmo() const { return gizmo_; }
  // Returns what the tool does, for the user; "": none is in use.
  std::string text() const { return tool_ ? tool_->text() : ""; }

 private:
  void perform(const edit::BeginTool& begin, WorldEditor& editor, const EditView& view);
  void perform(const edit::PointTool& point, WorldEditor& editor, const EditView& view);
  void perform(const edit::TypeTool& type, WorldEditor& editor, const EditView& view);
  void perform(const edit::EndTool& end, WorldEditor& editor, const EditView& view);
  void perform(const edit::NextHandles& next, WorldEditor& editor, const EditView& view);

  Gizmo gizmo_;
  std::unique_ptr<TransformTool> tool_;
  edit::Place pointer_;
};

} // namespace vv::server
