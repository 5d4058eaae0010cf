// renderer.h: Renders a world to pictures; a Browser may be running the world. The renderer owns
// one OpenRT context and one mapper on a thread of its own, so the calling thread stays free for a
// progress bar, signals or Python's interrupts. vv and the Python binding call it from one thread
// at a time, the browser's. That thread waits inside the call while the render thread reads the
// world; the render thread never uses the browser itself.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "libpicture/background.h"
#include "libpicture/camera.h"
#include "libpicture/doubt.h"
#include "libpicture/files/picture.h"
#include "libpicture/quality.h"
#include "libpicture/sky/sky.h"
#include "libpicture/studio.h"
#include "openrt/openrt.h"
#include "xvrml/browser.h"
#include "xvrml/mapper.h"

namespace picture {

class Cluster;
class Sums;
class Luminaire;
struct Measurement;

// Says what smooths the light of previews (live/reconstruction.h).
enum class Denoiser : uint8_t {
  own,      // the filter that is always there
  oidn,     // beside it Open Image Denoise 2, a library that may be installed
  automatic // LiveRenderer: that library, too, where it is there and fast enough; Renderer: own
};

// A rectangle of the pixels of a picture, rows from the top; width 0: all.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Crop&) const = default;
};

struct RenderSettings {
  int width = 800, height = 600;
  // Only this part of the picture is made, with the bytes that it has in the whole one. It lies
  // within the picture.
  Crop crop;
  int samples = int(qualityInfo(RT_SAMPLES_PER_PIXEL).defaultValue);
  double error = 0;         // RT_TARGET_ERROR; 0: none
  double timeLimit = 0;     // time limit in seconds (RT_TIME_LIMIT); 0: none
  bool progressive = false; // RT_PROGRESSIVE
  QualityValues quality;    // the other quality settings; its values of the four above are ignored
  int threads = 0;          // 0: as many threads as the process may use
  std::string isa = "auto"; // instruction set of the ray kernels (isa=NAME of rtNewContext)
  bool linear = true;
  ViewTransform view;                  // how files for screens, and screens, show linear light
  bool exactShapes = false;            // value of xvrml::OpenRTMapper::setExactShapes
  double pointSize = 0, lineWidth = 0; // values of xvrml::OpenRTMapper::setThickness
  bool multiplyTextures = false;       // value of xvrml::OpenRTMapper::setMultiplyTextures
  xvrml::MapOptions::Headlight headlight = xvrml::MapOptions::Headlight::automatic;
  uint32_t channels = RT_RGBA;
  std::string backend = "local";
  std::string record;      // file that records the scene edits
  std::string shaderPath;  // folders, separated by colons
  std::string environment; // Environment map (radiance.h) that replaces the world's Background.
  double environmentIntensity = 1;
  std::optional<Sky> sky; // daylight that replaces the world's Background; excludes `environment`
  Background background;  // Every kind except Kind::world excludes the two above.
  Studio studio;          // on: replaces the world's Background; excludes the three above
  // Each picture is rebuilt from its samples and those of the renderer's earlier pictures
  // (live/reconstruction.h). It has only the channel rgba, it is biased, and Picture::note says so.
  // A picture that was interrupted has its samples as they are, and no note. For the frames of one
  // film in their order; Renderer::start says which frame it is.
  bool preview = false;
  // Pictures are drawn by a z-buffer (raster/raster.h) instead of rays, and Picture::note says so.
  // They have the channel rgba alone, and no samples.
  bool raster = false;
  bool keepSums = false; // Renderer::sums() returns the sums of frames
  Denoiser denoiser = Denoiser::own;
  std::shared_ptr<Cluster> cluster; // machines to render with, instead of `backend`; null: none

  // Returns whether an environment replaces the world's Background.
  bool hasSurroundings() const { return !environment.empty() || sky; }
  // The size of the picture that is made.
  int madeWidth() const { return crop.width > 0 ? crop.width : width; }
  int madeHeight() const { return crop.width > 0 ? crop.height : height; }

  bool operator==(const RenderSettings&) const = default;
};

// Tells whether a picture takes long enough to be rendered progressively. Then a picture that is
// saved early shows the whole frame instead of the finished tiles only. This costs no time, but up
// to 320 bytes per pixel. On a cluster it would make many small jobs.
bool isWorthProgressive(const RenderSettings& settings);

// Returns why a part of a picture could not have the bytes of the whole one: "pictures with a
// target error share their samples out as a whole". Empty if it has them, or if no part is asked
// for.
std::string whyNoCrop(const RenderSettings& settings);

struct RenderError : std::runtime_error {
  explicit RenderError(const std::string& text, RTenum engine = RT_NO_ERROR)
      : runtime_error(text), code(engine) {}
  RTenum code; // the engine's error code, or RT_NO_ERROR
};

// Throws RenderError if this machine does not have the instruction set; the message says what was
// expected. Otherwise rendering would fail later.
void checkIsa(const std::string& isa);
// Throws RenderError if this machine does not have what the denoiser needs. The library is tried in
// a child process once.
void checkDenoiser(Denoiser denoiser);

