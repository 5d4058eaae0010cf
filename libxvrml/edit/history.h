// history.h: the steps of an editor, and undo. Internal; the thread that owns the world.
#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "xvrml/edit.h"
#include "xvrml/node.h"

namespace xvrml {

// One edit of the document and of the live world.
struct Edit {
  std::function<void()> redo, undo;
  // A value: the node and its field. A later value in the same step takes its place.
  Node* node = nullptr;
  std::string field{};
  uint64_t bytes = 0; // estimated memory of the values and nodes that it keeps
};

// Returns the memory that a value has elsewhere.
uint64_t bytesOf(const Value& value);

class History {
 public:
  // forgotten: is called when the oldest steps are forgotten the first time.
  explicit History(std::function<void()> forgotten = {}) : forgotten_(std::move(forgotten)) {}
  // Bounds the memory of all steps. When more is needed, the oldest ones are forgotten, but never
  // the last one.
  void setMostBytes(uint64_t bytes);
  uint64_t mostBytes() const { return mostBytes_; }
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
    uint64_t bytes() const;
  };
  // The edits of a node that are not undone, by fields. They count further when their steps have
  // been forgotten.
  struct FieldEdits {
    NodeRef node;
    std::map<std::string, uint64_t, std::less<>> counts;
  };
  void rollBack(size_t edits);
  void count(const std::vector<Edit>& edits, size_t first = 0);
  void countField(const Edit& edit, int by);
  void joinLast(size_t first);
  void forgetOldest();

  std::function<void()> forgotten_;
  std::deque<Step> steps_; // those that have been done first, then those that have been undone
  uint64_t bytes_ = 0, mostBytes_ = defaultUndoBytes; // memory of all steps
  size_t done_ = 0;
  // Edits, undos and redos so far, and those of them that were not about values alone.
  uint64_t changes_ = 0, nodeChanges_ = 0;
  // Value of done_ at which the file was saved; ~0: it cannot be reached again.
  size_t savedAt_ = 0;
  Step open_;
  std::unordered_map<const Node*, FieldEdits> fieldEdits_;
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
