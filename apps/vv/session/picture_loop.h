// picture_loop.h: Decides when the next frame of a viewer of a running world is started, continued
// or cancelled, how large it is, and whether it is a preview or a still picture. The loops of
// several viewers share a renderer. Owned by a viewer of a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <optional>

#include "libpicture/live.h"
#include "libpicture/live/pacing.h"
#include "options/options.h"
#include "session/fit.h"
#include "session/pilot.h"
#include "session/shared_renderer.h"
#include "session/still.h"

namespace vv {

// Wide because the session, the window, the page and programs ask for different facts of one state.
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
  // Says what is shown while something moves.
  enum class Motion : uint8_t {
    rebuilt, // previews
    samples  // the samples as they are
  };
  // Whether a file waits for the still picture of the world as it is now.
  enum class Need : uint8_t { none, stillPicture };

  // How much a frame is needed: not at all, because the picture could be better, or because it does
  // not show the world as it is now.
  enum class Urgency : uint8_t { nothing, quality, change };

  // The renderer and the options must outlive the loop. viewer: the number of its frames.
  PictureLoop(SharedRenderer& shared, const Options& options, uint32_t viewer);

  void resize(int width, int height);
  uint32_t viewer() const { return viewer_; }
  int width() const { return width_; }
  int height() const { return height_; }
  // Bounds the pixels of previews, whose accumulated frames take much more memory than pictures.
  void setMostPreviewPixels(double pixels) { mostPreviewPixels_ = pixels; }
  void setMotion(Motion motion) { motion_ = motion; }
  Motion motion() const { return motion_; }

  Urgency urgency(const Pilot& pilot, const Fit& fit) const;
  // Starts the next frame or cancels the one in flight, if that is due. Where there are several
  // loops, the one with the greatest urgency is called. now: time of any clock.
  void advance(const Pilot& pilot, Fit& fit, double now, Need need);
  // Places the viewer for a fit after its frame has read the world. Returns false if no fit waits
  // for that.
  bool placeViewer(Pilot& pilot, Fit& fit) const;
  // Returns a frame of the present view with all samples, and the headlight of this view.
  picture::LiveFrame stillOf(const Pilot& pilot) const;
  xvrml::MapOptions::Headlight headlightOf(const Pilot& pilot) const;
  picture::ViewTransform transformOf(const Pilot& pilot) const;
  // Notes a picture of this viewer that the renderer has returned. Returns whether it is shown.
  bool note(const picture::LivePicture& picture);
  // Notes that the renderer has no still picture any more.
  void loseStill() { isStillLost_ = true; }
  // Copies the picture of the last frame that was started, for a file. Returns false unless it is a
  // still one with samples everywhere, or for a moment while it ends.
  bool copyStill(picture::Picture& picture);
  // Lets frames have the channels that copyStill() needs for a reading of pixels, too: `now` makes
  // the present picture anew if it does not have them, `later` waits for the next one.
  enum class Readings : uint8_t { now, later };
  void wantReadings(Readings when);
  // Tells whether the last frame has them, or is about to.
  bool isReadable() const { return isReadable_; }
  // Asks for a picture of its own for a program; the frames wait meanwhile. takeStill() returns it
  // once it is finished. One at a time.
  void requestStill(const Still& still) { taker_.request(still); }
  std::optional<StillAnswer> takeStill() { return taker_.take(); }
  bool stillWaits() const { return taker_.isBusy() && !taker_.isRendering(); }
  // Says whether anybody looks at the pictures. If not, only the first frame, which places the
  // viewer, and still pictures are rendered.
  void setWatched(bool watched) { watched_ = watched; }
  // Looks for the end of such a picture. Returns whether one is being rendered.
  bool lookForStill();
  std::string takeFailure();

