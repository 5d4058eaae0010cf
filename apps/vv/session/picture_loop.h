// picture_loop.h: Decides when the next frame of a viewer of a running world is started, continued
// or cancelled, and how large it is. Owned by a session or its guests. [the browser's thread]
#pragma once

#include <cstdint>
#include <optional>

#include "libpicture/live.h"
#include "options/options.h"
#include "session/fit.h"
#include "session/pacing.h"
#include "session/pilot.h"
#include "session/shared_renderer.h"

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

  // The renderer and the options must outlive the loop. viewer: number for LiveFrame.
  PictureLoop(SharedRenderer& shared, const Options& options, uint32_t viewer);

  void resize(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }

  // What the loop would do if it were alone: make a picture of what has changed, refine the last
  // one, or nothing.
  enum class Need : uint8_t { nothing, refinement, change };
  Need need(const Pilot& pilot, const Fit& fit) const;
  // Starts the next frame or cancels the one in flight, if that is due. Of several loops, those
  // that need the most are called first. now: time of any clock.
  void advance(const Pilot& pilot, Fit& fit, double now);
  // Returns a frame of the viewer's present view with all samples, and its headlight.
  picture::LiveFrame frameFor(const Pilot& pilot) const;
  xvrml::MapOptions::Headlight headlightFor(const Pilot& pilot) const;
  // Places the viewer for a fit after its frame has read the world. Returns false if no fit waits
  // for that.
  bool placeViewer(Pilot& pilot, Fit& fit) const;
  // Notes a picture of this viewer that the renderer has returned. Returns whether it is to be
  // shown.
  bool note(const picture::LivePicture& picture);

  bool hasStarted() const { return phase_ != Phase::unstarted; }
  bool hasShown() const { return shown_ != Shown::nothing; }
  bool isMoving() const { return phase_ == Phase::moving; }
  // Tells whether the last frame is in flight, is refined, and shows the world as it is now.
  bool isRefining(const Pilot& pilot, const Fit& fit) const;
  // Tells whether something moves and the next frame must wait for the current one.
  bool isDrawing() const;
  // Tells whether the picture shows the world as it is now, with all samples.
  bool isFinished(const Pilot& pilot) const;
  // The frames per second while something moves; 0: nothing moves.
  double frameRate() const { return isMoving() && gap_ > 0 ? 1 / gap_ : 0; }
  const picture::LivePicture& facts() const { return facts_; } // state without the pixels

 private:
  using RendererState = picture::LiveRenderer::State;
  enum class Shown : uint8_t { nothing, something };
  enum class Decision : uint8_t { wait, cancel, move, refine };

  // Tells whether the last frame does not show the world as it is now.
  bool isOutdated(const Pilot& pilot, const Fit& fit) const;
  Decision decide(Need need, const Fit& fit) const;
  // Tells whether a frame that is refined was cancelled for another viewer's.
  bool isInterrupted() const;
  void start(Phase phase, const Pilot& pilot, Fit& fit, double now);
  picture::View viewOf(const Pilot& pilot, const Fit& fit) const;
  void followHeadlight(const Pilot& pilot);

  SharedRenderer& shared_;
  picture::LiveRenderer& renderer_;
  const Options& options_;
  const uint32_t viewer_;
  Pacing pacing_;
  int width_ = 0, height_ = 0; // size of the window in pixels

  Phase phase_ = Phase::unstarted;
  Shown shown_ = Shown::nothing;
  // The camera, headlight and size of the last frame.
  xvrml::CameraSettings camera_{};
  std::optional<bool> headlight_;
  FrameSize frame_;
  uint64_t world_ = 0;         // state of the world that the last frame shows
  uint64_t cancellations_ = 0; // of the shared renderer, when the last frame was started
  bool ended_ = false;         // all samples of the last frame are taken
  // start of the last frame; smoothed time between frames while something moves
  double lastStart_ = 0, gap_ = 0;
  picture::LivePicture facts_; // state of the picture, without the pixels
};

} // namespace vv
