// problems.h: The messages about a world as rows of a list, with the nodes that they are about. A
// face draws the rows. Rows are made only while the list is open. [the browser's thread]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "edit/world_editor.h"
#include "xvrml/diagnostics.h"

namespace vv {

struct ProblemRow {
  xvrml::Severity severity = xvrml::Severity::error;
  std::string place; // "line 3"; in another file than the world's "part.wrl, line 3"; may be empty
  std::string message;
  std::string sourceLine; // the line of the file; empty: unknown
  xvrml::NodeRef node;    // null: unknown, or not in the world's own file
  std::string label;      // the node as the outline calls it
  uint64_t times = 1;     // how often the message has come
};

// Returns what a row says in a line: "error  line 3  Box: ... (2 times)".
std::string problemText(const ProblemRow& row);

class ProblemList {
 public:
  // The number of errors and warnings, also of those that are not kept.
  uint64_t count() const { return count_; }
  // Errors, then warnings, then notes, each in the order in which they came. Equal messages of one
  // place are one row.
  const std::vector<ProblemRow>& rows() const { return rows_; }
  // How many messages are in no row, because there are too many.
  uint64_t dropped() const { return dropped_; }
  bool isOpen() const { return isOpen_; }
  void setOpen(bool open) { isOpen_ = open; }
  // The row that is shown in full; null: none.
  const ProblemRow* shown() const { return shown_ < rows_.size() ? &rows_[shown_] : nullptr; }
  // Shows a row in full.
  void show(size_t row) { shown_ = row; }
  // Reads new messages, a few times a second at most. seconds: time of any clock. Returns whether
  // something else is shown now. [while the world can be used]
  bool update(WorldEditor& editor, double seconds);

 private:
  void read(WorldEditor& editor);

  std::vector<ProblemRow> rows_;
  size_t shown_ = ~size_t(0);
  uint64_t count_ = 0, dropped_ = 0;
  size_t read_ = 0;            // messages that the rows are of
  const void* list_ = nullptr; // the list that they are in
  double readAt_ = 0;
  bool isOpen_ = false, hasRead_ = false;
};

} // namespace vv
