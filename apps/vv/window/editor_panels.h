// editor_panels.h: The panels of the editor in the window: the outline of the world at the left,
// the fields of the selected node at the right, and a box around what is selected. They draw an
// EditModel and ask it for edits. [main thread, within a frame of Gui]
#pragma once

#include <functional>
#include <string>

#include "edit/actions.h"
#include "edit/edit_model.h"
#include "edit/probes.h"

namespace vv {

class EditorPanels {
 public:
  EditorPanels(EditModel& model, Probes& probes) : model_(model), probes_(probes) {}

  void draw();
  // Where the viewer stands, for a new Viewpoint.
  void setView(const EditView& view) { view_ = view; }
  // Asks whether edits are saved, thrown away or kept before the world goes. go: is called then,
  // unless the user wants to stay.
  void askToSave(std::function<void()> go);

 private:
  void drawOutline();
  void drawTools();
  void drawRow(const OutlineRow& row, int number);
  void drawSheet();
  void drawFrames() const;
  void drawProbes();
  void drawQuestion();

  EditModel& model_;
  Probes& probes_;
  EditView view_;
  std::string search_;
  std::function<void()> go_; // null: nothing is asked
};

// Draws the widgets for a field, and asks for the edits that the user makes with them.
void drawProperty(EditModel& model, const xvrml::NodeRef& node, PropertyRow& row);

} // namespace vv
