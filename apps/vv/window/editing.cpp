#include "window/editing.h"

#include <cmath>
#include <utility>

#include "window/window.h"

namespace vv {

using namespace xvrml;

namespace {

// How far the pointer may move between press and release of a click, as a part of the picture.
constexpr double clickDistance = 0.012;

} // namespace

void Editing::open(bool open) {
  if (open && editorLibrary().empty()) {
    message_ = "vv was built without the editor: build with Dear ImGui (Debian: libimgui-dev)";
    return;
  }
  if (open && !model_) {
    model_.emplace();
    panels_.emplace(*model_, probes_);
  }
  if (hasTool_) endTool(false);
  isOpen_ = open;
  pressed_.reset();
  if (open) {
    screen_.setGui([this] { panels_->draw(); });
  } else {
    screen_.setGui(nullptr);
    if (model_) model_->setActive(false);
  }
}

void Editing::reset() {
  hasTool_ = false;
  tool_.reset();
  panels_.reset();
  model_.reset();
  probes_.clear();
  report_.reset();
  if (isOpen_) open(true);
}

void Editing::leave(WorldEditor& editor, std::function<void()> go, std::function<void()> stay) {
  if (model_ && model_->hasRequests())
    return model_->request([this, go, stay](WorldEditor& later) { leave(later, go, stay); });
  if (!editor.isChanged()) return go();
  open(true);
  if (!panels_) return go(); // there is no editor in this build
  panels_->askToSave(std::move(go), std::move(stay));
  screen_.redraw();
}

std::string Editing::takeMessage() {
  if (std::string text = report_.takeMessage(); !text.empty()) return text;
  if (!message_.empty() || !model_) return std::exchange(message_, {});
  return model_->takeMessage();
}

bool Editing::take(InputEvent& event) {
  using Kind = InputEvent::Kind;
  if (!isOpen_) return false;
  if (event.kind == Kind::move) pointer_ = event;
  if (event.kind == Kind::move || event.kind == Kind::leave)
    isOverPicture_ = event.kind == Kind::move;
  if (hasTool_ && takeForTool(event)) return true;
  switch (event.kind) {
  case Kind::press:
    // A click selects; a drag moves the viewer. With Alt both work the world's sensors.
    event.forView = !event.alt;
    if (event.button == Button::left && !event.alt) pressed_ = event;
    return false;
  case Kind::release:
    if (event.button == Button::left) click(event);
    return false;
  case Kind::down: return press(event);
  default: return false;
  }
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
  const std::string& key = event.text;
  const auto request = [this](EditModel::Command command) {
    model_->request(std::move(command));
    return true;
  };
  if (event.control && key == "Z" && !event.shift)
    return request([](WorldEditor& editor) { editor.undo(); });
  if (event.control && (key == "Y" || key == "Z"))
    return request([](WorldEditor& editor) { editor.redo(); });
  if (event.control && key == "S") {
    panels_->save();
    return true;
  }
  if (!event.control && !event.alt && key == "V")
    return request(
        [this, view = view_, at = pointer_, inside = isOverPicture_](WorldEditor& editor) {
          if (!inside) throw EditError("put the pointer where the light is to be measured");
          const CameraRay ray = rayThrough(view.camera, view.aspect, at.x, at.y);
          PickHit hit;
          if (!editor.browser().pick(ray.origin, ray.direction, {.bothSides = true}, hit))
            throw EditError("there is nothing here to be measured");
          probes_.add(hit.point);
        });
  if (!event.control && !event.alt && key == "B")
    return request([this](WorldEditor& editor) {
      if (editor.browser().hasChanges()) probes_.expire();
      probes_.keep();
    });
  // The keys are taken whatever is selected: what was clicked just now may still have to be.
  if (event.control && key == "G") return request(wrapSelected);
  if (event.control || event.alt) return false;
  if (event.shift) return key == "D" && request(duplicateSelected);
  if (key == "X" || key == "Delete") return request(removeSelected);
  if (key == ".") return wantsFrame_ = true;
  if (key == "G") return beginTool(TransformTool::Kind::move);
  if (key == "R") return beginTool(TransformTool::Kind::turn);
  if (key == "S") return beginTool(TransformTool::Kind::scale);
  if (key == "Escape")
    return request([this](WorldEditor& editor) {
      if (editor.selection().empty())
        open(false);
      else
        editor.select({});
    });
  return false;
}

bool Editing::beginTool(TransformTool::Kind kind) {
  // Until it is ended the tool has its keys, also if it cannot begin: an axis is no other command.
  hasTool_ = true;
  isToolClick_ = hasToolFailed_ = false;
  model_->request([this, kind, at = pointer_](WorldEditor& editor) {
    hasToolFailed_ = true;
    tool_.emplace(editor, kind, view_, at.x, at.y);
    hasToolFailed_ = false;
  });
  return true;
}

void Editing::useTool(std::function<void(TransformTool& tool, WorldEditor& editor)> use) {
  model_->request([this, use = std::move(use)](WorldEditor& editor) {
    if (!tool_) return;
    use(*tool_, editor);
    message_ = tool_->text();
  });
}

void Editing::endTool(bool accept) {
  hasTool_ = false;
  model_->request([this, accept](WorldEditor& editor) {
    if (!tool_) return;
    accept ? tool_->accept(editor) : tool_->cancel(editor);
    tool_.reset();
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
    return true;
  case Kind::down:
    if (hasToolFailed_ && (event.control || !(isAxis || TransformTool::isNumberKey(key))))
      return hasTool_ = false;
    if ((event.control || event.alt) && !key.ends_with("Ctrl") && !key.ends_with("Alt")) {
      message_ = "end this first: Enter keeps it, Escape takes it back";
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
  view_ = {session.pilot().camera(), session.pilot().aspect()};
  panels_->setView(view_);
  if (model_->update(session.editor(), view_, session.pictures().isMoving(), seconds))
    screen_.redraw();
  if (std::exchange(wantsFrame_, false))
    session.pilot().putAt(model_->cameraAround(session.editor(), view_));
  readProbes(session, seconds);
  if (panels_->takeReportWish()) report_.begin(session, probes_, arguments_);
}

// Reads the probes from the still picture of the world as it is, a few times a second.
void Editing::readProbes(Session& session, double seconds) {
  constexpr double interval = 0.25;
  if (probes_.all().empty()) return;
  const bool outdated = session.viewers().own().isOutdated();
  if (outdated) probes_.expire();
  if (outdated || seconds < probesRead_ + interval) return;
  session.pictures().wantReadings();
  const uint64_t finished =
      session.pictures().isFinished(session.pilot()) ? session.pictures().number() : 0;
  if (finished != 0 && finished == finishedRead_ && !probes_.isWaiting()) return;
  picture::Picture picture;
  if (!session.pictures().copyStill(picture) || !picture.planes.contains(RT_ERROR)) return;
  probesRead_ = seconds;
  finishedRead_ = finished;
  probes_.read(session.browser(), picture, view_);
  screen_.redraw();
}

} // namespace vv
