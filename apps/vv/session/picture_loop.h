// picture_loop.h: Decides when the next frame of a running world is started, continued or
// cancelled, and how large it is. It owns the renderer. Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <optional>

#include "libpicture/live.h"
#include "options/options.h"
#include "session/fit.h"
#include "session/pacing.h"
#include "session/pilot.h"
#include "session/still.h"

namespace vv {

class PictureLoop {
 public:
  // start() alone makes the transitions: to moving when something has changed, from moving to
  // refining when nothing changes any more.
  enum class Phase : uint8_t {
    unstarted, // no frame has been started
    moving,    // the last frame is one of a sequence: small enough for the frame rate
    refining   // the last frame fills the window and gets all samples
  };

  // The browser and the options must outlive the loop.
  PictureLoop(xvrml::Browser& browser, const Options& options);

  void resize(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }

  // Starts the next frame or cancels the one in flight, if that is due. now: time of any clock.
  void advance(const Pilot& pilot, Fit& fit, double now);
  // Places the viewer for a fit after its frame has read the world. Returns false if no fit waits
  // for that.
  bool placeViewer(Pilot& pilot, Fit& fit) const;
  // Returns a newer picture than the last one; false if there is none.
  bool look(picture::LivePicture& picture);
  // Copies the picture for a file. Returns false before the first frame.
  bool copy(picture::Picture& picture) {
    return shown_ == Shown::something && renderer_.copy(picture);
  }
  // Asks for a picture of its own for a program; the frames wait meanwhile. takeStill() returns it
  // once it is finished.
  void requestStill(const Still& still) { still_.request(still); }
  std::optional<StillAnswer> takeStill() { return still_.take(); }
  bool stillWaits() const { return still_.isBusy() && !still_.isRendering(); }
  // Says whether anybody looks at the pictures. If not, only the first frame, which places the
  // viewer, and still pictures are rendered.
  void setWatched(bool watched) { watched_ = watched; }
  void cancel() { renderer_.cancel(); }
  std::string takeFailure() { return renderer_.takeFailure(); }

  bool hasStarted() const { return phase_ != Phase::unstarted; }
  bool hasShown() const { return shown_ != Shown::nothing; }
  bool isMoving() const { return phase_ == Phase::moving; }
  // The world is being read, so that nothing else may use it.
  bool isMapping() const { return renderer_.state() == RendererState::mapping; }
  bool isIdle() const { return renderer_.state() == RendererState::idle; }
  // Tells whether something moves and the next frame must wait for the current one.
  bool isDrawing() const;
  // Tells whether the picture shows the world as it is now, with all samples.
  bool isFinished(const Pilot& pilot) const;
  // The frames per second while something moves; 0: nothing moves.
  double frameRate() const { return isMoving() && gap_ > 0 ? 1 / gap_ : 0; }
  const picture::LivePicture& facts() const { return facts_; } // state without the pixels

 private:
  using RendererState = picture::LiveRenderer::State;
  enum class Shown : uint8_t {
    nothing,
    something,
    still // something before, and then a still picture, which the renderer's copy holds
  };
  enum class Decision : uint8_t { wait, cancel, move, refine };

  // Tells whether the last frame does not show the world as it is now.
  bool isOutdated(const Pilot& pilot, const Fit& fit) const;
  Decision decide(bool outdated, const Fit& fit) const;
  void start(Phase phase, const Pilot& pilot, Fit& fit, double now);
  picture::View viewOf(const Pilot& pilot, const Fit& fit) const;
  picture::View stillViewOf(const Pilot& pilot, double aspect) const;
  void advanceStill(const Pilot& pilot, Fit& fit);
  void followHeadlight(const Pilot& pilot);

  xvrml::Browser& browser_;
  const Options& options_;
  picture::LiveRenderer renderer_;
  StillTaker still_{renderer_};
  Pacing pacing_;
  int width_ = 0, height_ = 0; // size of the window in pixels

  Phase phase_ = Phase::unstarted;
  Shown shown_ = Shown::nothing;
  bool watched_ = true;
  // The camera, headlight and size of the last frame.
  xvrml::CameraSettings camera_{};
  std::optional<bool> headlight_;
  FrameSize frame_;
  // start of the last frame; smoothed time between frames while something moves
  double lastStart_ = 0, gap_ = 0;
  picture::LivePicture facts_; // state of the picture, without the pixels
};

} // namespace vv
