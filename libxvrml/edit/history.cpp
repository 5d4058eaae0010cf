#include "edit/history.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "xvrml/numbers.h"

namespace xvrml {
namespace {

// Functions that an edit consists of, with nodes and places.
constexpr uint64_t bytesOfEdit = 500;

template <class T> uint64_t bytesElsewhere(const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    return value.size();
  } else if constexpr (std::is_same_v<T, Image>) {
    return value.pixels.size();
  } else if constexpr (isList<T>) {
    uint64_t bytes = value.size() * sizeof(typename T::value_type);
    if constexpr (std::is_same_v<T, MFString> || std::is_same_v<T, MFImage>)
      for (const auto& one : value) bytes += bytesElsewhere(one);
    return bytes;
  } else {
    return 0;
  }
}

} // namespace

uint64_t bytesOf(const Value& value) {
  return std::visit([](const auto& one) { return bytesElsewhere(one); }, value);
}

uint64_t History::Step::bytes() const {
  uint64_t sum = sizeof(Step) + name.size();
  for (const Edit& edit : edits) sum += bytesOfEdit + edit.bytes;
  return sum;
}

void History::setMostBytes(uint64_t bytes) {
  mostBytes_ = bytes;
  forgetOldest();
}

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
  for (; steps_.size() > done_; steps_.pop_back()) bytes_ -= steps_.back().bytes();
  bytes_ += open_.bytes();
  steps_.push_back(std::exchange(open_, {}));
  ++done_;
  forgetOldest();
}

void History::forgetOldest() {
  if (bytes_ <= mostBytes_) return;
  const size_t before = done_;
  for (; bytes_ > mostBytes_ && done_ > 1; --done_) {
    bytes_ -= steps_.front().bytes();
    steps_.pop_front();
    if (savedAt_ != ~size_t(0)) savedAt_ = savedAt_ == 0 ? ~size_t(0) : savedAt_ - 1;
  }
  if (done_ < before && forgotten_) std::exchange(forgotten_, nullptr)();
}

// Lets one edit that has been done alone since `first` take the place of the one before if that set
// the same field of the same node.
void History::joinLast(size_t first) {
  std::vector<Edit>& edits = open_.edits;
  if (first <= begun_.back() || edits.size() != first + 1) return;
  Edit &before = edits[first - 1], &last = edits[first];
  if (!last.node || before.node != last.node || before.field != last.field) return;
  before.redo = std::move(last.redo);
  before.bytes = std::max(before.bytes, last.bytes);
  countField(last, -1);
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
    countField(open_.edits.back(), -1);
    open_.edits.pop_back();
  }
}

void History::perform(Edit edit) {
  edit.redo();
  open_.edits.push_back(std::move(edit));
  countField(open_.edits.back(), 1);
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
  for (const Edit& edit : edits) countField(edit, -1);
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
  for (const Edit& edit : edits) countField(edit, 1);
  ++done_;
  return true;
}

void History::countField(const Edit& edit, int by) {
  if (!edit.node) return;
  FieldEdits& known = fieldEdits_[edit.node];
  known.node = NodeRef(edit.node);
  known.counts[edit.field] += uint64_t(std::int64_t(by));
}

uint64_t History::editsOf(const Node& node, std::string_view field) const {
  const auto known = fieldEdits_.find(&node);
  if (known == fieldEdits_.end()) return 0;
  const auto count = known->second.counts.find(field);
  return count == known->second.counts.end() ? 0 : count->second;
}

std::string History::undoName() const { return done_ > 0 ? steps_[done_ - 1].name : ""; }
std::string History::redoName() const { return done_ < steps_.size() ? steps_[done_].name : ""; }

} // namespace xvrml
