// viewer.cpp: Implements the Python class Viewer: opening and closing views, and their frames.
// viewer_camera.cpp has the camera and the input.
#include "viewer.h"

#include <algorithm>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/live/denoise_choice.h"
#include "parameters.h"
#include "picture_size.h"
#include "quality_parameters.h"

using namespace xvrml;

namespace {

using State = picture::LiveRenderer::State;

} // namespace

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
  request.settings.denoiser = picture::Denoiser::automatic;

  Browser& running = world_->live();
  const auto lock = world_->lock();
  const picture::Look look = world_->viewers
                                 ? world_->viewers->look
                                 : picture::lookOf(world_->graph(), world_->shadersGiven);
  if (request.isLookOpen) picture::choose(look, request.settings);
  if (world_->viewers && !(world_->viewers->settings == request.settings))
    throw py::value_error(
        "the views of a world have the same options, except size, spp, viewpoint, "
        "camera, fit, fov and up");
  const auto shared = world_->viewers ? world_->viewers : std::make_shared<Viewers>();
  if (!world_->viewers) {
    shared->settings = request.settings;
    shared->look = look;
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
      if (shared->steering == this) shared->steering = nullptr;
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
  if (!isPictureSize(width, height))
    throw py::value_error(fmt::format("size: (width, height) from 1 to 65536 and at most 2^28 "
                                      "pixels expected, not ({}, {})",
                                      width, height));
  width_ = int(width);
  height_ = int(height);
}

// --- Frames ---

const char* Viewer::state() {
  if (!viewers_) return "closed";
  const auto lock = world_->tryLock();
  if (!lock) return "busy";
  return !live() || live()->state() == State::idle ? "idle" : "rendering";
}

// Tells whether the last frame does not show the world as it is now; while the world is busy, what
// was so before.
bool Viewer::isOutdated() {
  if (!viewers_) return false;
  const auto lock = world_->tryLock();
  if (!lock) return wasOutdated_;
  return wasOutdated_ = !begun_ ||
                        !live() || // the renderer of World.render() has taken the changes
                        browser().hasChanges() || frameChanges_ != viewers_->changes ||
                        viewers_->generation != browser().generation() ||
                        knownCamera() != frameCamera_ || (moving_ && isBehind_) ||
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
  for (picture::LivePicture old; renderer.look(old);) {} // from a view that was closed
  using Purpose = picture::LiveFrame::Purpose;
  picture::LiveFrame frame;
  frame.view = view();
  frame.viewer = number_;
  frame.purpose = !moving ? Purpose::still : raw ? Purpose::rawPreview : Purpose::preview;
  if (raw) light_ = picture::rawOf(light_);
  frame_ = pacing_.next(width_, height_, moving, samples_, light_);
  frame.width = frame_.width;
  frame.height = frame_.height;
  frame.samples = frame_.samples;
  frame.lightStride = frame_.lightStride;
  const picture::FrameSize shown = pacing_.shown(width_, height_);
  frame.shownWidth = shown.width;
  frame.shownHeight = shown.height;
  frame.denoising = picture::live::denoisingInMotion(framesPerSecond);
  viewers_->changes += browser().hasChanges();
  frameChanges_ = viewers_->changes;
  frameCamera_ = knownCamera();
  begun_ = true;
  moving_ = moving;
  renderer.start(frame);
  viewers_->drawing = this;
  return true;
}

// Ends the frame in flight soon. Nothing happens while another thread uses the world.
void Viewer::cancel() {
  if (!viewers_ || viewers_->drawing != this) return;
  const std::unique_lock drawing(world_->locks->drawing, std::try_to_lock);
  if (drawing && live()) world_->locks->live->cancel();
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
  if (picture->finished) {
    isBehind_ = picture->outdated;
    pacing_.took({picture->width, picture->height, 1, picture->lightStride}, picture->seconds,
                 picture->alone, picture->overhead, picture->samples, picture->rebuilding,
                 picture->showing);
    light_ = picture::lightOf(picture->stats, true);
  }
  // The world may still be read while the fast view is shown.
  if (!picture->raster) {
    // The gaps may show the picture of another view.
    if (viewers_->filling != this && picture->covered < 1) return py::none();
    viewers_->filling = this;
    last_ = withoutShader(shownCamera());
  }
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
      py::array_t<uint8_t>({picture->shownHeight, picture->shownWidth, 3}, bytes->data(), owner),
      facts);
}

namespace {

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
                    parameter("background", &A::background), parameter("isa", &A::isa),
                    parameter("exact_shapes", &A::exactShapes), parameter("studio", &A::studio),
                    parameter("point_size", &A::pointSize), parameter("line_width", &A::lineWidth)),
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
