#include "edit/history.h"

#include <algorithm>
#include <utility>

namespace xvrml {

void History::begin(std::string name) {
  if (begun_.empty()) open_ = {std::move(name), {}};
  begun_.push_back(open_.edits.size());
}

void History::end() {
  if (begun_.empty()) return;
  begun_.pop_back();
  if (!begun_.empty() || open_.edits.empty()) return;
  if (savedAt_ > done_) savedAt_ = ~size_t(0);
  steps_.resize(done_);
  steps_.push_back(std::exchange(open_, {}));
  ++done_;
}

void History::cancel() {
  if (begun_.empty()) return;
  rollBack(begun_.back());
  begun_.pop_back();
}

void History::rollBack(size_t edits) {
  while (open_.edits.size() > edits) {
    open_.edits.back().undo();
    open_.edits.pop_back();
  }
}

void History::perform(Edit edit) {
  edit.redo();
  const auto earlier = std::find_if(
      open_.edits.begin() + std::ptrdiff_t(begun_.back()), open_.edits.end(), [&](const Edit& one) {
        return edit.node && one.node == edit.node && one.field == edit.field;
      });
  if (earlier != open_.edits.end())
    earlier->redo = std::move(edit.redo);
  else
    open_.edits.push_back(std::move(edit));
}

bool History::undo() {
  if (isOpen() || done_ == 0) return false;
  Step& step = steps_[--done_];
  for (size_t i = step.edits.size(); i-- > 0;) step.edits[i].undo();
  return true;
}

bool History::redo() {
  if (isOpen() || done_ == steps_.size()) return false;
  for (Edit& edit : steps_[done_++].edits) edit.redo();
  return true;
}

std::string History::undoName() const { return done_ > 0 ? steps_[done_ - 1].name : ""; }
std::string History::redoName() const { return done_ < steps_.size() ? steps_[done_].name : ""; }

} // namespace xvrml
