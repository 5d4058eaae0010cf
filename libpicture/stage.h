// stage.h: what is rendered and how: one OpenRT context, the mapper that fills it with a world, and
// the settings of its frames. Owned by the renderers (renderer.cpp, live.cpp), each of which has a
// thread for it: the context's. What happens to a running world comes over as News, which are
// collected on the browser's thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "libpicture/renderer.h"

namespace picture {

// What happened to a world since the last call. It holds on to nodes: to be used and given up while
// the browser is at rest.
struct News {
  bool otherWorld = false;
  xvrml::FieldChanges changes;
  xvrml::BoundNodes bound;
  xvrml::CameraSettings camera;
};

class Stage {
 public:
  // browser null: the world stands still. Nothing is made yet.
  Stage(xvrml::World& world, xvrml::Browser* browser, const RenderSettings& settings);
  ~Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  RenderSettings settings; // between frames

  // --- On the browser's thread ---
  News collect();
  // What the engine said meanwhile, into the world's diagnostics.
  void passOn();

  // --- On the context's thread ---
  // The context and the mapper; throws RenderError. stop: asked while a cluster is in use by
  // others; true: give up.
  void open(const std::function<bool()>& stop = {});
  // Ends the context. Returns why a recording is not whole; empty where all is well.
  std::string close();
  void apply(const News& news);
  // Where a view looks from; the viewer of a running world unless another view is asked for.
  xvrml::CameraSettings cameraOf(const View& view) const;
  // Maps the world for a view.
  void prepare(const View& view);
  // The size, channels and quality of the next frame, from the settings.
  void setUpFrame();
  // The channels of the frame that is finished, whose settings these were. names: as they were when
  // it was started; null: as they are.
  void readChannels(const RenderSettings& frame, Picture& picture,
                    const std::vector<std::string>* names = nullptr) const;
  void describe(const RenderSettings& frame, RenderResult& result) const; // statistics of it
  const xvrml::CameraSettings& shown() const { return shown_; }           // by the last prepare()
  const xvrml::OpenRTMapper* mapper() const { return mapper_.get(); }
  double takeMeshSeconds(); // that mappers were made in

  // --- On any thread ---
  RTcontext context() const { return context_; } // null: not yet
  // Channels of the frame in flight as far as it is finished; false: there is none. The settings
  // must be its own, and the mapper at rest.
  bool snapshot(Picture& picture, uint32_t channels) const;

 private:
  void makeMapper();
  void useEnvironment();
  void readBackground();
  void describe(const RenderSettings& frame, Picture& picture, uint32_t channels) const;
  static void note(RTenum error, const char* message, void* self);
  static void listen(int level, const char* text, void* self);

  xvrml::World* world_;     // as it stands; with a browser: the one that it runs
  xvrml::Browser* browser_; // null: the world stands still
  std::unique_ptr<xvrml::OpenRTMapper> mapper_;
  std::atomic<RTcontext> context_{nullptr};
  double meshSeconds_ = 0;
  bool pluginMissing_ = false, memoryExhausted_ = false;
  RTid environment_ = 0, environmentTexture_ = 0;
  Backcloth backcloth_{{}, true}; // what is put behind the frames, as `background_` says
  Background background_;
  xvrml::CameraSettings shown_{};
  bool borrowed_ = false;                       // the context is the cluster's
  std::optional<xvrml::CameraSettings> viewer_; // of a running world, where a Viewpoint is bound
  uint64_t generation_ = 0;                     // of the browser's world that the mapper shows
  std::mutex heardMutex_;
  std::vector<std::string> heard_;
};

void throwOnError(const char* doing);

// What the settings say of a context besides its backend: " threads=...".
std::string contextConfiguration(const RenderSettings& settings);
// rtNewContext. Throws RenderError.
RTcontext newContext(const std::string& configuration);

} // namespace picture