struct RenderResult {
  Picture picture;
  xvrml::MapStats map;
  RTstats stats;
  // A shader plug-in or a texture was not found; the world's diagnostics say which.
  bool missing = false;
  bool interrupted = false; // the picture holds what was finished when it was interrupted
  double mapSeconds = 0, renderSeconds = 0;
  std::optional<Picture> sampled;   // only for previews: the samples as they are
  double denoiseSeconds = 0;        // the time of whoever has denoised the picture; 0: nobody
  std::optional<DoubtCounts> doubt; // only for a denoised picture that was audited
  std::vector<RTworker> workers;    // workers of the cluster at the end of the picture
  xvrml::CameraSettings camera{};   // camera of the picture; its shader is null
  bool hasCameraShader = false;     // a camera shader generated the rays
  // If hasNames(): the Shape nodes, indexed by the channels' numbers; [0] is null. Release them
  // while no thread uses the world.
  std::vector<xvrml::NodeRef> nodes;
};

// Called on the calling thread about 20 times a second with the fraction done. Returning true ends
// the picture early.
using ProgressCallback = std::function<bool(float progress)>;

class Renderer {
 public:
  // Throws RenderError. The world must outlive the renderer and must not change.
  Renderer(xvrml::World& world, const RenderSettings& settings, ProgressCallback watch = {});
  // Renders the world that the browser runs and follows its changes between two calls. The renderer
  // consumes the changes (Browser::takeChanges), so a browser can have only one renderer. The
  // browser must outlive the renderer.
  Renderer(xvrml::Browser& browser, const RenderSettings& settings, ProgressCallback watch = {});
  ~Renderer();
  // Ends the context, as the destructor does. Throws RenderError if the recording that the settings
  // request is incomplete. No other call may follow.
  void close();
  // Ends the context as close() does, but gives up what is known about the shapes of the world
  // without freeing it. For a process that ends: freeing a million shapes takes seconds.
  void leave();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void setProgressCallback(ProgressCallback watch);
  // Changes samples, seed, error, preview, headlight and channels of the following pictures; no
  // other setting may change. Call it between two calls of render().
  void change(const std::function<void(RenderSettings&)>& change);
  const std::vector<xvrml::ViewpointInfo>& viewpoints();
  xvrml::Bounds bounds();
  // Returns the camera that looks as another one does and shows all that is drawn.
  xvrml::CameraSettings cameraAround(const xvrml::CameraSettings& camera, double aspect);
  // The camera and the up axis of a view; no picture is made.
  struct Place {
    xvrml::CameraSettings camera;
    xvrml::Axis up = xvrml::Axis::y;
    std::string reason;   // why this axis is up; "" if a Viewpoint or the view says so
    bool leftOut = false; // the first Viewpoint is left out (View::authored)
  };
  Place placeOf(const View& view);
  // Maps the world for a view without rendering. Problems are added to the world's diagnostics.
  void prepare(const View& view);
  // Describes the objects that the world is rendered as. Call it after prepare() or render().
  std::vector<xvrml::ExplainedObject> explain();
  // Returns the stage of a call that is under way, for the progress callback: "mapping",
  // "building"; "" while a frame is rendered or nothing is done.
  std::string stage() const;
  // Copies the finished part of the frame in flight; called by the progress callback. Returns false
  // if no frame is in flight.
  bool snapshot(Picture& picture);
  // Returns the sums so far of the frame in flight, or else of the last frame; none if they are not
  // kept. The progress callback may call it.
  Sums sums() const;
  // The next frame begins with these sums. Its start throws RenderError if it cannot.
  void continueFrom(const Sums& sums);
  // Throws RenderError. An exception of the progress callback ends the picture and propagates.
  RenderResult render(const View& view);

  // Returns the readings of all ORTSensors, in the order of the file (libpicture/measure.h). The
  // samples and limits are those of the settings; a time limit is shared by the sensors. The view
  // chooses billboards and levels of detail. Throws SensorError if a sensor has wrong fields.
  std::vector<Measurement> measure(const View& view);
  // Returns the lights of the class Luminaire, in the order of the file (libpicture/luminaires.h).
  // [after measure()]
  std::vector<Luminaire> luminaires();

  // Overlapping frames, for settings with a cluster. start() returns when the world is mapped and
  // the frame is under way; the world may then change. finish() waits for the oldest frame. Each
  // frame has the same bytes as from render(). Do not call render() while a frame is in flight.
  // frame: the number of the picture in its film; none: it follows the one before. A preview
  // depends on the frames from live::FilmHistory::firstFor(frame) on, which must have been made in
  // turn.
  void start(const View& view, std::optional<int64_t> frame = {});
  RenderResult finish();
  size_t framesInFlight() const; // number of frames started and not finished
  // Returns how many frames to keep in flight, so that all machines have work and memory stays
  // limited; 1 without a cluster.
  size_t maxFramesInFlight() const;

 private:
  void begin();
  void end();
  void checkViewpoint(const View& view);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns the index of the viewpoint with this DEF name, description or number from 0; -1 if there
// is none.
int findViewpoint(const std::vector<xvrml::ViewpointInfo>& viewpoints, const std::string& name);

} // namespace picture
