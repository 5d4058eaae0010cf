#include "window/questions.h"

#include <algorithm>
#include <utility>

namespace vv {

namespace {

// Frames until a question is in its place and gets all events.
constexpr int framesToAppear = 3;

} // namespace

void Questions::ask(Question question) {
  const auto same = std::find_if(asked_.begin(), asked_.end(),
                                 [&](const Question& one) { return one.title == question.title; });
  if (same != asked_.end()) {
    const std::function<void()> then = same->answers.back().then;
    *same = std::move(question);
    if (then) then();
  } else {
    asked_.push_back(std::move(question));
    if (asked_.size() == 1) frames_ = 0;
  }
  screen_.redraw();
}

void Questions::clear() {
  asked_.clear();
  chosen_ = nullptr;
  expected_ = 0;
  isAnswered_ = isPassed_ = false;
}

bool Questions::isAppearing() const { return !asked_.empty() && frames_ < framesToAppear; }

void Questions::wait(double seconds, const std::function<bool(const InputEvent& event)>& mayAsk,
                     const std::function<bool()>& isHeld, bool isBusy,
                     std::vector<InputEvent>& events) {
  isPassed_ = isPassed_ && isBusy;
  if (isAppearing()) screen_.redraw();
  if (isAppearing() || isPassed_ || isHeld() || (expected_ > 0 && isBusy))
    return screen_.rest(seconds);
  screen_.wait(seconds, events, [&] {
    isPassed_ = !events.empty() && mayAsk(events.back());
    return isPassed_ || isAnswered_ || isHeld();
  });
  if (!std::exchange(isAnswered_, false)) return;
  frames_ = 0; // the next one has not been drawn
  if (const std::function<void()> then = std::exchange(chosen_, nullptr)) then();
}

} // namespace vv
