// editor_panels.h: The panels of the editor in the window: the outline of the world at the left,
// the fields of the selected node at the right, and a box around what is selected. They draw an
// EditModel and ask it for edits. [main thread, within a frame of Gui]
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "edit/actions.h"
#include "edit/edit_model.h"
#include "edit/look_library.h"
#include "edit/probes.h"
#include "window/menu.h"
#include "window/panel_state.h"
#include "window/thumbnails.h"

namespace vv {

class EditorPanels {
 public:
  // save: saves the file.
  EditorPanels(EditModel& model, Probes& probes, LookLibrary& library, std::function<void()> save)
      : model_(model), probes_(probes), library_(library), save_(std::move(save)) {}

  void draw();
  // Where the viewer stands, for a new Viewpoint.
  void setView(const EditView& view) { view_ = view; }
  // The part of the picture between the panels, as they were drawn last.
  const FreePart& freePart() const { return free_; }
  // Tells whether the pointer is over a panel, a menu or a question.
  bool hasPointer() const { return hasPointer_; }
  // Tells, once, whether the user has asked for a report.
  bool takeReportWish() { return std::exchange(wantsReport_, false); }
  // Hides the outline and the fields, or shows them again.
  void toggle() { isHidden_ = !isHidden_; }
  // Lets keys work the outline, then the fields, then the picture again.
  void passKeyboard();
  // Asks for another name of the node that was selected last.
  void askForName() {
    asksForName_ = true;
    isHidden_ = false;
  }
  // Opens the menu of what can be added.
  void openAddMenu() {
    opensAdd_ = true;
    isHidden_ = false;
  }
  // Tells whether the user is choosing a look.
  bool isChoosingLook() const { return isChoosingLook_; }

 private:
  enum class Keyboard : uint8_t { picture, outline, sheet };

  bool takesKeyboard(Keyboard panel);
  void drawOutline();
  void drawTools();
  void drawReports();
  void drawAddMenu();
  void drawFileQuestion();
  void drawRow(const OutlineRow& row, int number);
  void drawViewItems(Menu& menu);
  void drawRowMenu();
  void watchWidth(float& drawn, float& chosen);
  void drawSheet();
  void drawTitle();
  void drawFrames() const;
  void drawProbes();
  void drawProbeMenu(const Probe& probe);
  void drawProbeName(const Probe& probe);

  PanelWidths widths_ = readPanelWidths(panelStateFile()); // what the user has chosen
  float outlineWidth_ = 0, sheetWidth_ = 0;                // as the panels were drawn last
  bool isResized_ = false;                                 // the user drags the edge of a panel
  FreePart free_;
  OutlineRow menuRow_; // the row that the menu is about
  bool opensMenu_ = false, hasPointer_ = false, isHidden_ = false;
  Keyboard keyboard_ = Keyboard::picture; // what keys work
  bool passesKeyboard_ = false;           // it does not have the keyboard yet

  EditModel& model_;
  Probes& probes_;
  LookLibrary& library_;
  Thumbnails thumbnails_;
  EditView view_;
  std::string search_, path_, name_; // what the user types: path_: of a file to be imported
  const std::function<void()> save_;
  bool wantsReport_ = false, isChoosingLook_ = false;
  bool opensAdd_ = false, opensFile_ = false, asksForName_ = false; // are to be opened
};

// Draws the list of the messages about the world, if it is open.
void drawProblems(EditModel& model, const FreePart& free);

} // namespace vv
