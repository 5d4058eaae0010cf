// viewer.cpp: Implements the Python class Viewer: one view of a running world, with a camera of its
// own, whose pictures are rendered while Python goes on. xvrml/_live.py decides when a frame begins
// and what input means; xvrml/_notebook.py shows the pictures. The views of a world share one
// LiveRenderer and take turns. [GIL held; released for long operations]
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "frame_sizing.h"
#include "objects.h"
#include "parameters.h"
#include "quality_parameters.h"
#include "render_request.h"

using namespace xvrml;

namespace {

class Viewer;
using State = picture::LiveRenderer::State;

} // namespace

// The open views of a world, and what they share.
struct Viewers {
  picture::RenderSettings settings; // each view has its own size and samples
  std::vector<Viewer*> open;
  Viewer* drawing = nullptr;  // began the last frame
  Viewer* filling = nullptr;  // the renderer fills gaps of unfinished pictures from this view's
  Viewer* steering = nullptr; // moves the browser's viewer; the cameras of the others stay
  uint64_t changes = 0;       // number of frames that began because the world had changed
  uint64_t generation = 0;    // generation of the browser's world
  uint32_t numbers = 0;       // number of views opened so far
};

namespace {

struct ViewerArguments : RenderArguments {
  WorldPtr world;
};

bool same(const std::optional<CameraSettings>& a, const std::optional<CameraSettings>& b) {
  if (!a || !b) return !a && !b;
  return std::memcmp(a->matrix, b->matrix, sizeof a->matrix) == 0 && a->fovy == b->fovy &&
         a->height == b->height && a->shader == b->shader;
}

class Viewer {
 public:
  explicit Viewer(const ViewerArguments& given);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  void close();
  bool isOpen() const { return viewers_ != nullptr; }

  void resize(long long width, long long height);
  const char* state();
  bool isOutdated();
  bool start(bool moving, bool raw);
  void cancel();
  py::object look();

  bool point(double x, double y, bool button);
  void leave();
  bool navigate(const NavigationInput& input, double seconds);
  bool press(Key key);
  bool bind(const py::object& viewpoint);
  bool frameAll();
  py::object camera();
  double fovy();
  Navigation navigation() const { return browser().navigation(); }
  void setNavigation(Navigation kind);

  py::object onChange = py::none(); // called when the world has changed; None: nobody

 private:
  const picture::LiveRenderer* live() const { return world_->locks->live.get(); }
  Browser& browser() const { return *world_->running; }
  double aspect() const { return double(width_) / height_; }
  std::optional<CameraSettings> ownCamera() const;
  std::optional<CameraSettings> knownCamera() const;
  bool followsBrowser() const;
  picture::View view() const;
  std::optional<CameraSettings> shownCamera() const;
  void freezeOthers();
  bool steer();
  void bindNode(Node& node);
  void followGeneration();
  void makeRenderer();

