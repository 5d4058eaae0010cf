#include "edit/journal.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vv {

using namespace xvrml;

namespace {

constexpr double interval = 2; // seconds between two writes, at least
// A text takes at most this part of the browser's thread.
constexpr double largestShare = 1. / 20;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Returns whether a file belongs to another user. Once it is saved, it is this user's.
bool isOthers(const std::string& path) {
  struct stat info;
  return ::stat(path.c_str(), &info) == 0 && info.st_uid != ::geteuid();
}

} // namespace

Journal::Journal(Editor& editor, Browser& browser)
    : editor_(editor), browser_(browser), world_(browser.world().path),
      generation_(browser.generation()) {}

Journal::~Journal() {
  finish();
  if (!editor_.isChanged()) settle();
}

void Journal::advance(double seconds) {
  using namespace std::chrono_literals;
  if (writing_.valid() && writing_.wait_for(0s) != std::future_status::timeout) finish();
  noticeOtherWorld();
  if (!editor_.isChanged()) return settle();
  const bool isKept = editor_.changes() == written_ && failure_.empty();
  if (isKept || seconds < next_ || writing_.valid()) return;
  const double begun = now();
  begin();
  next_ = seconds + std::max(interval, (now() - begun) / largestShare);
}

// Begins to write the edits.
void Journal::begin() {
  written_ = editor_.changes();
  try {
    if (isOthers(world_)) throw std::runtime_error("the file belongs to another user");
    if (!base_) {
      const std::string text = editor_.textOnDisk();
      if (!editor_.isChangedOnDisk()) base_ = stampOf(text);
    }
    if (!file_ || !file_->isInPlace()) file_ = JournalFile::make(world_);
    const auto write = [file = &*file_, base = base_.value_or(TextStamp()),
                        text = editor_.draft()]() -> std::string {
      try {
        file->write(base, text);
        return "";
      } catch (const std::exception& error) { return error.what(); }
    };
    // Without a thread, finish() does it.
    writing_ = std::async(std::launch::async | std::launch::deferred, write);
  } catch (const std::exception& error) { fail(error.what()); }
}

// Waits for the end of the write that is under way.
void Journal::finish() {
  if (!writing_.valid()) return;
  if (const std::string why = writing_.get(); !why.empty())
    fail(why);
  else
    failure_.clear();
}

// A folder that cannot be written stays so, and is spoken of once.
void Journal::fail(const std::string& why) {
  if (failure_.empty())
    message_ = fmt::format("the edits of {} are kept nowhere until you save them: {}", world_, why);
  failure_ = why;
}

void Journal::settle() {
  if (!editor_.isChanged()) throwAway();
}

void Journal::throwAway() {
  finish();
  if (file_) file_->remove();
  file_.reset();
  base_.reset();
  failure_.clear();
  written_ = editor_.changes();
}

std::string Journal::keep() {
  finish();
  settle();
  if (!editor_.isChanged()) return {};
  if (editor_.changes() != written_ || !failure_.empty()) {
    begin();
    finish();
  }
  return file_ && failure_.empty() ? file_->path() : std::string();
}

void Journal::noticeOtherWorld() {
  if (isReplaced_ || browser_.generation() == generation_) return;
  isReplaced_ = true;
  if (const std::string path = keep(); !path.empty())
    message_ = fmt::format("another world has taken the place of {}: its unsaved edits are in {}",
                           world_, path);
}

void Journal::look() {
  left_.reset();
  if (editor_.isChanged()) return;
  std::string refused;
  FoundJournal found = findJournal(
      world_, [this] { return editor_.textOnDisk(); }, refused);
  if (!found.path.empty()) left_ = std::move(found);
  message_ = refused;
  if (left_)
    message_ += fmt::format("{}{} has unsaved edits that an earlier session has left in {}: the "
                            "editor offers them",
                            refused.empty() ? "" : "; ", world_, left_->path);
}

std::shared_ptr<LeftEdits> Journal::take() {
  if (!left_) throw EditError("there are no edits that an earlier session has left");
  if (editor_.isChanged())
    throw EditError("this world has unsaved edits of its own: save or undo them first");
  try {
    JournalContent content;
    JournalFile file = JournalFile::open(left_->path, content);
    return std::make_shared<LeftEdits>(LeftEdits{std::move(content), std::move(file)});
  } catch (const std::runtime_error& error) { throw EditError(error.what()); }
}

void Journal::throwLeftAway() {
  if (!left_) throw EditError("there are no edits that an earlier session has left");
  try {
    JournalContent content;
    JournalFile::open(left_->path, content).remove();
  } catch (const std::runtime_error& error) { throw EditError(error.what()); }
  left_.reset();
}

void Journal::adopt(LeftEdits& edits) {
  editor_.adopt(edits.content.text);
  if (stampOf(editor_.textOnDisk()) != edits.content.base)
    throw EditError(fmt::format("{} has changed since these edits were made: they are in {}",
                                world_, edits.file.path()));
  base_ = edits.content.base;
  file_ = std::move(edits.file);
  written_ = editor_.changes();
}

} // namespace vv
