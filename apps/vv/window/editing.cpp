#include "window/editing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "edit/import.h"
#include "window/comparison_view.h"
#include "window/gizmo_view.h"
#include "window/readout_view.h"
#include "window/window.h"

namespace vv {

using namespace xvrml;

namespace {

// How far the pointer may move between press and release of a click, as a part of the picture.
constexpr double clickDistance = 0.012;
// How far the pointer may be from the line of the wiper, in halves of the picture's width.
constexpr double wiperReach = 0.02;
void needPicture(bool isOverPicture) {
  if (!isOverPicture) throw EditError("put the pointer where the light is to be measured");
}
constexpr uint64_t face = 0; // the number of this face for the light
constexpr const char* kindNames[] = {"move", "turn", "scale"};
constexpr int framesToOpen = 3;     // until a menu gets the keys
constexpr double restSeconds = 0.4; // until a pointer that does not move rests

} // namespace

void Editing::open(bool open) {
  if (open && editorLibrary().empty()) {
    say("vv was built without the editor: build with Dear ImGui (Debian: libimgui-dev)");
    return;
  }
  if (open && !model_) {
    model_.emplace();
    panels_.emplace(*model_, probes_, library_, [this] { save(); });
    library_.refresh();
  }
  if (hasTool_) endTool(false);
  if (measures_ || drag_ == Drag::measure) show("");
  isOpen_ = open;
  pressed_.reset();
  drag_ = Drag::none;
  measures_ = false;
  if (open) {
    screen_.setGui([this] { draw(); });
  } else {
    screen_.setGui(nullptr);
    screen_.setFree({});
    if (comparison_.shown() != Comparison::Shown::present) comparison_.toggle(comparison_.shown());
    showCover();
    if (model_) model_->setActive(false);
  }
}

void Editing::reset() {
  questions_.clear();
  hasOffered_ = hasTool_ = false;
  tool_.reset();
  panels_.reset();
  model_.reset();
  light_.clear();
  showCover();
  gizmo_.clear();
  report_.reset();
  progress_.clear();
  givesUpReport_ = false;
  if (isOpen_) open(true);
}

void Editing::draw() {
  const bool isUsed = tool_ && gizmo_.kind() == tool_->kind();
  const InputEvent& at = drag_ == Drag::handle && pressed_ ? *pressed_ : pointer_;
  const int pointed = isOverPicture_ && !hasTool_ ? gizmo_.axisAt(at.x, at.y) : -1;
  drawGizmo(gizmo_, isUsed ? tool_->axis() : pointed);
  drawComparison(comparison_, pointer_.x, pointer_.y, panels_->freePart());
  if (pressed_ && (drag_ == Drag::measure || drag_ == Drag::select))
    drawRectangle(regionBetween(pressed_->x, pressed_->y, pointer_.x, pointer_.y), "");
  panels_->draw();
  const PointerReading* const reading = light_.pointerOf(face);
  if (reading && !hasMoved_ && !panels_->hasPointer())
    drawReadout(*reading, isReadable_, panels_->freePart());
  screen_.setFree(panels_->freePart());
  questions_.draw();
}

std::optional<EditingMessage> Editing::takeMessage() {
  if (std::string text = report_.takeMessage(); !text.empty()) say(std::move(text));
  if (!message_ && model_)
    if (std::string text = model_->takeMessage(); !text.empty()) say(std::move(text));
  return std::exchange(message_, std::nullopt);
}

bool Editing::take(InputEvent& event) {
  using Kind = InputEvent::Kind;
  // Where the pointer is counts when the editor is opened.
  if (event.kind == Kind::move) pointer_ = event;
  hasMoved_ |= event.kind != Kind::up && event.kind != Kind::down && event.kind != Kind::type;
  if (event.kind == Kind::move || event.kind == Kind::leave)
    isOverPicture_ = event.kind == Kind::move;
  if (!isOpen_) return false;
  if (event.kind == Kind::open) {
    model_->edit([file = event.text](WorldEditor& editor) { importFile(editor, file); });
    return true;
  }
  if (hasTool_ && takeForTool(event)) return true;
  switch (event.kind) {
  case Kind::press:
    // A click selects; a drag moves the viewer. With Alt both work the world's sensors.
    event.forView = !event.alt;
    if (event.button != Button::left || event.alt) return false;
    pressed_ = event;
    drag_ = dragAt(event);
    measures_ = false;
    return drag_ != Drag::none;
  case Kind::move:
    if (drag_ != Drag::none) follow(event);
    return drag_ != Drag::none;
  case Kind::leave:
    if (drag_ == Drag::measure) show("");
    if (drag_ != Drag::tool) drag_ = Drag::none;
    return false;
  case Kind::release: return event.button == Button::left && endDrag(event);
  case Kind::down: return press(event);
  default: return false;
  }
}

// Returns what a press of the left button begins to drag.
Editing::Drag Editing::dragAt(const InputEvent& press) const {
  if (measures_) return Drag::measure;
  if (comparison_.shown() == Comparison::Shown::wiper &&
      std::abs(press.x - comparison_.wiper()) < wiperReach)
    return Drag::wiper;
  if (gizmo_.axisAt(press.x, press.y) >= 0) return Drag::handle;
  return press.control ? Drag::select : Drag::none;
}

bool Editing::isDragged(const InputEvent& event) const {
  return pressed_ && std::hypot(event.x - pressed_->x, event.y - pressed_->y) > clickDistance;
}

void Editing::follow(const InputEvent& move) {
  if (drag_ == Drag::wiper) comparison_.setWiper(move.x);
  if (drag_ == Drag::handle && isDragged(move)) {
    drag_ = Drag::tool;
    const int axis = gizmo_.axisAt(pressed_->x, pressed_->y);
    if (axis < 0) return; // it has gone meanwhile
    beginTool(*gizmo_.kind(), axis, *pressed_);
    isToolClick_ = true;
    takeForTool(move);
  }
  screen_.redraw();
}

// Ends what the left button has dragged. Returns whether it was none of the session's.
bool Editing::endDrag(const InputEvent& release) {
  const Drag drag = std::exchange(drag_, Drag::none);
  screen_.redraw();
  if (isDragged(release) && (drag == Drag::measure || drag == Drag::select)) {
    const Region region = regionBetween(pressed_->x, pressed_->y, release.x, release.y);
    model_->request([this, drag, region, view = view_, add = release.shift](WorldEditor& editor) {
      if (drag == Drag::measure)
        probes_.add(region, view);
      else
        selectIn(editor, view, region, add);
    });
    pressed_.reset();
    if (drag == Drag::measure) show("");
  } else if (drag == Drag::measure) {
    say("drag from one corner of the rectangle to the other");
  } else if (drag != Drag::wiper && drag != Drag::tool) {
    click(release);
  }
  return drag != Drag::none;
}

void Editing::click(const InputEvent& event) {
  const std::optional<InputEvent> pressed = std::exchange(pressed_, std::nullopt);
  if (!pressed || std::hypot(event.x - pressed->x, event.y - pressed->y) > clickDistance) return;
  model_->request([view = view_, event](WorldEditor& editor) {
    selectAt(editor, view, event.x, event.y, event.control, event.shift);
  });
}

// Takes a key of the editor. Returns whether it is one.
bool Editing::press(const InputEvent& event) {
  const EditorAction action = editorActionOf(event);
  // The keys are taken whatever is selected: what was clicked just now may still have to be.
  switch (action) {
  case EditorAction::none: return false;
  case EditorAction::handles:
    gizmo_.cycle();
    say(fmt::format("handles: {}", gizmo_.kind() ? kindNames[int(*gizmo_.kind())] : "none"));
    break;
  case EditorAction::move: return beginTool(TransformTool::Kind::move, -1, pointer_);
  case EditorAction::turn: return beginTool(TransformTool::Kind::turn, -1, pointer_);
  case EditorAction::scale: return beginTool(TransformTool::Kind::scale, -1, pointer_);
  case EditorAction::menu:
    panels_->openAddMenu();
    openAtOnce();
    break;
  case EditorAction::duplicate: model_->request(duplicateSelected); break;
  case EditorAction::group: model_->request(wrapSelected); break;
  case EditorAction::remove: model_->request(removeSelected); break;
  case EditorAction::rename:
    panels_->askForName();
    openAtOnce();
    break;
  case EditorAction::undo: model_->request([](WorldEditor& editor) { editor.undo(); }); break;
  case EditorAction::redo: model_->request([](WorldEditor& editor) { editor.redo(); }); break;
  case EditorAction::save: save(); break;
  case EditorAction::probe:
  case EditorAction::sensor:
  case EditorAction::rectangle: measure(action); break;
  case EditorAction::keep:
    model_->request([this](WorldEditor& editor) { light_.keep(editor, view_); });
    break;
  case EditorAction::showA: toggle(Comparison::Shown::a); break;
  case EditorAction::showWiper: toggle(Comparison::Shown::wiper); break;
  case EditorAction::showDifference: toggle(Comparison::Shown::difference); break;
  case EditorAction::frame: wantsFrame_ = true; break;
  case EditorAction::panels:
    panels_->toggle();
    screen_.redraw();
    break;
  case EditorAction::keyboard:
    panels_->passKeyboard();
    openAtOnce();
    break;
  case EditorAction::escape: escape(); break;
  }
  return true;
}

// Draws what a key has opened, so that it gets the keys that follow.
void Editing::openAtOnce() {
  for (int frame = 0; frame < framesToOpen; ++frame) {
    screen_.redraw();
    screen_.present();
  }
}

// Places a probe, or lets the next drag be a rectangle.
void Editing::measure(EditorAction action) {
  if (!hasLight_) return say("--colour vrml97 makes colours for screens, not light");
  if (action == EditorAction::rectangle) {
    measures_ = true;
    return show("drag a rectangle over what is to be measured (Escape: none)");
  }
  model_->request(
      [this, action, view = view_, at = pointer_, inside = isOverPicture_](WorldEditor& editor) {
        needPicture(inside);
        if (action == EditorAction::probe)
          light_.addProbe(editor, view, at.x, at.y);
        else
          light_.addSensor(editor, view, at.x, at.y);
      });
}

void Editing::toggle(Comparison::Shown shown) {
  model_->request([this, shown](WorldEditor&) { comparison_.toggle(shown); });
}

void Editing::escape() {
  if (measures_ || drag_ == Drag::measure || drag_ == Drag::select) {
    measures_ = false;
    pressed_.reset();
    return show("");
  }
  if (report_.isWaiting()) {
    givesUpReport_ = true;
    return;
  }
  model_->request([this](WorldEditor& editor) {
    if (comparison_.shown() != Comparison::Shown::present)
      comparison_.toggle(comparison_.shown());
    else if (editor.selection().empty())
      open(false);
    else
      editor.select({});
  });
}

bool Editing::beginTool(TransformTool::Kind kind, int axis, const InputEvent& at) {
  // Until it is ended the tool has its keys, also if it cannot begin: an axis is no other command.
  hasTool_ = true;
  isToolClick_ = hasToolFailed_ = false;
  model_->request([this, kind, axis, at](WorldEditor& editor) {
    hasToolFailed_ = true;
    tool_.emplace(editor, kind, view_, at.x, at.y);
    if (axis >= 0) tool_->chooseAxis(axis);
    hasToolFailed_ = false;
  });
  return true;
}

void Editing::useTool(std::function<void(TransformTool& tool, WorldEditor& editor)> use) {
  model_->request([this, use = std::move(use)](WorldEditor& editor) {
    if (!tool_) return;
    use(*tool_, editor);
    show(tool_->text());
  });
}

void Editing::endTool(bool accept) {
  hasTool_ = false;
  model_->request([this, accept](WorldEditor& editor) {
    if (!tool_) return;
    accept ? tool_->accept(editor) : tool_->cancel(editor);
    tool_.reset();
    show("");
  });
}

// Takes an event while a tool is in use. Returns whether it was for the tool.
bool Editing::takeForTool(const InputEvent& event) {
  using Kind = InputEvent::Kind;
  const std::string& key = event.text;
  const bool isAxis = key == "X" || key == "Y" || key == "Z";
  const auto follow = [at = pointer_](TransformTool& tool, WorldEditor& editor) {
    tool.point(editor, at.x, at.y);
  };
  switch (event.kind) {
  case Kind::move:
    useTool([follow, snap = event.control](TransformTool& tool, WorldEditor& editor) {
      tool.setSnap(snap);
      follow(tool, editor);
    });
    return true;
  case Kind::press: return isToolClick_ = true;
  case Kind::release:
    if (!isToolClick_) return false; // the session has seen the press
    endTool(event.button == Button::left);
    if (event.button == Button::left) drag_ = Drag::none;
    return true;
  case Kind::down:
    if (hasToolFailed_ && (event.control || !(isAxis || TransformTool::isNumberKey(key))))
      return hasTool_ = false;
    if ((event.control || event.alt) && !key.ends_with("Ctrl") && !key.ends_with("Alt")) {
      say("end this first: Enter keeps it, Escape takes it back");
      return true;
    }
    if (key == "Return" || key == "Keypad Enter" || key == "Escape") {
      endTool(key != "Escape");
    } else if (isAxis) {
      useTool([follow, axis = key[0] - 'X'](TransformTool& tool, WorldEditor& editor) {
        tool.chooseAxis(axis);
        follow(tool, editor);
      });
    } else {
      useTool([follow, key](TransformTool& tool, WorldEditor& editor) {
        if (tool.type(key)) follow(tool, editor);
      });
    }
    return true;
  default: return false;
  }
}

void Editing::update(Session& session, double seconds) {
  if (!model_ || (!isOpen_ && !model_->hasRequests())) return;
  if (isOpen_) offerLeft(session.editor());
  view_ = viewOf(session);
  hasLight_ = session.pilot().hasLight();
  panels_->setView(view_);
  if (model_->update(session.editor(), view_, session.pictures().isMoving(), seconds))
    screen_.redraw();
  drawBalls(session);
  followPointer(session, seconds);
  if (std::exchange(wantsFrame_, false))
    session.pilot().putAt(model_->cameraAround(session.editor(), view_, panels_->freePart()));
  if (!model_->readOnly().empty())
    gizmo_.clear();
  else if (gizmo_.place(session.editor(), view_, panels_->freePart()))
    screen_.redraw();
  if (probes_.takeKeep()) light_.keep(session.editor(), view_);
  if (light_.update(session, seconds)) screen_.redraw();
  // Below a panel the line could not be dragged.
  const FreePart& free = panels_->freePart();
  comparison_.setWiper(std::clamp(comparison_.wiper(), free.left, free.right));
  if (std::string text = light_.takeMessage(); !text.empty()) say(std::move(text));
  showCover();
  followReport(session);
}

// Lets the light be read where the pointer rests over the picture. While it moves, or is used for
// something, nothing is read.
void Editing::followPointer(Session& session, double seconds) {
  if (hasLight_) session.pictures().wantReadings(PictureLoop::Readings::later);
  isReadable_ = session.pictures().isReadable();
  const bool mayRest = isOpen_ && hasLight_ && isOverPicture_ && !panels_->hasPointer() &&
                       !hasTool_ && !measures_ && drag_ == Drag::none &&
                       comparison_.shown() == Comparison::Shown::present;
  if (std::exchange(hasMoved_, false) || !mayRest) {
    restsSince_ = seconds;
    light_.leave(face);
  } else if (seconds >= restsSince_ + restSeconds) {
    light_.point(face, pointer_.x, pointer_.y);
  }
}

// Begins a report or gives it up, and shows how far it is.
void Editing::followReport(Session& session) {
  if (panels_->takeReportWish()) report_.begin(session, probes_, comparison_.a(), arguments_);
  if (std::exchange(givesUpReport_, false)) report_.giveUp(session);
  std::string progress = report_.progress(session);
  if (progress == progress_) return;
  progress_ = progress;
  if (!progress.empty()) show(std::move(progress)); // the outcome follows
}

// Lets the looks of the library be drawn while the picture needs nobody, or the user waits for
// them.
void Editing::drawBalls(Session& session) {
  const bool isStill = session.pictures().isRefining() && !session.viewers().own().isOutdated();
  const bool mayRender =
      isOpen_ && isStill && !model_->looks().empty() &&
      (panels_->isChoosingLook() || session.pictures().isFinished(session.pilot()));
  if (library_.advance(model_->looks(), session.editor().shaderPath(), mayRender)) screen_.redraw();
}

void Editing::showCover() {
  const Comparison::Cover& cover = comparison_.cover();
  if (std::exchange(cover_, cover.number) != cover.number)
    screen_.setCover(cover.width, cover.height, cover.rgb);
  screen_.setCoverPart(comparison_.coverPart());
}

} // namespace vv
