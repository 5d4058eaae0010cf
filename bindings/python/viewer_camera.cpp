// viewer_camera.cpp: Implements the camera of a view and its input: the pointer, navigation,
// viewpoints. The browser has one viewer, which the view that was used last moves.
#include <cmath>
#include <numbers>

#include "arrays.h"
#include "viewer.h"

using namespace xvrml;

// --- The camera ---

// Returns the camera that this view has, unless it still shows what its arguments say.
std::optional<CameraSettings> Viewer::ownCamera() const {
  if (frozen_) return frozen_;
  if (viewers_->steering != this) return {};
  CameraSettings camera = browser().camera(aspect());
  if (asked_.fov)
    camera.fovy = picture::verticalAngle(*asked_.fov * std::numbers::pi / 180, aspect());
  else if (fovy_)
    camera.fovy = *fovy_;
  return camera;
}

// Tells whether the view shows what the browser's viewer sees.
bool Viewer::followsBrowser() const {
  return !frozen_ && !asked_.lookAt && !asked_.fit && browser().bound().viewpoint;
}

// Returns the camera as far as it is known without the renderer; it moves when this changes.
std::optional<CameraSettings> Viewer::knownCamera() const {
  if (auto own = ownCamera()) return own;
  if (followsBrowser()) return browser().camera(aspect());
  return {};
}

picture::View Viewer::view() const {
  const auto own = ownCamera();
  if (!own) return asked_;
  picture::View view;
  view.viewer = own;
  return view;
}

// Returns the camera of the view; nothing before its first picture. [the world's lock]
std::optional<CameraSettings> Viewer::shownCamera() const {
  if (auto own = ownCamera()) return own;
  if (!live() || !begun_) return last_; // World.render() has ended the renderer
  picture::View seen = asked_;
  if (followsBrowser()) seen.viewer = browser().camera(aspect());
  const CameraSettings camera = live()->cameraOf(seen, aspect());
  if (camera.matrix[15] != 1) return {}; // the world could not be read
  return camera;
}

std::optional<CameraSettings> withoutShader(std::optional<CameraSettings> camera) {
  if (camera) camera->shader = nullptr;
  return camera;
}

// Keeps the cameras of the other views that follow the browser's viewer, which is about to move.
void Viewer::freezeOthers() {
  for (Viewer* other : viewers_->open)
    if (other != this && other->followsBrowser())
      other->frozen_ = withoutShader(other->shownCamera());
}

// Lets this view move the browser's viewer. Returns false before a frame has read the world.
bool Viewer::steer() {
  if (viewers_->steering == this) return true;
  const auto camera = shownCamera();
  if (!camera) return false;
  const bool there = followsBrowser();
  if (!browser().bound().viewpoint) {
    double up[3];
    upVector(live() ? live()->upOf(asked_) : asked_.up.value_or(Axis::y), up);
    browser().setUp(up);
  }
  freezeOthers();
  viewers_->steering = this;
  frozen_.reset();
  fovy_.reset();
  if (there) return true;
  browser().placeViewer(camera->matrix);
  if (camera->fovy > 0) fovy_ = camera->fovy;
  return true;
}

// Another world has taken the place: no camera of the old one is of use.
void Viewer::followGeneration() {
  if (viewers_->generation == browser().generation()) return;
  viewers_->generation = browser().generation();
  viewers_->steering = nullptr;
  for (Viewer* one : viewers_->open) {
    one->asked_ = {};
    one->frozen_.reset();
    one->fovy_.reset();
    one->last_.reset();
  }
}

// --- Input ---

// Places the pointer at (x, y) of the picture, from -1 to 1. Returns whether a sensor is there.
bool Viewer::point(double x, double y, bool button) {
  if (!viewers_) return false;
  const auto lock = world_->lock();
  const auto camera = shownCamera();
  if (!camera) return false;
  const CameraRay ray = rayThrough(*camera, aspect(), x, y);
  world_->change([&] {
    browser().setAspect(aspect());
    browser().pointerRay(ray.origin, ray.direction, button);
  });
  return !browser().sensorsAtPointer().empty();
}

void Viewer::leave() {
  if (!viewers_) return;
  const auto lock = world_->lock();
  world_->change([&] { browser().pointerLeave(); });
}

bool Viewer::navigate(const NavigationInput& input, double seconds) {
  if (!viewers_) return false;
  if (!(seconds >= 0)) throw py::value_error("navigate: dt: seconds from 0 on expected");
  const auto lock = world_->lock();
  if (!steer()) return false;
  world_->change([&] { browser().navigate(input, seconds); });
  return true;
}

bool Viewer::press(Key key) {
  if (!viewers_) return false;
  const auto lock = world_->lock();
  if (!steer()) return false;
  fovy_.reset();
  world_->change([&] {
    browser().key(key, true);
    browser().key(key, false);
  });
  return true;
}

// Goes to a viewpoint, given by name or number. Returns false if the world has none.
bool Viewer::bind(const py::object& viewpoint) {
  if (!viewers_) return false;
  const auto lock = world_->lock();
  std::vector<ViewpointInfo> list;
  for (ViewpointName& one : browser().viewpoints())
    list.push_back({one.name, one.description, one.node, {}});
  const NodeRef node = list[viewpointIndex(list, viewpoint)].node;
  freezeOthers();
  viewers_->steering = this;
  frozen_.reset();
  fovy_.reset();
  world_->change([&] {
    if (browser().bound().viewpoint == node.get()) browser().key(Key::home, true);
    browser().set(*node, "set_bind", true);
  });
  return true;
}

void Viewer::setNavigation(Navigation kind) {
  const auto lock = world_->lock();
  browser().setNavigation(kind);
}

// Shows the whole world in the present direction.
bool Viewer::frameAll() {
  if (!viewers_) return false;
  const auto lock = world_->lock();
  if (!live() || !steer()) return false;
  const CameraSettings now = *ownCamera();
  const CameraSettings around = live()->cameraAround(now, aspect());
  world_->change([&] { browser().placeViewer(around.matrix); });
  return true;
}

// Returns the pose, camera to world, for column vectors; None before a frame has read the world.
py::object Viewer::camera() {
  if (!viewers_) return py::none();
  const auto lock = world_->lockDrawing();
  const auto settings = shownCamera();
  if (!settings) return py::none();
  return matrixArray(settings->matrix);
}

// Returns the vertical angle of view in radians; 0 for an orthographic camera.
double Viewer::fovy() {
  if (!viewers_) return 0;
  const auto lock = world_->lockDrawing();
  return shownCamera().value_or(CameraSettings{}).fovy;
}