  WorldPtr world_;
  std::shared_ptr<Viewers> viewers_; // null: closed
  uint32_t number_ = 0;
  int width_ = 1, height_ = 1, samples_ = 1;
  picture::View asked_; // the view of the arguments, until the user steers
  // The camera since another view began to steer, and the angle of view that the browser's viewer
  // does not have.
  std::optional<CameraSettings> frozen_;
  std::optional<double> fovy_;
  std::optional<CameraSettings> last_; // the camera of the last picture
  FrameSizing sizing_;
  // The last frame that began.
  bool begun_ = false, moving_ = false;
  FrameSize frame_;
  uint64_t frameChanges_ = 0;
  std::optional<CameraSettings> frameCamera_;
};

// --- Opening and closing ---

Viewer::Viewer(const ViewerArguments& given) : world_(given.world) {
  if (py::hasattr(given.camera, "_numbers"))
    throw py::value_error("camera: a Pinhole belongs to pictures of one size; a view takes a 4x4 "
                          "matrix, (position, target) or (position, target, up)");
  RenderRequest request = requestOf(given);
  asked_ = request.view;
  samples_ = request.settings.samples;
  width_ = request.settings.width;
  height_ = request.settings.height;
  const RenderArguments defaults; // so that the settings of two views can be compared
  const RenderRequest usual = requestOf(defaults);
  request.settings.width = usual.settings.width;
  request.settings.height = usual.settings.height;
  request.settings.samples = usual.settings.samples;
  request.settings.channels = RT_RGBA;
  request.settings.progressive = true;

  Browser& running = world_->live();
  const auto lock = world_->lock();
  if (world_->viewers && !(world_->viewers->settings == request.settings))
    throw py::value_error(
        "the views of a world have the same options, except size, spp, viewpoint, "
        "camera, fit, fov and up");
  const auto shared = world_->viewers ? world_->viewers : std::make_shared<Viewers>();
  if (!world_->viewers) {
    shared->settings = request.settings;
    shared->generation = running.generation();
    const BoundNodes bound = running.bound();
    // A world without Viewpoint and NavigationInfo is probably a model.
    if (!bound.viewpoint && !bound.navigationInfo) running.setNavigation(Navigation::examine);
  }
  viewers_ = shared;
  if (!given.viewpoint.is_none()) {
    try {
      bind(given.viewpoint);
    } catch (...) {
      viewers_.reset();
      throw;
    }
  }
  number_ = shared->numbers++;
  shared->open.push_back(this);
  world_->viewers = shared;
}

Viewer::~Viewer() {
  try {
    close();
  } catch (const std::exception&) {} // the lock failed: nothing else uses the view any more
}

void Viewer::close() {
  if (!viewers_) return;
  cancel();
  const auto lock = world_->lockDrawing();
  std::erase(viewers_->open, this);
  for (Viewer** role : {&viewers_->drawing, &viewers_->filling, &viewers_->steering})
    if (*role == this) *role = nullptr;
  const bool last = viewers_->open.empty();
  viewers_.reset();
  onChange = py::none();
  if (!last) return;
  world_->viewers.reset();
  const ReleaseGil release; // the end of the frame may take a moment
  world_->locks->live.reset();
}

void Viewer::resize(long long width, long long height) {
  if (width < 1 || height < 1 || width > 65536 || height > 65536 || width * height > 1LL << 28)
    throw py::value_error(fmt::format("size: (width, height) from 1 to 65536 and at most 2^28 "
                                      "pixels expected, not ({}, {})",
                                      width, height));
  width_ = int(width);
  height_ = int(height);
}

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

// Removes the ORTShader of a camera that is kept: nobody would keep the node.
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

// --- Frames ---

const char* Viewer::state() {
  if (!viewers_) return "closed";
  const auto lock = world_->tryLock();
  if (!lock) return "busy";
  return !live() || live()->state() == State::idle ? "idle" : "rendering";
}

bool Viewer::isOutdated() {
  if (!viewers_) return false;
  if (!begun_ || !live()) return true; // the renderer of world.render() has taken the changes
  const auto lock = world_->lockGraph();
  return browser().hasChanges() || frameChanges_ != viewers_->changes ||
         viewers_->generation != browser().generation() || !same(knownCamera(), frameCamera_) ||
         (!moving_ && (frame_.width != width_ || frame_.height != height_));
}

void Viewer::makeRenderer() {
  const ReleaseGil release;
  world_->releaseRenderer(); // only one renderer per browser: it consumes the changes
  world_->locks->live = std::make_unique<picture::LiveRenderer>(browser(), viewers_->settings);
  viewers_->drawing = viewers_->filling = nullptr;
  ++viewers_->changes;
}

// Begins a frame. Returns false if the renderer or the world is busy. moving: the frame is small
// enough for the frame rate, and a preview.
bool Viewer::start(bool moving, bool raw) {
  if (!viewers_) return false;
  const auto lock = world_->tryLock();
  if (!lock) return false;
  followGeneration();
  if (!live()) makeRenderer();
  picture::LiveRenderer& renderer = *world_->locks->live;
  if (renderer.state() != State::idle) return false;
  for (picture::LivePicture old; renderer.look(old);) {} // of a view that was closed
  using Purpose = picture::LiveFrame::Purpose;
  picture::LiveFrame frame;
  frame.view = view();
  frame.viewer = number_;
  frame.purpose = !moving ? Purpose::still : raw ? Purpose::rawPreview : Purpose::preview;
  frame_ = moving ? sizing_.next(width_, height_) : FrameSize{width_, height_, samples_};
  frame.width = frame_.width;
  frame.height = frame_.height;
  frame.samples = std::min(frame_.samples, samples_);
  viewers_->changes += browser().hasChanges();
  frameChanges_ = viewers_->changes;
  frameCamera_ = knownCamera();
  begun_ = true;
  moving_ = moving;
  renderer.start(frame);
  viewers_->drawing = this;
  return true;
}

void Viewer::cancel() {
  if (viewers_ && viewers_->drawing == this && live()) world_->locks->live->cancel();
}

// Returns a newer picture and facts about it; None: there is none. Raises RenderError if the last
// frame failed.
py::object Viewer::look() {
  if (!viewers_ || viewers_->drawing != this) return py::none();
  const auto lock = world_->tryLock(); // messages are added to the world's problems
  if (!lock || !live()) return py::none();
  auto picture = std::make_unique<picture::LivePicture>();
  std::string failure;
  bool found = false;
  {
    const ReleaseGil release;
    found = world_->locks->live->look(*picture);
    if (!found) failure = world_->locks->live->takeFailure();
  }
  if (!failure.empty()) throw picture::RenderError(failure);
  if (!found) return py::none();
  if (picture->finished)
    sizing_.took({picture->width, picture->height, 1}, picture->seconds, picture->overhead,
                 picture->samples);
  // The gaps may show the picture of another view.
  if (viewers_->filling != this && picture->covered < 1) return py::none();
  viewers_->filling = this;
  last_ = withoutShader(shownCamera());
  py::dict facts;
  facts["moving"] = moving_;
  facts["preview"] = picture->preview;
  facts["finished"] = picture->finished;
  facts["samples"] = picture->samples;
  facts["seconds"] = picture->seconds;
  facts["size"] = py::make_tuple(picture->width, picture->height);
  auto* bytes = new std::vector<uint8_t>(std::move(picture->rgb));
  const py::capsule owner(bytes, [](void* all) { delete static_cast<std::vector<uint8_t>*>(all); });
  return py::make_tuple(
      py::array_t<uint8_t>({picture->height, picture->width, 3}, bytes->data(), owner), facts);
}

// --- Input ---

// Places the pointer at (x, y) of the picture, from -1 to 1. Returns whether a sensor is there.
bool Viewer::point(double x, double y, bool button) {
  if (!viewers_) return false;
  const auto lock = world_->lock();
  const auto camera = shownCamera();
  if (!camera) return false;
  const double* m = camera->matrix;
  const bool perspective = camera->fovy > 0;
  const double size = perspective ? std::tan(camera->fovy / 2) : camera->height / 2;
  double origin[3], direction[3];
  for (size_t i = 0; i < 3; ++i) {
    const double aside = m[i] * x * size * aspect() + m[4 + i] * y * size;
    origin[i] = m[12 + i] + (perspective ? 0 : aside);
    direction[i] = -m[8 + i] + (perspective ? aside : 0);
  }
  world_->change([&] {
    browser().setAspect(aspect());
    browser().pointerRay(origin, direction, button);
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
  const CameraSettings around = cameraAround(live()->bounds(), now.matrix, now.fovy, aspect());
  world_->change([&] { browser().placeViewer(around.matrix); });
  return true;
}

// Returns the pose, camera to world, for column vectors; None before a frame has read the world.
py::object Viewer::camera() {
  if (!viewers_) return py::none();
  const auto lock = world_->lockDrawing();
  const auto settings = shownCamera();
  if (!settings) return py::none();
  py::array_t<double> matrix({4, 4});
  for (size_t i = 0; i < 16; ++i)
    matrix.mutable_at(py::ssize_t(i % 4), py::ssize_t(i / 4)) = settings->matrix[i];
  return matrix;
}

// Returns the vertical angle of view in radians; 0 for an orthographic camera.
double Viewer::fovy() {
  if (!viewers_) return 0;
  const auto lock = world_->lockDrawing();
  return shownCamera().value_or(CameraSettings{}).fovy;
}

std::unique_ptr<Viewer> makeViewer(const ViewerArguments& given) {
  return std::make_unique<Viewer>(given);
}

} // namespace

void wakeViews(Viewers& viewers) noexcept {
  try {
    const std::vector<Viewer*> open = viewers.open; // a callable may close views
    for (Viewer* one : open) {
      if (std::find(viewers.open.begin(), viewers.open.end(), one) == viewers.open.end()) continue;
      const py::object call = one->onChange;
      if (call.is_none()) continue;
      try {
        call();
      } catch (py::error_already_set& failure) { failure.discard_as_unraisable(call); }
    }
  } catch (const std::exception&) {} // not enough memory: the view looks again by itself
}

void defineViewer(py::module_& module) {
  py::class_<Viewer> viewer(module, "Viewer",
                            "One view of a running world, for xvrml.LiveView: begins frames, "
                            "returns their pictures, and takes the pointer and the movement.");
  using A = ViewerArguments;
  defineConstructor(
      viewer, makeViewer, parameterList(requiredParameter("world", &A::world)),
      parameterList(parameter("size", &A::size), parameter("spp", &A::spp),
                    parameter("viewpoint", &A::viewpoint), parameter("camera", &A::camera),
                    parameter("fit", &A::fit), parameter("fov", &A::fov),
                    qualityParameter<long long>(RT_SEED), parameter("threads", &A::threads),
                    qualityParameter<Switch>(RT_SHADOWS), parameter("colour", &A::colour),
                    parameter("headlight", &A::headlight),
                    qualityParameter<long long>(RT_MAX_DEPTH),
                    qualityParameter<std::string>(RT_TRANSPORT), qualityParameter<double>(RT_CLAMP),
                    parameter("multiply_textures", &A::multiplyTextures), parameter("up", &A::up),
                    parameter("background", &A::background), parameter("isa", &A::isa)),
      "The options are those of World.render().");
  viewer.def("close", &Viewer::close)
      .def_property_readonly("is_open", &Viewer::isOpen)
      .def("resize", &Viewer::resize, py::arg("width"), py::arg("height"))
      .def_property_readonly("state", &Viewer::state,
                             "'idle', 'rendering', 'busy' (the world is used elsewhere, or a frame "
                             "reads it) or 'closed'.")
      .def_property_readonly("is_outdated", &Viewer::isOutdated)
      .def("start", &Viewer::start, py::arg("moving"), py::arg("raw") = false)
      .def("cancel", &Viewer::cancel)
      .def("look", &Viewer::look)
      .def("point", &Viewer::point, py::arg("x"), py::arg("y"), py::arg("button"))
      .def("leave", &Viewer::leave)
      .def(
          "navigate",
          [](Viewer& self, double dt, double ahead, double right, double up, double turn,
             double tilt) {
            return self.navigate({ahead, right, up, turn, tilt, 0}, dt);
          },
          py::arg("dt"), py::kw_only(), py::arg("ahead") = 0, py::arg("right") = 0,
          py::arg("up") = 0, py::arg("turn") = 0, py::arg("tilt") = 0)
      .def(
          "press", [](Viewer& self, const std::string& key) { return self.press(keyOf(key)); },
          py::arg("key"))
      .def("bind", &Viewer::bind, py::arg("viewpoint"))
      .def_property(
          "navigation", [](Viewer& self) { return navigationName(self.navigation()); },
          [](Viewer& self, const std::string& name) { self.setNavigation(navigationOf(name)); },
          "'none', 'walk', 'fly' or 'examine'; one that the world does not allow becomes its "
          "first.")
      .def("frame_all", &Viewer::frameAll)
      .def_property_readonly("camera", &Viewer::camera)
      .def_property_readonly("fovy", &Viewer::fovy)
      .def_readwrite("on_change", &Viewer::onChange);
}
