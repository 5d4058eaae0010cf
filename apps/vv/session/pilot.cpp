#include "session/pilot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "libpicture/renderer.h"
#include "options/values.h"
#include "xvrml/nodes.h"

namespace vv {

using xvrml::Navigation;
using xvrml::NavigationInput;

namespace {

constexpr double transition = 0.5; // seconds between two Viewpoints
// One notch of the wheel: the change of the logarithm of the distance, or full speed for this many
// seconds.
constexpr double notch = 0.2;

} // namespace

const char* navigationName(Navigation type) {
  switch (type) {
  case Navigation::walk: return "walk";
  case Navigation::fly: return "fly";
  case Navigation::examine: return "examine";
  case Navigation::none: break;
  }
  return "none";
}

namespace {

// Returns the speed for a pointer drag; `way` is the distance since the press, as a fraction of
// half the picture. The speed rises slowly at first.
double speedOf(double way) {
  constexpr double dead = 0.02;
  const double far = std::max(0.0, std::abs(way) - dead);
  return std::copysign(far + 3 * far * far, way);
}

} // namespace

Pilot::Pilot(xvrml::Browser& browser, double start, const picture::View& view)
    : browser_(browser), viewer_(makeWorldViewer(browser)), time_(start),
      pointer_(
          browser, [this] { return eye(); }, makeSharedPointer()),
      fov_(view.fov), ortho_(view.ortho) {
  const xvrml::BoundNodes bound = browser_.bound();
  // A world without Viewpoint and NavigationInfo is probably a model: start with EXAMINE.
  if (!bound.viewpoint && !bound.navigationInfo) viewer_->setNavigation(Navigation::examine);
}

Pilot::Pilot(const Pilot& leader, xvrml::Browser& browser)
    : browser_(browser), viewer_(makeGuestViewer(browser)), time_(0),
      pointer_(
          browser, [this] { return eye(); }, leader.pointer_.shared()),
      fov_(leader.fov_), ortho_(leader.ortho_), headlight_(leader.headlight_),
      exposure_(leader.exposure_) {}

void Pilot::setAspect(double aspect) {
  aspect_ = aspect;
  viewer_->setAspect(aspect);
}

xvrml::CameraSettings Pilot::camera(double aspect) const {
  xvrml::CameraSettings camera = viewer_->camera(aspect);
  if (fov_) camera.fovy = picture::verticalAngle(*fov_ * std::numbers::pi / 180, aspect);
  if (ortho_) {
    camera.fovy = 0;
    camera.height = *ortho_;
  }
  if (fitted_ && fitted_->viewpoint == viewer_->viewpoint() &&
      (camera.fovy == 0 || fitted_->fovy == 0)) {
    camera.fovy = fitted_->fovy;
    camera.height = fitted_->height;
  }
  return camera;
}

void Pilot::step(double seconds) {
  const double passed = time_.advance(seconds);
  if (viewer_->isOfWorld()) browser_.tick(paused() ? browser_.now() : time_.time());
  move(passed);
  // The viewer may have moved below the pointer.
  if (pointer_.place() != Pointer::Place::outside && pointer_.drag() != Pointer::Drag::view)
    pointer_.send();
}

// --- The pointer ---

bool Pilot::pick(double x, double y, xvrml::PickHit& hit) const {
  const xvrml::CameraRay ray = xvrml::rayThrough(camera(), aspect_, x, y);
  if (!browser_.pick(ray.origin, ray.direction, {}, hit)) return false;
  hit.distance *= std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
  return true;
}

// EXAMINE: the world follows the pointer. The other navigation types use the distance since the
// press, in move().
void Pilot::drag(const Pointer::Way& way) {
  if (viewer_->navigation() != Navigation::examine) return;
  const double size = std::tan(camera().fovy / 2);
  switch (pointer_.button()) {
  case Button::left: return navigate({.turn = -way.x, .tilt = way.y}, 1);
  case Button::right: return navigate({.right = -way.x * size * aspect_, .up = -way.y * size}, 1);
  case Button::middle: return navigate({.ahead = way.y}, 1);
  }
}

void Pilot::wheel(const InputEvent& event) { navigate({.ahead = event.amount}, notch); }

std::string Pilot::hint() const {
  if (!pointer_.isOverSensor()) return {};
  for (const xvrml::NodeRef& node : browser_.sensorsAtPointer()) {
    const auto* anchor = xvrml::nodeCast<xvrml::nodes::Anchor>(node.get());
    const xvrml::FieldInfo* text = node->type().find("description");
    const auto* description = text && text->type == xvrml::FieldType::SFString
                                  ? static_cast<const std::string*>(node->storage(*text))
                                  : nullptr;
    if (!anchor && description && !description->empty()) return *description; // a sensor of X3D
    if (!anchor) continue;
    return !anchor->description.empty() ? anchor->description
           : anchor->url.empty()        ? std::string()
                                        : anchor->url.front();
  }
  return {};
}

// --- The viewer ---

void Pilot::navigate(const NavigationInput& input, double seconds) {
  viewer_->move(input, seconds);
  touched_ = true;
  gravityActs_ = viewer_->navigation() == Navigation::walk;
}

bool Pilot::isSteering() const {
  return !held_.empty() ||
         (pointer_.drag() == Pointer::Drag::view && viewer_->navigation() != Navigation::examine);
}

void Pilot::move(double seconds) {
  if (!(seconds > 0)) return;
  NavigationInput input;
  bool wanted = false;
  if (pointer_.drag() == Pointer::Drag::view && viewer_->navigation() != Navigation::examine) {
    const Pointer::Way way = pointer_.sincePress();
    const double dx = speedOf(way.x), dy = speedOf(way.y);
    wanted = dx != 0 || dy != 0;
    switch (pointer_.button()) {
    case Button::left:
      input.ahead = dy;
      input.turn = -dx;
      break;
    case Button::right:
      input.right = dx;
      input.up = dy;
      break;
    case Button::middle:
      input.tilt = dy;
      input.turn = -dx;
      break;
    }
  }
  const auto held = [&](const char* key) { return held_.contains(key) ? 1.0 : 0.0; };
  const double across = held("Right") - held("Left"), along = held("Up") - held("Down"),
               speed = shift_ ? 4 : 1;
  wanted = wanted || across != 0 || along != 0;
  if (alt_) {
    input.right += across * speed;
    input.up += along * speed;
  } else {
    input.turn -= across;
    input.ahead += along * speed;
  }
  if (wanted)
    navigate(input, seconds);
  else if (gravityActs_)
    viewer_->move({}, seconds);
}

void Pilot::fitTo(const xvrml::CameraSettings& camera) {
  viewer_->place(camera.matrix);
  fitted_ = Fitted{viewer_->viewpoint(), camera.fovy, camera.height};
}

void Pilot::frameAll(const xvrml::CameraSettings& around) {
  fitTo(around);
  gravityActs_ = false;
}

void Pilot::present(const xvrml::CameraSettings& camera, xvrml::Axis up) {
  double axis[3];
  xvrml::upVector(up, axis);
  viewer_->setUp(axis);
  fitTo(camera);
  gravityActs_ = false;
}

void Pilot::allowFalseColours(std::optional<double> given) {
  scaleEnd_ = given.value_or(0);
  showsFalseColours_ = given.has_value();
}

std::optional<picture::View> Pilot::initialView(const picture::View& view) const {
  const bool decides = view.authored != picture::View::Authored::shown;
  if (viewer_->viewpoint() && !view.up && !view.lookAt && !view.side && !decides) return {};
  picture::View wanted = view;
  if (decides) return wanted;
  wanted.fit = true;
  if (!wanted.fov && !wanted.ortho && viewer_->viewpoint()) { // keep the Viewpoint's field of view
    const double vertical = camera().fovy;
    const double smaller =
        aspect_ >= 1 ? vertical : 2 * std::atan(std::tan(vertical / 2) * aspect_);
    if (smaller > 0) wanted.fov = smaller * 180 / std::numbers::pi;
  }
  return wanted;
}

bool Pilot::begin(const picture::View& view, const std::string& viewpoint) {
  double matrix[16];
  if (!viewpoint.empty() && !bindViewpoint(viewpoint))
    throw Failure{exitUsage, fmt::format("--viewpoint: the world has no \"{}\"", viewpoint)};
  if (view.up) {
    double up[3];
    xvrml::upVector(*view.up, up);
    viewer_->setUp(up);
  }
  if (picture::lookAtMatrix(view, matrix)) viewer_->place(matrix);
  return view.fit || view.side || view.authored != picture::View::Authored::shown ||
         (!view.lookAt && !viewer_->viewpoint());
}

void Pilot::animateTransitions() {
  animates_ = true;
  viewer_->setTransition(transition);
}

void Pilot::setPaused(bool wanted) {
  if (wanted == paused()) return;
  time_.toggle();
  // a paused transition would stand still
  viewer_->setTransition(paused() || !animates_ ? 0 : transition);
}

void Pilot::skip(double seconds, double fps) {
  const double begin = browser_.now();
  time_.skip(seconds);
  for (double passed = 0; passed < seconds;) {
    passed = std::min(seconds, passed + 1 / fps);
    browser_.tick(begin + passed);
  }
}

void Pilot::putAt(const xvrml::CameraSettings& camera) {
  viewer_->place(camera.matrix);
  touched_ = true;
}

bool Pilot::bindViewpoint(const std::string& name) {
  std::vector<xvrml::ViewpointInfo> list;
  for (xvrml::ViewpointName& one : browser_.viewpoints())
    list.push_back({one.name, one.description, one.node, {}});
  const int index = picture::findViewpoint(list, name);
  if (index < 0) return false;
  viewer_->goTo(*list[size_t(index)].node);
  gravityActs_ = false;
  fitted_.reset();
  return true;
}

bool Pilot::jumpToViewpoint(const std::string& name) {
  const double usual = animates_ && !paused() ? transition : 0;
  viewer_->setTransition(0);
  const bool bound = bindViewpoint(name);
  viewer_->setTransition(usual);
  touched_ = touched_ || bound;
  return bound;
}

void Pilot::jumpTo(size_t number) {
  const std::vector<xvrml::ViewpointName> list = visitedViewpoints(browser_);
  if (!list.empty()) viewer_->goTo(*list[std::min(number, list.size() - 1)].node);
}

void Pilot::choose(Navigation type, const char* name) {
  gravityActs_ = false;
  message_ = viewer_->setNavigation(type) ? name
                                          : fmt::format("the world does not allow it: {}",
                                                        navigationName(viewer_->navigation()));
}

bool Pilot::hasHeadlight() const {
  const auto* info = xvrml::nodeCast<xvrml::nodes::NavigationInfo>(browser_.bound().navigationInfo);
  return headlight_.value_or(!info || info->headlight);
}

Action Pilot::press(Action action) {
  const xvrml::Node* before = viewer_->viewpoint();
  const bool nowhere =
      action == Action::firstViewpoint || action == Action::lastViewpoint || action == Action::back;
  if (nowhere && browser_.viewpoints().empty()) return Action::beginAgain;
  switch (action) {
  case Action::firstViewpoint: jumpTo(0); break;
  case Action::lastViewpoint: jumpTo(size_t(-1)); break;
  case Action::previousViewpoint: viewer_->step(Viewer::Step::previous); break;
  case Action::nextViewpoint: viewer_->step(Viewer::Step::next); break;
  case Action::back: viewer_->goBack(); break;
  case Action::examine: choose(Navigation::examine, "examine"); break;
  case Action::walk: choose(Navigation::walk, "walk"); break;
  case Action::fly: choose(Navigation::fly, "fly"); break;
  case Action::still: choose(Navigation::none, "stand still"); break;
  case Action::headlight:
    message_ = hasHeadlight() ? "headlight off" : "headlight on";
    // Returns to the world's own setting, or switches to the opposite of it.
    headlight_ = headlight_ ? std::nullopt : std::optional(!hasHeadlight());
    break;
  case Action::brighter:
  case Action::darker:
    exposure_ = std::clamp(exposure_ + (action == Action::brighter ? .5 : -.5),
                           -picture::mostExposure / 2, picture::mostExposure / 2);
    message_ = fmt::format("exposure {:+g}", exposure_);
    break;
  case Action::falseColours:
    if (!scaleEnd_) {
      message_ = "false colours need a window and light that is added linearly";
      break;
    }
    showsFalseColours_ = !showsFalseColours_;
    message_ = showsFalseColours_ ? "luminance in false colours" : "own colours";
    break;
  case Action::pause:
    if (!viewer_->isOfWorld()) {
      message_ = "only the viewer who leads stops the time";
      break;
    }
    setPaused(!paused());
    message_ = paused() ? "time stands still" : "time goes on";
    break;
  default: return action;
  }
  if (const xvrml::Node* now = viewer_->viewpoint(); now && now != before) {
    gravityActs_ = false;
    for (const xvrml::ViewpointName& one : browser_.viewpoints())
      if (one.node.get() == now) message_ = one.description.empty() ? one.name : one.description;
  }
  if (action <= Action::back) {
    gravityActs_ = false;
    fitted_.reset();
  }
  return Action::none;
}

Action Pilot::windowAction(const InputEvent& event, Keys keys) const {
  if (event.kind == InputEvent::Kind::save) return Action::save;
  if (event.kind == InputEvent::Kind::quit) return Action::quit;
  if (event.kind != InputEvent::Kind::down) return Action::none;
  const WorldKeys::Claim claim = WorldKeys::claimOf(browser_, event);
  const bool isOfWindow = claim == WorldKeys::Claim::window ||
                          (claim == WorldKeys::Claim::both && keys == Keys::shared);
  const Action action = actionOf(WorldKeys::commandOf(browser_, event));
  return isOfWindow && action >= Action::save ? action : Action::none;
}

Action Pilot::handle(const InputEvent& event) {
  using Kind = InputEvent::Kind;
  switch (event.kind) {
  case Kind::move:
  case Kind::press:
  case Kind::release: {
    const Pointer::Way way = pointer_.moveTo(event.x, event.y);
    if (event.kind == Kind::press)
      pointer_.press(event);
    else if (pointer_.drag() == Pointer::Drag::view && (way.x != 0 || way.y != 0))
      drag(way);
    else
      pointer_.send();
    if (event.kind == Kind::release) pointer_.release(event);
    break;
  }
  case Kind::leave:
    held_.clear();
    worldKeys_.release(browser_);
    pointer_.leave();
    break;
  case Kind::wheel: wheel(event); break;
  case Kind::type: browser_.worldText(event.text); break;
  case Kind::down:
    if (worldKeys_.press(browser_, event)) break;
    shift_ = event.shift;
    alt_ = event.alt;
    if (event.text == "Left" || event.text == "Right" || event.text == "Up" ||
        event.text == "Down") {
      held_.insert(event.text);
      break;
    }
    return press(actionOf(worldKeys_.commandOf(browser_, event)));
  case Kind::up:
    worldKeys_.release(browser_, event);
    shift_ = event.shift;
    alt_ = event.alt;
    held_.erase(event.text);
    break;
  case Kind::viewpoint:
    if (!bindViewpoint(event.text))
      message_ = fmt::format("there is no viewpoint \"{}\"", event.text);
    break;
  case Kind::save: return Action::save;
  case Kind::quit: return Action::quit;
  case Kind::open: break;
  }
  return Action::none;
}

} // namespace vv
