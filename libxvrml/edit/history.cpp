#include "edit/history.h"

#include <algorithm>
#include <utility>

namespace xvrml {

void History::begin(std::string name) {
  if (begun_.empty()) open_ = {name.empty() ? "Edit" : std::move(name), {}};
  begun_.push_back(open_.edits.size());
}

void History::end() {
  if (begun_.empty()) return;
  const size_t first = begun_.back();
  begun_.pop_back();
  if (!begun_.empty()) return joinLast(first);
  if (open_.edits.empty()) return;
  if (savedAt_ > done_) savedAt_ = ~size_t(0);
  steps_.resize(done_);
  steps_.push_back(std::exchange(open_, {}));
  ++done_;
}

// Lets one edit that has been done alone since `first` take the place of the one before if that set
// the same field of the same node.
void History::joinLast(size_t first) {
  std::vector<Edit>& edits = open_.edits;
  if (first <= begun_.back() || edits.size() != first + 1) return;
  Edit &before = edits[first - 1], &last = edits[first];
  if (!last.node || before.node != last.node || before.field != last.field) return;
  before.redo = std::move(last.redo);
  edits.pop_back();
}

void History::cancel() {
  if (begun_.empty()) return;
  try {
    rollBack(begun_.back());
  } catch (...) { // an outer step goes on, and can be cancelled later
    end();
    throw;
  }
  begun_.pop_back();
}

// Counts edits, from one on, that are about to be done or undone.
void History::count(const std::vector<Edit>& edits, size_t first) {
  ++changes_;
  nodeChanges_ += std::any_of(edits.begin() + std::ptrdiff_t(first), edits.end(),
                              [](const Edit& edit) { return !edit.node; });
}

void History::rollBack(size_t edits) {
  count(open_.edits, edits);
  while (open_.edits.size() > edits) {
    open_.edits.back().undo();
    open_.edits.pop_back();
  }
}

void History::perform(Edit edit) {
  edit.redo();
  open_.edits.push_back(std::move(edit));
  count(open_.edits, open_.edits.size() - 1);
}

bool History::undo() {
  if (isOpen() || done_ == 0) return false;
  std::vector<Edit>& edits = steps_[done_ - 1].edits;
  count(edits);
  size_t left = edits.size();
  try {
    for (; left > 0; --left) edits[left - 1].undo();
  } catch (...) { // the step stays done
    for (; left < edits.size(); ++left) edits[left].redo();
    throw;
  }
  --done_;
  return true;
}

bool History::redo() {
  if (isOpen() || done_ == steps_.size()) return false;
  std::vector<Edit>& edits = steps_[done_].edits;
  count(edits);
  size_t done = 0;
  try {
    for (; done < edits.size(); ++done) edits[done].redo();
  } catch (...) { // the step stays undone
    while (done > 0) edits[--done].undo();
    throw;
  }
  ++done_;
  return true;
}

uint64_t History::editsOf(const Node& node, std::string_view field) const {
  const auto count = [&](const std::vector<Edit>& edits) {
    return uint64_t(std::count_if(edits.begin(), edits.end(), [&](const Edit& edit) {
      return edit.node == &node && edit.field == field;
    }));
  };
  uint64_t all = count(open_.edits);
  for (size_t i = 0; i < done_; ++i) all += count(steps_[i].edits);
  return all;
}

std::string History::undoName() const { return done_ > 0 ? steps_[done_ - 1].name : ""; }
std::string History::redoName() const { return done_ < steps_.size() ? steps_[done_].name : ""; }

} // namespace xvrml
