// edit_model.h: Stands between the editor of a world and a face that shows it. A face may be drawn
// at any time, also while the world is read for a picture; so it draws copies, and its commands
// wait until the world can be used. [the browser's thread]
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "edit/hiding.h"
#include "edit/merged_list.h"
#include "edit/outline.h"
#include "edit/problems.h"
#include "edit/properties.h"
#include "edit/texture_thumbnails.h"
#include "edit/world_editor.h"

namespace vv {

// Where the viewer stands, and the shape of the picture. Equal views show the same places in the
// same pixels, where their sizes are equal.
struct EditView {
  xvrml::CameraSettings camera{};
  double aspect = 1;
  bool operator==(const EditView&) const = default;
};
// The part of the picture that no panel of a face covers, from its left to its right, as places of
// the pointer.
struct FreePart {
  double left = -1, right = 1;
  bool contains(double x) const { return x >= left && x <= right; }
  double middle() const { return (left + right) / 2; }
  bool operator==(const FreePart&) const = default;
};

class EditModel {
 public:
  using Command = std::function<void(WorldEditor& editor)>;
  // A line of the picture, from -1 to 1 each way, as the pointer is.
  struct Line {
    double x0, y0, x1, y1;
    bool operator==(const Line&) const = default;
  };

  // --- What is shown ---
  const std::vector<OutlineRow>& rows() const { return rows_; }
  bool isSelected(const xvrml::Node& node) const;
  // The fields of the node that was selected last. A face may change the values of its rows, which
  // are read again when the world can be used.
  PropertySheet& sheet() { return sheet_; }
  // Small pictures of the textures that the sheet shows.
  const TextureThumbnails& thumbnails() const { return thumbnails_; }
  // The looks that the selected Shapes can have. Empty until a Shape has been selected.
  const std::vector<Look>& looks() const { return looks_; }
  // How many nodes are hidden for now.
  size_t hiddenCount() const { return hiding_.count(); }
  const std::string& undoName() const { return undoName_; }
  const std::string& redoName() const { return redoName_; }
  bool hasUnsaved() const { return unsaved_; }
  // Why the file cannot be edited; "": it can, or this is not known yet.
  const std::string& readOnly() const { return readOnly_; }
  // Why the file could not be saved in place; "": it can be.
  const std::string& unwritable() const { return unwritable_; }
  // The messages about the world.
  ProblemList& problems() { return problems_; }
  // The edges of a box around each node that is selected.
  const std::vector<Line>& frames() const { return frames_; }
  // Returns the camera that looks as the viewer does and shows what is selected; the viewer's own
  // if nothing is to be seen of it. free: the part of the picture that it shall fill. [while the
  // world can be used]
  xvrml::CameraSettings cameraAround(WorldEditor& editor, const EditView& view,
                                     const FreePart& free = {}) const;
  // The number of the row to scroll to; -1: none is new. It is given out once.
  int takeScroll() { return std::exchange(scroll_, -1); }
  // Returns, once, what is to be said to the user.
  std::string takeMessage() { return std::exchange(message_, {}); }

  // --- What is asked for ---
  void request(Command command) { requests_.push_back({std::move(command), Stale::rows}); }
  // Requests an edit of a panel, which is a step of its own: it is refused while another step is
  // open, because that may still be taken back with all that is in it.
  void edit(Command command);
  bool hasRequests() const { return !requests_.empty(); }
  // Sets a field. All values until no widget is active any more are one step. It is refused if
  // another program has edited the field since it was shown. In a list those elements count that
  // differ from what was shown: others may have changed since. A parameter of a shader that is not
  // declared yet gets its last value then, unless the options of the shader have it.
  void drag(const xvrml::NodeRef& node, const xvrml::FieldInfo& field, xvrml::Value value);
  // Tells whether a widget is active: the user drags it or types. The sheet is not read then.
  void setActive(bool active);
  void setOpen(const xvrml::NodeRef& node, bool open);
  void search(std::string text); // "": shows the tree
  // Tells whether the rows are still those of an earlier search. Keys that follow are meant for the
  // rows that will be found, unless the user still types.
  bool isSearching() const { return found_ != search_ && !isActive_; }
  // Hide nodes for now, or show them again. This is no edit.
  void hideSelected();
  void isolateSelected();
  void showAll();
  // Selects a node, shows its row, and adds to the selection or replaces it.
  void select(const xvrml::NodeRef& node, bool add);

  // Does what was asked for, and reads what is shown. moves: the world changes by itself, and is
  // read a few times a second. seconds: time of any clock. Returns whether something else is shown
  // now. [while the world can be used]
  bool update(WorldEditor& editor, const EditView& view, bool moves, double seconds);

 private:
  // A field that widgets change.
  struct Dragged {
    xvrml::NodeRef node;
    std::string field;
    std::string name() const; // "Text.string"
    bool operator==(const Dragged&) const = default;
  };

  // How much of what is shown must be read again: with each one also what stands before it.
  enum class Stale : uint8_t {
    nothing,
    values, // values of fields, and the names of steps
    sheet,  // the fields of the selected node
    rows    // the outline
  };

  struct Request {
    Command command;
    Stale stale; // by this command
  };

  void requestValue(Command command) { requests_.push_back({std::move(command), Stale::values}); }
  void note(Stale stale) { stale_ = std::max(stale_, stale); }
  Stale anyChange() const;
  void begin(const Dragged& dragged);
  void setField(WorldEditor& editor, const Dragged& dragged, const ChangedList& change);
  void finishDrag();
  void reveal(WorldEditor& editor, xvrml::Node& node);
  void changeRowsOf(const xvrml::Node& node);
  void read(WorldEditor& editor);
  void readSheet(WorldEditor& editor);
  std::vector<Line> framesOf(WorldEditor& editor, const EditView& view) const;

  std::deque<Request> requests_;
  Outline outline_;
  std::vector<OutlineRow> rows_;
  PropertySheet sheet_;
  TextureThumbnails thumbnails_;
  ProblemList problems_;
  xvrml::MFNode selection_;
  std::string undoName_, redoName_, readOnly_, unwritable_, message_;
  std::string search_, found_; // what is searched for, and what the rows were found for
  std::vector<Line> frames_;
  std::vector<Look> looks_;
  Hiding hiding_;
  bool unsaved_ = false, hasAsked_ = false, isActive_ = false;
  Stale stale_ = Stale::rows;
  std::optional<Dragged> dragged_;         // what the step changes that is open
  std::optional<xvrml::Value> undeclared_; // the value of a parameter that is not declared yet
  std::vector<bool> touched_;              // elements of a list that it has changed
  std::pair<Dragged, xvrml::Value> set_;   // the last value that it has set
  bool isRefused_ = false;                 // the open step must not be
  std::pair<Dragged, uint64_t> own_;       // the last field that was dragged, and its edits then
  int scroll_ = -1;
  xvrml::NodeRef shown_; // the node whose row is to be scrolled to
  double readAt_ = 0;
  uint64_t changes_ = 0, nodeChanges_ = 0; // those of the Editor when it was read
};

} // namespace vv
