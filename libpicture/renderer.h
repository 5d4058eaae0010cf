// renderer.h: renders a world to pictures: one that stands still, or one that a Browser runs. It
// keeps one OpenRT context and one mapper on a thread of its own, so that the calling thread stays
// free for a progress bar, signals or Python's interrupts. Called by vv and the Python binding, by
// one thread at a time: the browser's. While the render thread reads the world, that thread waits
// in the call; the browser itself is never used from the render thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "libpicture/background.h"
#include "libpicture/camera.h"
#include "libpicture/files/picture.h"
#include "openrt/openrt.h"
#include "xvrml/browser.h"
#include "xvrml/mapper.h"

namespace picture {

class Cluster; // cluster.h

struct RenderSettings {
  int width = 800, height = 600;
  int samples = 16;
  int depth = 25;
  bool shadows = true;
  int transport = RT_TRANSPORT_AUTO;
  double error = 0;         // RT_TARGET_ERROR; 0: none
  double timeLimit = 0;     // seconds; 0: none
  double energyCut = -1;    // RT_ENERGY_CUT; below 0: the engine's own
  double clamp = 0;         // RT_CLAMP; 0: none
  bool progressive = false; // RT_PROGRESSIVE
  int seed = 0;
  int threads = 0; // 0: as many as the process may use
  bool linear = true;
  bool multiplyTextures = false; // xvrml::MapOptions::multiplyTextures
  xvrml::MapOptions::Headlight headlight = xvrml::MapOptions::Headlight::automatic;
  uint32_t channels = RT_RGBA;
  std::string backend = "local";
  std::string record;      // file that keeps the scene edits
  std::string shaderPath;  // folders, separated by colons
  std::string environment; // a picture of radiance (radiance.h) all around, instead of the world's
                           // Background
  double environmentIntensity = 1;
  Background background;            // with any but Kind::world no environment may be given
  std::shared_ptr<Cluster> cluster; // machines to render with, instead of `backend`; null: none

  bool operator==(const RenderSettings&) const = default;
};

// Whether a picture takes long enough to be progressive: what is saved of it before it is finished
// then shows all of it, not only the tiles that are finished. That costs no time, but up to 320
// bytes a pixel; with a cluster it would be many small jobs.
bool worthRounds(const RenderSettings& settings);

struct RenderError : std::runtime_error {
  explicit RenderError(const std::string& text, RTenum engine = RT_NO_ERROR)
      : runtime_error(text), code(engine) {}
  RTenum code; // the engine's, if it is one of these
};

struct RenderResult {
  Picture picture;
  xvrml::MapStats map;
  RTstats stats;
  bool missing =
      false; // a shader plug-in or a texture could not be found; the world's diagnostics say which
  bool interrupted = false; // the picture holds what was finished until then
  double mapSeconds = 0, renderSeconds = 0;
  std::vector<RTworker> workers;  // of a cluster, as they then were
  xvrml::CameraSettings camera{}; // that it was made with; its shader is null
  bool ownRays = false;           // a shader made the rays
  // With the channel RT_NAME: the Shape nodes by the numbers in it, [0] is null. To be given up
  // while the world is at rest.
  std::vector<xvrml::NodeRef> nodes;
};

// Called on the calling thread about 20 times a second with the fraction done; true ends the
// picture early.
using Watch = std::function<bool(float progress)>;

class Renderer {
 public:
  // Throws RenderError. The world must live and stay unchanged as long as the renderer.
  Renderer(xvrml::World& world, const RenderSettings& settings, Watch watch = {});
  // The world that the browser runs, with everything that happens to it between two calls: the
  // renderer takes its changes (Browser::takeChanges), so one renderer a browser. The browser must
  // live as long as the renderer.
  Renderer(xvrml::Browser& browser, const RenderSettings& settings, Watch watch = {});
  ~Renderer();
  // Ends the context, as the destructor does; throws RenderError where the recording that the
  // settings ask for is not whole. No other call may follow.
  void close();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void setWatch(Watch watch);
  // Samples, seed, error, headlight and channels of the following pictures; the rest must stay.
  // Between two calls of render().
  void change(const std::function<void(RenderSettings&)>& change);
  const std::vector<xvrml::ViewpointInfo>& viewpoints();
  xvrml::Bounds bounds();
  // Where a view looks from and which way is up for it, without a picture.
  struct Place {
    xvrml::CameraSettings camera;
    xvrml::Axis up = xvrml::Axis::y;
    std::string reason; // why up is that; "": a Viewpoint or the view says so
  };
  Place placeOf(const View& view);
  // Maps the world for a view without making a picture; problems are in the world's diagnostics.
  void prepare(const View& view);
  // What the world is rendered as; after prepare() or render().
  std::vector<xvrml::ExplainedObject> explain();
  // The picture of the frame in flight as far as it is finished; for the watch to call. False if no
  // frame is in flight.
  bool snapshot(Picture& picture);
  // Throws RenderError. An exception of the watch ends the picture and is passed on.
  RenderResult render(const View& view);

  // Frames that overlap, where the settings have a cluster: start() returns when the world is
  // mapped and the frame under way, and the world may then change; finish() waits for the oldest.
  // Each frame has the bytes that render() gives. Not mixed with render() while a frame is in
  // flight.
  void start(const View& view);
  RenderResult finish();
  size_t flying() const; // started and not finished
  // How many frames may be in flight so that all machines have work, and not too much memory is
  // used: 1 without a cluster.
  size_t overlap() const;

 private:
  void begin();
  void end();
  void checkViewpoint(const View& view);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Index of the viewpoint with this DEF name, description or number from 0; -1 if there is none.
int findViewpoint(const std::vector<xvrml::ViewpointInfo>& viewpoints, const std::string& name);

} // namespace picture
