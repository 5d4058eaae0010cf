// editor_panels.h: The panels of the editor in the window: the outline of the world at the left,
// the fields of the selected node at the right, and a box around what is selected. They draw an
// EditModel and ask it for edits. [main thread, within a frame of Gui]
#pragma once

#include <functional>
#include <string>

#include "edit/actions.h"
#include "edit/edit_model.h"
#include "edit/probes.h"
#include "window/panel_state.h"

namespace vv {

class EditorPanels {
 public:
  EditorPanels(EditModel& model, Probes& probes) : model_(model), probes_(probes) {}

  void draw();
  // Where the viewer stands, for a new Viewpoint.
  void setView(const EditView& view) { view_ = view; }
  // Asks whether edits are saved or thrown away before the world goes. go: is called then. stay: is
  // called if the user wants to stay; may be null.
  void askToSave(std::function<void()> go, std::function<void()> stay);
  // Saves the file, or asks first if somebody else has changed it.
  void save();

 private:
  void drawOutline();
  void drawTools();
  void drawRow(const OutlineRow& row, int number);
  void drawViewItems();
  void drawRowMenu();
  void watchWidth(float& drawn, float& chosen);
  void drawSheet();
  void drawFrames() const;
  void drawProbes();
  void drawQuestion();
  void drawOverwriteQuestion();

  PanelWidths widths_ = readPanelWidths(panelStateFile()); // what the user has chosen
  float outlineWidth_ = 0, sheetWidth_ = 0;                // as the panels were drawn last
  bool isResized_ = false;                                 // the user drags the edge of a panel
  OutlineRow menuRow_;                                     // the row that the menu is about
  bool opensMenu_ = false;

  EditModel& model_;
  Probes& probes_;
  EditView view_;
  std::string search_;
  std::function<void()> go_, stay_; // go_ null: nothing is asked
  bool asksToOverwrite_ = false;
};

} // namespace vv
