// viewer.h: Declares the C++ side of the Python class Viewer: one view of a running world, with a
// camera of its own, whose pictures are rendered while Python goes on. xvrml/_live.py decides when
// a frame begins and what input means; xvrml/notebook.py shows the pictures. The views of a world
// share one LiveRenderer and take turns. [GIL held; released for long operations]
#pragma once

#include <optional>
#include <vector>

#include "libpicture/bare_model.h"
#include "libpicture/live/pacing.h"
#include "objects.h"
#include "render_request.h"

class Viewer;

// The open views of a world, and what they share.
struct Viewers {
  picture::RenderSettings settings; // each view has its own size and samples
  std::vector<Viewer*> open;
  Viewer* drawing = nullptr;  // began the last frame
  Viewer* filling = nullptr;  // the renderer fills gaps of unfinished pictures from this view's
  Viewer* steering = nullptr; // moves the browser's viewer; the cameras of the others stay
  uint64_t changes = 0;       // number of frames that began because the world had changed
  uint64_t generation = 0;    // generation of the browser's world
  picture::Look look = picture::Look::own; // look of the world when the first view was opened
  uint32_t numbers = 0;                    // number of views opened so far
};

struct ViewerArguments : RenderArguments {
  WorldPtr world;
};

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
  bool navigate(const xvrml::NavigationInput& input, double seconds);
  bool press(xvrml::Key key);
  bool bind(const py::object& viewpoint);
  bool frameAll();
  py::object camera();
  double fovy();
  xvrml::Navigation navigation() const { return browser().navigation(); }
  void setNavigation(xvrml::Navigation kind);

  py::object onChange = py::none(); // called when the world has changed; None: nobody

 private:
  const picture::LiveRenderer* live() const { return world_->locks->live.get(); }
  xvrml::Browser& browser() const { return *world_->running; }
  double aspect() const { return double(width_) / height_; }
  std::optional<xvrml::CameraSettings> ownCamera() const;
  std::optional<xvrml::CameraSettings> knownCamera() const;
  bool followsBrowser() const;
  picture::View view() const;
  std::optional<xvrml::CameraSettings> shownCamera() const;
  void freezeOthers();
  bool steer();
  void followGeneration();
  void makeRenderer();

  WorldPtr world_;
  std::shared_ptr<Viewers> viewers_; // null: closed
  uint32_t number_ = 0;
  int width_ = 1, height_ = 1, samples_ = 1;
  picture::View asked_; // the view of the arguments, until the user steers
  // The camera since another view began to steer, and the angle of view that the browser's viewer
  // does not have.
  std::optional<xvrml::CameraSettings> frozen_;
  std::optional<double> fovy_;
  std::optional<xvrml::CameraSettings> last_; // the camera of the last picture
  static constexpr double framesPerSecond = 30;
  picture::Pacing pacing_{framesPerSecond};
  picture::Pacing::Light light_ = picture::Pacing::Light::sparse; // until the first picture tells
  // The last frame that began.
  bool begun_ = false, moving_ = false, wasOutdated_ = true;
  bool isBehind_ =
      false; // the last preview lacks changes that are being built (LivePicture::outdated)
  picture::FrameSize frame_;
  uint64_t frameChanges_ = 0;
  std::optional<xvrml::CameraSettings> frameCamera_;
};

// Removes the ORTShader of a camera that is kept: nothing would keep the node.
std::optional<xvrml::CameraSettings> withoutShader(std::optional<xvrml::CameraSettings> camera);
