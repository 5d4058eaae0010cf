// questions.h: Asks the user of the window, one question at a time, which must be answered before
// anything else is done. Events that arrive while a question is on its way wait for it, so that
// what is typed at once is its answer. [main thread]
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "window/screen.h"

namespace vv {

struct Question {
  struct Answer {
    const char* label;
    const char* hint;
    std::function<void()> then; // may be null
  };
  const char* title; // no other question has it
  std::string text;
  std::vector<Answer> answers; // The last one changes nothing; Escape gives it, too.
  bool hasEnter = true;        // Enter gives the first one
};

class Questions {
 public:
  explicit Questions(Screen& screen) : screen_(screen) {}

  // Asks. The widgets of the editor must be shown. If the same is asked already, that question gets
  // its last answer.
  void ask(Question question);
  // Say that a question may be asked soon, and that it has been asked or will not be.
  void expect() { ++expected_; }
  void decide() { expected_ -= expected_ > 0; }
  // Forgets all questions, because their world is gone.
  void clear();
  // Draws the question. [within a frame of Gui]
  void draw();

  // Waits as Screen::wait() does, and calls what an answer asks for. While a question is on its
  // way, events stay where they are. mayAsk: tells whether a question may follow from an event.
  // isHeld: tells whether events stay for another reason. isBusy: something that was asked for will
  // be done, without anything more from the user.
  void wait(double seconds, const std::function<bool(const InputEvent& event)>& mayAsk,
            const std::function<bool()>& isHeld, bool isBusy, std::vector<InputEvent>& events);

 private:
  bool isAppearing() const;

  Screen& screen_;
  std::deque<Question> asked_; // the first one is shown
  int frames_ = 0;             // that have drawn it
  int expected_ = 0;
  bool isPassed_ = false;        // an event from which a question may follow is being handled
  std::function<void()> chosen_; // what the last answer asks for
  bool isAnswered_ = false;      // it has not been done yet
};

} // namespace vv
