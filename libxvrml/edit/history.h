// history.h: the steps of an editor, and undo. Internal; the thread that owns the world.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/node.h"

namespace xvrml {

// One edit of the document and of the live world.
struct Edit {
  std::function<void()> redo, undo;
  // A value: the node and its field. A later value in the same step takes its place.
  const Node* node = nullptr;
  std::string field{};
};

class History {
 public:
  // Edits from begin() to end() are one step; both may nest. A step without a name is an "Edit".
  // cancel() undoes what the innermost begin() has begun, and ends it. If that throws, what could
  // not be undone stays, as if end() had been called.
  void begin(std::string name);
  void end();
  void cancel();
  // Does an edit, as a part of the open step.
  void perform(Edit edit);
  // Return false if there is no step. If an edit throws, the whole step stays as it was.
  bool undo();
  bool redo();
  std::string undoName() const;
  std::string redoName() const;
  uint64_t changes() const { return changes_; }
  uint64_t nodeChanges() const { return nodeChanges_; }
  // Returns how many edits that are not undone have set a field.
  uint64_t editsOf(const Node& node, std::string_view field) const;
  // Returns whether the edits are others than when the file was saved.
  bool isChanged() const { return done_ != savedAt_ || (isOpen() && !open_.edits.empty()); }
  void saved() { savedAt_ = done_; }
  // Says that the file does not have what there is before the first step.
  void neverSaved() {
    savedAt_ = ~size_t(0);
    ++changes_;
  }
  bool isOpen() const { return !begun_.empty(); }

 private:
  struct Step {
    std::string name;
    std::vector<Edit> edits;
  };
  void rollBack(size_t edits);
  void count(const std::vector<Edit>& edits, size_t first = 0);
  void joinLast(size_t first);

  std::vector<Step> steps_; // those that have been done first, then those that have been undone
  size_t done_ = 0;
  // Edits, undos and redos so far, and those of them that were not about values alone.
  uint64_t changes_ = 0, nodeChanges_ = 0;
  // Value of done_ at which the file was saved; ~0: it cannot be reached again.
  size_t savedAt_ = 0;
  Step open_;
  std::vector<size_t> begun_; // for each begin() without end(): the number of edits before
};

// A step, or a part of one, that is undone unless it is closed. Edits that cannot be undone,
// because a Script has changed the world meanwhile, stay as a step.
class OpenStep {
 public:
  OpenStep(History& history, std::string name) : history_(history) {
    history.begin(std::move(name));
  }
  ~OpenStep() {
    if (closed_) return;
    try {
      history_.cancel();
    } catch (const std::exception&) {} // the exception that has left the step open says more
  }
  OpenStep(const OpenStep&) = delete;
  OpenStep& operator=(const OpenStep&) = delete;
  void close() {
    closed_ = true;
    history_.end();
  }

 private:
  History& history_;
  bool closed_ = false;
};

} // namespace xvrml
