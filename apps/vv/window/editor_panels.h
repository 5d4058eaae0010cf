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
#include "window/panel_state.h"

namespace vv {

class EditorPanels {
 public:
  // save: saves the file.
  EditorPanels(EditModel& model, Probes& probes, std::function<void()> save)
      : model_(model), probes_(probes), save_(std::move(save)) {}

  void draw();
  // Where the viewer stands, for a new Viewpoint.
  void setView(const EditView& view) { view_ = view; }
  // The part of the picture between the panels, as they were drawn last.
  const FreePart& freePart() const { return free_; }
  // Tells, once, whether the user has asked for a report.
  bool takeReportWish() { return std::exchange(wantsReport_, false); }

 private:
  void drawOutline();
  void drawTools();
  void drawReports();
  void drawRow(const OutlineRow& row, int number);
  void drawViewItems();
  void drawRowMenu();
  void watchWidth(float& drawn, float& chosen);
  void drawSheet();
  void drawFrames() const;
  void drawProbes();

  PanelWidths widths_ = readPanelWidths(panelStateFile()); // what the user has chosen
  float outlineWidth_ = 0, sheetWidth_ = 0;                // as the panels were drawn last
  bool isResized_ = false;                                 // the user drags the edge of a panel
  FreePart free_;
  OutlineRow menuRow_; // the row that the menu is about
  bool opensMenu_ = false;

  EditModel& model_;
  Probes& probes_;
  EditView view_;
  std::string search_;
  const std::function<void()> save_;
  bool wantsReport_ = false;
};

// Draws the list of the messages about the world, if it is open.
void drawProblems(EditModel& model, const FreePart& free);

} // namespace vv
