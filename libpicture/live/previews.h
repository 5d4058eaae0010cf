// previews.h: Keeps the accumulated frames of each viewer whose previews are rebuilt. A
// Reconstruction needs to know how far things have moved since the last frame that was added to it.
// RT_MOTION tells how far since the viewer's last frame in the context (RT_VIEW), which may have
// been cancelled or a still one. The numbers of a WorldStep decide whether both frames show the
// same world. Owned by a LiveRenderer. [the render thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "libpicture/live/oidn_lender.h"
#include "libpicture/live/recent_viewers.h"
#include "libpicture/live/reconstruction.h"

namespace picture::live {

// Two states of the world: that of the viewer's frame before in the same context, and that of this
// frame. Equal numbers mean that nothing has moved in between.
struct WorldStep {
  uint64_t before = 0; // 0: there was no frame that RT_MOTION could refer to
  uint64_t now = 0;
};

// Numbers the states of the world in a context.
class WorldSteps {
 public:
  // Notes that the next frame shows the world after changes.
  void change() { ++now_; }
  // Notes that the next frame shows another world, or the world in another context.
  void beginAnew() {
    ++now_;
    shown_ = {};
  }
  // Notes that a frame for a viewer has begun.
  WorldStep begin(uint32_t viewer) { return {std::exchange(shown_.of(viewer), now_), now_}; }

 private:
  uint64_t now_ = 1;
  RecentViewers<uint64_t> shown_; // the world of each viewer's last frame
};

class Previews {
 public:
  // threads: 0: as many as the process may use.
  explicit Previews(int threads, Denoiser denoiser = Denoiser::own,
                    OidnLender::Find find = OidnLibrary::find)
      : threads_(threads), oidn_(denoiser, threads, find) {}

  // Adds a frame to what its viewer has accumulated and returns the rebuilt picture. Begins anew if
  // the world has changed since the viewer's last preview by more than the frame's RT_MOTION says.
  // If an exception leaves it, the viewer's accumulated frames are gone.
  // denoising: seconds that Denoiser::automatic may take. shown: as in Reconstruction::add().
  Picture rebuild(uint32_t viewer, const Picture& frame, const FrameCamera& camera, int lightStride,
                  const WorldStep& step, double denoising = 0, ShownSize shown = {});
  // Returns the seconds of the last preview that the size of the shown picture took.
  double showing() const { return showing_; }
  // Returns the name of the library that has filtered the last preview; "": none has.
  const std::string& denoisedBy() const { return denoisedBy_; }
  // Returns, once, why a denoiser that was asked for is not used.
  std::string takeProblem() { return oidn_.takeProblem(); }
  // Frees what a viewer has accumulated.
  void forget(uint32_t viewer) { viewers_.forget(viewer); }
  void forgetAll() { viewers_ = {}; }

  size_t viewers() const { return viewers_.size(); }

 private:
  struct Viewer {
    std::unique_ptr<Reconstruction> reconstruction;
    uint64_t world = 0; // the world of its last preview
    DenoiseSwitch denoised;
  };

  int threads_;
  OidnLender oidn_;
  std::string denoisedBy_;
  double showing_ = 0;
  RecentViewers<Viewer> viewers_;
};

} // namespace picture::live
