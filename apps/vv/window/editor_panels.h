// editor_panels.h: The panels of the editor in the window: the outline of the world at the left,
// the fields of the selected node at the right, and a box around what is selected. They draw an
// EditModel and ask it for edits. [main thread, within a frame of Gui]
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "edit/actions.h"
#include "edit/edit_model.h"
#include "edit/probes.h"

namespace vv {

class EditorPanels {
 public:
  // save: saves the file.
  EditorPanels(EditModel& model, Probes& probes, std::function<void()> save)
      : model_(model), probes_(probes), save_(std::move(save)) {}

  void draw();
  // Where the viewer stands, for a new Viewpoint.
  void setView(const EditView& view) { view_ = view; }

 private:
  void drawOutline();
  void drawTools();
  void drawRow(const OutlineRow& row, int number);
  void drawSheet();
  void drawFrames() const;
  void drawProbes();

  EditModel& model_;
  Probes& probes_;
  EditView view_;
  std::string search_;
  const std::function<void()> save_;
};

// Draws the widgets for a field, and asks for the edits that the user makes with them.
void drawProperty(EditModel& model, const xvrml::NodeRef& node, PropertyRow& row);

} // namespace vv
