// editing_questions.cpp: The questions of the editor in the window: what becomes of edits before
// the world goes, whether a file that has changed is replaced, and whether the edits of an earlier
// session are used.
#include <ctime>
#include <utility>

#include <fmt/chrono.h>

#include "session/input/keys.h"
#include "window/editing.h"

namespace vv {

// While the editor is open, an event before this one may be an edit that is still to be done. The
// menu of what can be added gets the keys behind its own.
bool Editing::mayAsk(WorldEditor& editor, const InputEvent& event) const {
  using Kind = InputEvent::Kind;
  const Action action = event.kind == Kind::down ? actionOf(event) : Action::none;
  if (action == Action::edit) return true; // keys behind it are for the editor
  if (!isOpen_ && !isBusy() && !editor.isChanged()) return false;
  switch (event.kind) {
  case Kind::quit:
  case Kind::open: return true;
  case Kind::release: return event.alt || !isOpen_; // it may work an Anchor
  case Kind::down: {
    // The keys behind it may be typed into what this one opens.
    const EditorAction opens = editorActionOf(event);
    return action == Action::quit || action == Action::reload || opens == EditorAction::save ||
           opens == EditorAction::menu || opens == EditorAction::rename ||
           opens == EditorAction::keyboard;
  }
  default: return false;
  }
}

void Editing::ask(Question question) {
  if (hasTool_) endTool(false);
  if (!isOpen_) open(true); // the widgets draw it
  questions_.ask(std::move(question));
}

void Editing::leave(WorldEditor& editor, std::function<void()> go, std::function<void()> stay) {
  if (model_ && model_->hasRequests()) {
    questions_.expect();
    return model_->request([this, go, stay](WorldEditor& later) {
      questions_.decide();
      leave(later, go, stay);
    });
  }
  if (!editor.isChanged()) return go();
  if (!isOpen_) open(true);
  if (!model_) return go(); // there is no editor in this build
  const auto save = [this, go, stay] {
    model_->request([go, stay](WorldEditor& later) {
      try {
        later.save(); // if the file cannot be written, the world stays
      } catch (...) {
        if (stay) stay();
        throw;
      }
      go();
    });
  };
  const auto throwAway = [this, go] {
    model_->request([go](WorldEditor& later) {
      later.journal().throwAway();
      go();
    });
  };
  ask({"Unsaved edits",
       "The edits of this world have not been saved.",
       {{"Save", "Write the file (Enter)", save},
        {"Throw away", "Go without saving", throwAway},
        {"Stay", "Go on with this world (Escape)", stay}}});
}

void Editing::save() {
  questions_.expect();
  model_->request([this](WorldEditor& editor) {
    questions_.decide();
    if (!editor.editor().isChangedOnDisk() || editor.editor().isInStep()) return editor.save();
    const auto replace = [this] {
      model_->request([](WorldEditor& later) { later.save("", true); });
    };
    ask({"The file has changed",
         "Another program has changed or removed the file since it was read.",
         {{"Replace it", "Write the text with these edits over it", replace},
          {"Do not save", "Leave the file as it is (Escape)", {}}},
         false});
  });
}

void Editing::offerLeft(WorldEditor& editor) {
  const std::optional<FoundJournal>& left = editor.journal().left();
  if (std::exchange(hasOffered_, true) || !left) return;
  const auto use = [this] {
    model_->request([this](WorldEditor& later) {
      recover_({{later.browser().world().path}, "", {}, later.journal().take()});
    });
  };
  const auto throwAway = [this] {
    model_->request([](WorldEditor& later) { later.journal().throwLeftAway(); });
  };
  std::tm local{};
  localtime_r(&left->written, &local);
  ask({"Edits of an earlier session",
       fmt::format(
           "Edits of {:%Y-%m-%d %H:%M} have not been saved: the vv that kept them has ended.",
           local),
       {{"Use them", "Load the world with them; the file stays until you save (Enter)", use},
        {"Throw them away", "Remove what is kept", throwAway},
        {"Decide later", "Ask again when the file is opened (Escape)", {}}}});
}

} // namespace vv
