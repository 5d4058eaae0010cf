// stage.h: Owns what is rendered and how: one OpenRT context, the mapper that fills it from a
// world, and the settings of its frames. The renderers (renderer.cpp, live.cpp) own one each and
// give the context its own thread. Changes of a running world are collected as WorldChanges on the
// browser's thread and passed to the context's thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "libpicture/luminaires.h"
#include "libpicture/measure.h"
#include "libpicture/renderer.h"

namespace picture {

// Changes of a world since the last call. They hold references to nodes, so use and release them
// only while the browser is at rest.
struct WorldChanges {
  bool otherWorld = false;
  xvrml::FieldChanges changes;
  xvrml::BoundNodes bound;
  xvrml::CameraSettings camera;
};

class Stage {
 public:
  // browser may be null: the world is static. The constructor creates no context.
  Stage(xvrml::World& world, xvrml::Browser* browser, const RenderSettings& settings);
  ~Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  RenderSettings settings; // may be changed between frames
  // false, before open(): lightsamples=off of rtNewContext
  bool lightSamples = true;

  // --- On the browser's thread ---
  //
  // Takes the changes since the last call.
  WorldChanges collectChanges();
  // Adds the engine's messages since the last call to the world's diagnostics.
  void reportMessages();
  // Adds a message to them. [any thread]
  void warn(std::string text);

  // --- On the context's thread ---
  //
  // Creates the context and the mapper; throws RenderError. While other renderers use the cluster,
  // it calls `stop` and gives up when that returns true.
  void open(const std::function<bool()>& stop = {});
  // Ends the context. Returns why a recording is incomplete; empty if it is complete. leaveMapper:
  // gives up the mapper without destroying it; no other mapper may use the context then.
  std::string close(bool leaveMapper = false);
  // patient: large meshes that appear may come with a later call (OpenRTMapper::setPatient).
  void apply(const WorldChanges& worldChanges, bool patient = false);
  // Returns the camera of a view. The default is the viewer of a running world.
  xvrml::CameraSettings cameraOf(const View& view) const;
  // Returns whether the view leaves out the first Viewpoint (camera.h).
  bool leavesViewpointOut(const View& view) const;
  // Places the camera of a view.
  void place(const View& view);
  // Does this, and maps the world for the view.
  void prepare(const View& view);
  // Draws the world as the camera has been placed, by the z-buffer. Throws RenderError.
  void rasterize(Picture& picture) const;
  // Maps the world for sensors, as it is for a view.
  void prepareSensors(const View& view);
  // Returns the sensors of the world. Throws SensorError. [after prepareSensors]
  std::vector<PlacedSensor> placeSensors() const;
  // Returns the luminaires of the world. [after prepareSensors]
  std::vector<Luminaire> luminaires() const;
  // Reads sensors, one after the other, which share the time limit. Ends early when cancelled
  // becomes true. [after prepareSensors]
  std::vector<Measurement> measure(const std::vector<PlacedSensor>& sensors, RenderSettings frame,
                                   const std::atomic<bool>& cancelled);
  // Sets size, channels and quality of the next frame, from the settings or from others.
  void setUpFrame() { setUpFrame(settings); }
  void setUpFrame(const RenderSettings& frame);
  // Reads the channels of the finished frame, which had these settings. The names are left as they
  // are: a picture has those at the start of its frame.
  void readChannels(const RenderSettings& frame, Picture& picture) const;
  // Adds the statistics of the finished frame, but not those of the mapper.
  void describe(const RenderSettings& frame, RenderResult& result) const;
  const xvrml::CameraSettings& shown() const { return shown_; } // camera of the last prepare()
  const xvrml::OpenRTMapper* mapper() const { return mapper_.get(); }
  double takeMeshSeconds(); // seconds spent constructing mappers since the last call

  // --- On any thread ---
  RTcontext context() const { return context_; } // null before open()
  // Cancels the frames in flight, if there is a context.
  void cancel();
  // Copies the finished part of the channels of the frame in flight; returns false if there is
  // none. The settings must be those of the frame, and the mapper must be idle.
  bool snapshot(Picture& picture, uint32_t channels) const;

 private:
  void makeMapper();
  bool showsBackground() const;
  void useEnvironment();
  void readBackground();
  Measurement measure(const PlacedSensor& sensor, const RenderSettings& frame,
                      const std::atomic<bool>& cancelled);
  void rate(const std::vector<Luminaire>& luminaires, Measurement& m) const;
  std::vector<Luminaire> glaringLuminaires(const PlacedSensor& sensor) const;
  static void note(RTenum error, const char* message, void* self);
  static void listen(int level, const char* text, void* self);

  xvrml::World* world_;     // the world that is rendered; with a browser, the one that it runs
  xvrml::Browser* browser_; // null: the world is static
  std::unique_ptr<xvrml::OpenRTMapper> mapper_;
  std::atomic<RTcontext> context_{nullptr};
  std::mutex closingMutex_; // other threads use the context under it, and close() takes it away
  double meshSeconds_ = 0;
  bool pluginMissing_ = false, memoryExhausted_ = false;
  RTid environment_ = 0, environmentTexture_ = 0;
  xvrml::Axis up_ = xvrml::Axis::y; // for observers of glare
  StudioSet studio_;
  BackgroundLayer backgroundLayer_{{}, true}; // drawn behind the frames, as `background_` says
  Background background_;
  xvrml::CameraSettings shown_{};
  std::optional<View::Pinhole> pinhole_; // replaces the matrix and the angle of shown_
  bool borrowed_ = false;                // the context belongs to the cluster
  // viewer of a running world, if a Viewpoint is bound
  std::optional<xvrml::CameraSettings> viewer_;
  std::optional<xvrml::BoundNodes> bound_; // the bound nodes of a running world
  uint64_t generation_ = 0; // generation of the browser's world that the mapper shows
  std::mutex messagesMutex_;
  std::vector<std::string> messages_;
};

void throwOnError(const char* doing);

// Returns the part of a context's configuration that does not concern the backend: " threads=...".
std::string contextConfiguration(const RenderSettings& settings);
// Calls rtNewContext. Throws RenderError.
RTcontext newContext(const std::string& configuration);

} // namespace picture
