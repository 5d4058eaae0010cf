// picture_loop.h: Decides when the next frame of a running world is started, continued or
// cancelled, how large it is, and whether it is a preview or a still picture. It owns the renderer.
// Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <optional>

#include "libpicture/live.h"
#include "libpicture/live/pacing.h"
#include "options/options.h"
#include "session/fit.h"
#include "session/pilot.h"
#include "session/still.h"

namespace vv {

class PictureLoop {
 public:
  // start() alone makes the transitions: to moving when something has changed; from moving to
  // settling and from there to refining when nothing changes any more. A picture that is wanted
  // soon for a file goes to refining at once.
  enum class Phase : uint8_t {
    unstarted, // no frame has been started
    moving,    // the last frame is one of a sequence: small enough for the frame rate
    settling,  // the last frame is a preview of what has just stopped, larger than those before
    refining   // the last frame is a still one: it fills the window and gets all samples
  };
  // What is shown while something moves.
  enum class Motion : uint8_t {
    rebuilt, // previews
    samples  // the samples as they are
  };
  // Whether a file waits for the still picture of the world as it is now.
  enum class Need : uint8_t { none, stillPicture };

  // The browser and the options must outlive the loop.
  PictureLoop(xvrml::Browser& browser, const Options& options);

  void resize(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  void setMotion(Motion motion) { motion_ = motion; }
  Motion motion() const { return motion_; }

  // Starts the next frame or cancels the one in flight, if that is due. now: time of any clock.
  void advance(const Pilot& pilot, Fit& fit, double now, Need need);
  // Places the viewer for a fit after its frame has read the world. Returns false if no fit waits
  // for that.
  bool placeViewer(Pilot& pilot, Fit& fit) const;
  // Returns a newer picture than the last one; false if there is none.
  bool look(picture::LivePicture& picture);
  // Copies the picture of the last frame that was started, for a file. Returns false unless it is a
  // still one with samples everywhere, or for a moment while it ends.
  bool copyStill(picture::Picture& picture);
  // Asks for a picture of its own for a program; the frames wait meanwhile. takeStill() returns it
  // once it is finished. One at a time.
  void requestStill(const Still& still) { taker_.request(still); }
  std::optional<StillAnswer> takeStill() { return taker_.take(); }
  bool stillWaits() const { return taker_.isBusy() && !taker_.isRendering(); }
  // Says whether anybody looks at the pictures. If not, only the first frame, which places the
  // viewer, and still pictures are rendered.
  void setWatched(bool watched) { watched_ = watched; }
  void cancel() { renderer_.cancel(); }
  std::string takeFailure();

  bool hasStarted() const { return phase_ != Phase::unstarted; }
  bool hasShown() const { return shown_ != Shown::nothing; }
  bool isMoving() const { return phase_ == Phase::moving; }
  bool isRefining() const { return phase_ == Phase::refining; }
  // The world is being read, so that nothing else may use it.
  bool isMapping() const { return renderer_.state() == RendererState::mapping; }
  bool isIdle() const { return renderer_.state() == RendererState::idle; }
  // Tells whether something moves and the next frame must wait for the current one.
  bool isDrawing() const;
  // Tells whether a frame can be started now without keeping to the frame rate: the one before was
  // cancelled for it, or the motion has ended.
  bool isDue() const { return isIdle() && (cancelled_ || phase_ == Phase::settling); }
  // Tells whether the last frame does not show the world as it is now.
  bool isOutdated(const Pilot& pilot, const Fit& fit) const;
  // Tells whether the last frame that was started is a still one with samples everywhere.
  bool hasStill() const { return isRefining() && still_ != Progress::none; }
  // Tells whether the still picture of the world as it is now has all its samples.
  bool isFinished(const Pilot& pilot) const;
  // The frames per second while something moves; 0: nothing moves.
  double frameRate() const { return isMoving() && gap_ > 0 ? 1 / gap_ : 0; }
  const picture::LivePicture& facts() const { return facts_; } // state without the pixels

 private:
  using RendererState = picture::LiveRenderer::State;
  enum class Shown : uint8_t { nothing, something };
  enum class Decision : uint8_t { wait, cancel, move, settle, refine };
  // What is there of the still frame that was started last.
  enum class Progress : uint8_t { none, covered, finished };

  Decision decide(bool outdated, const Fit& fit, double now, Need need) const;
  bool isSettled(double now) const;
  void start(Phase phase, const Pilot& pilot, Fit& fit, double now);
  picture::FrameSize sizeOf(Phase phase);
  picture::View viewOf(const Pilot& pilot, const Fit& fit) const;
  picture::View stillViewOf(const Pilot& pilot, double aspect) const;
  void advanceStill(const Pilot& pilot, Fit& fit);
  void followHeadlight(const Pilot& pilot);

  xvrml::Browser& browser_;
  const Options& options_;
  picture::LiveRenderer renderer_;
  StillTaker taker_{renderer_};
  picture::Pacing pacing_;
  int width_ = 0, height_ = 0; // size of the window in pixels
  Motion motion_ = Motion::rebuilt;

  Phase phase_ = Phase::unstarted;
  Shown shown_ = Shown::nothing;
  bool watched_ = true;
  Progress still_ = Progress::none;
  bool isStillLost_ = false; // the renderer has another still frame, of a program
  bool cancelled_ = false;   // the last frame was cancelled for a newer one
  // The number, the camera, headlight and size of the last frame.
  uint64_t number_ = 0;
  xvrml::CameraSettings camera_{};
  std::optional<bool> headlight_;
  picture::FrameSize frame_;
  // Start of the last frame; end of settling; smoothed time between frames while something moves.
  double lastStart_ = 0, settlingEnds_ = 0, gap_ = 0;
  picture::LivePicture facts_; // state of the picture, without the pixels
  std::string failure_;        // the last failure that was told; "": a picture has come since
};

} // namespace vv
