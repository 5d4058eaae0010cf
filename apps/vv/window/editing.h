// editing.h: The editor in the window: its panels and handles over the picture, its keys, clicks
// that select and drags that measure. It is open or not; edits stay when it is closed. [main
// thread]
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "edit/edit_model.h"
#include "edit/gizmo.h"
#include "edit/transform_tool.h"
#include "session/input/editor_keys.h"
#include "session/light_reader.h"
#include "session/session.h"
#include "session/world_loader.h"
#include "session/world_report.h"
#include "window/editor_panels.h"
#include "window/questions.h"
#include "window/screen.h"

namespace vv {

// The bottom of the window shows such a message. lasts: until it says something else, instead of
// some seconds; an empty text ends what has been said.
struct EditingMessage {
  std::string text;
  bool lasts = false;
};

class Editing {
 public:
  // arguments: those of the command line, for the command in reports. recover: loads the world with
  // the edits of an earlier session. The references must live as long.
  Editing(Screen& screen, Questions& questions, const std::vector<std::string>& arguments,
          std::function<void(LoadRequest)> recover)
      : screen_(screen), questions_(questions), arguments_(arguments),
        recover_(std::move(recover)) {}

  bool isOpen() const { return isOpen_; }
  // Opens or closes the editor. Says why it cannot be opened by takeMessage().
  void open(bool open);
  // Takes an event that no panel wanted. Returns whether it was for the editor; otherwise the
  // session gets it, perhaps changed.
  bool take(InputEvent& event);
  // Does what the user has asked for. [while the world can be used]
  void update(Session& session, double seconds);
  // Calls go, which ends the world, once all that was asked for is done: at once, or when the user
  // has decided what becomes of edits that are not saved, and does not want to stay.
  // stay: is called otherwise; may be null.
  void leave(WorldEditor& editor, std::function<void()> go, std::function<void()> stay = {});
  // Tells whether something has been asked for that has not been done yet.
  bool isBusy() const { return (model_ && model_->hasRequests()) || (isOpen_ && !hasOffered_); }
  // Tells whether the user waits for rows of the outline (EditModel).
  bool isSearching() const { return isOpen_ && model_ && model_->isSearching(); }
  // Tells whether a question may follow from an event, before those behind it are taken.
  bool mayAsk(WorldEditor& editor, const InputEvent& event) const;
  // Forgets the world, because another takes its place.
  void reset();
  // Returns, once, what is to be said to the user.
  std::optional<EditingMessage> takeMessage();

 private:
  // A drag of the left button that is not the session's: of the line of the wiper, of a rectangle
  // that measures or selects, or of a handle, at first without a tool.
  enum class Drag : uint8_t { none, wiper, measure, select, handle, tool };

  void draw();
  void say(std::string text) { message_ = {std::move(text), false}; }
  // Shows a text until it is ended by an empty one.
  void show(std::string text) { message_ = {std::move(text), true}; }
  void ask(Question question);
  // Saves the file, or asks first if somebody else has changed it.
  void save();
  // Asks once whether the edits that an earlier session has left are used.
  void offerLeft(WorldEditor& editor);
  bool press(const InputEvent& event);
  void openAtOnce();
  void measure(EditorAction action);
  void toggle(Comparison::Shown shown);
  void escape();
  void click(const InputEvent& event);
  Drag dragAt(const InputEvent& press) const;
  void follow(const InputEvent& move);
  bool endDrag(const InputEvent& release);
  // Tells whether the pointer has moved so far since the press that it is no click.
  bool isDragged(const InputEvent& event) const;
  // The tool begins, is used and ends when the world can be used. axis: -1: none. at: where the
  // pointer is.
  bool beginTool(TransformTool::Kind kind, int axis, const InputEvent& at);
  void useTool(std::function<void(TransformTool& tool, WorldEditor& editor)> use);
  void endTool(bool accept);
  void drawBalls(Session& session);
  bool takeForTool(const InputEvent& event);
  void followPointer(Session& session, double seconds);
  void showCover();
  void followReport(Session& session);

  Screen& screen_;
  Questions& questions_;
  const std::vector<std::string>& arguments_;
  const std::function<void(LoadRequest)> recover_;
  WorldReport report_;
  LookLibrary library_;
  bool isOpen_ = false;
  bool hasOffered_ = false;        // what an earlier session has left, if there is anything
  std::optional<EditModel> model_; // one for each world
  LightReader light_;
  Probes& probes_ = light_.probes();
  Comparison& comparison_ = light_.comparison();
  Gizmo gizmo_;
  uint64_t cover_ = 0; // the number of the comparison's cover that the screen shows
  std::optional<EditorPanels> panels_;
  EditView view_;
  std::optional<InputEvent> pressed_; // the left button is held down since then
  Drag drag_ = Drag::none;
  bool measures_ = false;      // the next drag measures
  InputEvent pointer_;         // where the pointer was last
  bool isOverPicture_ = false; // the pointer is there
  bool hasMoved_ = false;      // it has moved, or has done something, since the last update
  double restsSince_ = 0;      // seconds, as those of update()
  bool isReadable_ = false;    // the picture has error bars
  bool hasTool_ = false;       // the tool gets the events; it may still have to begin
  bool isToolClick_ = false;   // a button has been pressed for the tool
  bool hasToolFailed_ = false; // it could not begin
  std::optional<TransformTool> tool_;
  bool hasLight_ = true;    // pictures have light that can be measured
  bool wantsFrame_ = false; // the viewer is to see what is selected
  bool givesUpReport_ = false;
  std::string progress_; // what is shown of the report
  std::optional<EditingMessage> message_;
};

} // namespace vv