  bool hasStarted() const { return phase_ != Phase::unstarted; }
  bool hasShown() const { return shown_ != Shown::nothing; }
  bool isMoving() const { return phase_ == Phase::moving; }
  bool isRefining() const { return phase_ == Phase::refining; }
  // Tells whether something moves and the next frame must wait for the current one.
  bool isDrawing() const;
  // Tells whether a frame can be started now without keeping to the frame rate: the one before was
  // cancelled for it, or the motion has ended.
  bool isDue() const { return shared_.isIdle() && (cancelled_ || phase_ == Phase::settling); }
  // Tells whether the last frame does not show the world as it is now.
  bool isOutdated(const Pilot& pilot, const Fit& fit) const;
  // Tells whether the last frame that was started is a still one with samples everywhere.
  bool hasStill() const { return isRefining() && still_ != Progress::none; }
  // Tells whether the still frame was cancelled for another viewer's.
  bool isInterrupted() const;
  uint64_t number() const { return number_; } // the number of the last frame
  // Tells whether the still picture of the world as it is now has all its samples.
  bool isFinished(const Pilot& pilot) const;
  // Returns for how long something has moved without a rest, in seconds.
  double movingFor() const { return isMoving() ? lastStart_ - motionBegan_ : 0; }
  // Returns the frames per second while something moves; 0: nothing moves.
  double frameRate() const { return isMoving() && gap_ > 0 ? 1 / gap_ : 0; }
  const picture::LivePicture& facts() const { return facts_; } // state without the pixels

 private:
  using RendererState = picture::LiveRenderer::State;
  enum class Shown : uint8_t { nothing, something };
  enum class Decision : uint8_t { wait, cancel, move, settle, refine };
  // Says how much there is of the still frame that was started last.
  enum class Progress : uint8_t { none, covered, finished };

  Decision decide(bool outdated, const Fit& fit, double now, Need need) const;
  bool isSettled(double now) const;
  void start(Phase phase, const Pilot& pilot, Fit& fit, double now);
  picture::FrameSize sizeOf(Phase phase);
  int previewSide(int side) const; // the side of a preview as large as may be
  picture::View viewOf(const Pilot& pilot, const Fit& fit) const;
  picture::View stillViewOf(const Pilot& pilot, double aspect) const;
  void advanceStill(const Pilot& pilot, Fit& fit);
  void followHeadlight(const Pilot& pilot);

  SharedRenderer& shared_;
  picture::LiveRenderer& renderer_;
  const Options& options_;
  const uint32_t viewer_;
  StillTaker taker_{renderer_};
  picture::Pacing pacing_;
  int width_ = 0, height_ = 0;   // size of the window in pixels
  double mostPreviewPixels_ = 0; // 0: there is no bound
  Motion motion_ = Motion::rebuilt;

  Phase phase_ = Phase::unstarted;
  Shown shown_ = Shown::nothing;
  bool watched_ = true;
  Progress still_ = Progress::none;
  bool isStillLost_ = false; // the renderer has another still frame, of a program
  bool cancelled_ = false;   // the last frame was cancelled for a newer one
  bool isBehind_ = false;    // the last preview lacks changes of the world that are being built
  // The last frame: its number, the state of the world, the cancellations before it, the camera,
  // headlight and size.
  uint64_t number_ = 0, world_ = 0, cancellations_ = 0;
  xvrml::CameraSettings camera_{};
  std::optional<bool> headlight_;
  uint32_t readings_ = 0;             // channels beside those of the settings
  bool isReadable_ = false;           // the frame has these channels
  double exposure_ = 0;               // the exposure of the pilot
  std::optional<double> falseColour_; // the scale of the pilot
  picture::FrameSize frame_;
  // Start of the last frame; end of settling; smoothed time between frames while something moves.
  double lastStart_ = 0, motionBegan_ = 0, settlingEnds_ = 0, gap_ = 0;
  picture::LivePicture facts_; // state of the picture, without the pixels
  std::string failure_;        // the last failure that was told; "": a picture has come since
};

} // namespace vv
