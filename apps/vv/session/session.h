// session.h: Owns a world that is shown, in the window or on a page, and connects the parts that
// work on it: the browser and its pilot, the clock, the picture loop, the Inlines and the fit. The
// states are in the parts. It is independent of the windowing system. Each world has its own
// session. The viewer that the world knows has the number 0; guests have others. [the browser's
// thread]
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libpicture/live.h"
#include "options/options.h"
#include "report/problems.h"
#include "session/captures.h"
#include "session/fit.h"
#include "session/guests.h"
#include "session/inline_queue.h"
#include "session/input/step_order.h"
#include "session/pick_preparation.h"
#include "session/picture_loop.h"
#include "session/pilot.h"
#include "session/replay.h"
#include "session/saving.h"
#include "session/session_clock.h"

namespace vv {

// The facts about a session that the overlay shows.
struct SessionFacts {
  enum class Showing : uint8_t {
    still,   // the samples of the world as it is
    fading,  // a still picture of few samples over a preview
    preview, // rebuilt from few samples
    samples  // the few samples themselves
  };
  Showing showing = Showing::still;
  double frameRate = 0;    // pictures per second while something moves; 0: nothing moves
  bool isRestless = false; // the world has moved for seconds, so that previews are all there is
  int width = 0, height = 0;
  double samples = 0, wanted = 0;
  std::string denoisedBy; // the library that has filtered the preview; "": none
  RTstats stats{};        // statistics of the last finished picture
  xvrml::MapStats map{};
  uint64_t errors = 0, warnings = 0;
  std::string lastProblem, navigation, description;
  bool loading = false, finished = false, cluster = false;
  std::vector<RTworker> workers; // workers of the cluster
};

class Session {
 public:
  struct Place { // the viewer's place in another session
    std::string viewpoint;
    xvrml::CameraSettings camera;
  };
  struct Callbacks {
    // receives the keys' actions for the window
    std::function<void(const InputEvent&, Action)> onAction;
    // Opens worlds that Anchors and Scripts request.
    std::function<void(const std::vector<std::string>& urls, const std::string& base)> openUrl;
    // Records the user's input; may be null.
    std::function<void(double time, const InputEvent&)> record;
    // Receives the same as onAction for the keys of guests; null if there are none.
    Guests::OnAction onGuestAction;
  };
  // script: replaces the user's events; may be null. Throws the errors of startWorld.
  Session(std::unique_ptr<xvrml::World> world, const Options& options, Problems& problems,
          Callbacks calls, const InputScript* script);

  // Sets the camera of the first picture: from the options, from another session, or from the
  // fragment of a URL.
  void begin(int width, int height, const std::optional<Place>& place, const std::string& fragment);
  void resize(int width, int height);
  void handle(const InputEvent& event) { waiting_.push_back(event); }
  // Advances the session: events, the world's clock, pending Inlines, and the next frame. seconds:
  // time of any clock. Never waits.
  void advance(double seconds);
  // Returns a newer picture than the last one, of viewer 0; false if there is none.
  bool look(picture::LivePicture& picture);
  // Does the same for all viewers.
  bool look(picture::LivePicture& picture, uint32_t& viewer);

  // Saves the true picture of this instant. If nothing moves, that is the picture as it is so far.
  // Otherwise the world and the viewer are held until its still picture has all samples. A message
  // follows (takeMessage).
  void save(const std::string& path);
  // Saves the picture for a script when all its samples are taken; the script waits until then.
  void saveWhenFinished(const std::string& path);
  // Gives up what save() waits for. Returns false if it waits for nothing.
  bool giveUpSaving();
  // Returns what save() waits for, as a line for the user; "" if it waits for nothing.
  std::string savingText() const;
  // Ends the saving before the session ends: what save() waits for is saved as it is so far, and
  // the last file is complete when it returns. Returns the message about it, which has also been
  // printed.
  std::string endSaving();
  // Waits for the last file, so that its name is taken.
  void finishWriting() { writer_.wait(); }

  // Chooses what is shown while something moves. A number that is no guest's means viewer 0.
  void setMotion(PictureLoop::Motion motion, uint32_t viewer = 0);
  PictureLoop::Motion motion(uint32_t viewer) const { return picturesOf(viewer).motion(); }

  // --- Guests --- [while the world can be used]
  // Adds a guest who stands where viewer 0 stands. viewer: its number, not 0.
  void addGuest(uint32_t viewer, int width, int height);
  void removeGuest(uint32_t viewer);
  bool isGuest(uint32_t viewer) const { return guests_.find(viewer); }
  void resizeGuest(uint32_t viewer, int width, int height);
  // Takes input of viewer 0 or of a guest; that of others is ignored.
  void handleFor(uint32_t viewer, const InputEvent& event);
  // Returns the pilot of a guest; for another number that of viewer 0.
  const Pilot& pilotOf(uint32_t viewer) const;
  // Bounds the pixels of each viewer's previews.
  void setMostPreviewPixels(double pixels);
  // Frees the pictures of all viewers, because nobody looks. Returns false if that cannot be now.
  bool release();
  // Renders the true picture of this instant for a viewer, with all samples. asker: any number, by
  // which it can be given up.
  void capture(uint32_t viewer, uint64_t asker, Captures::Done done);
  void giveUpCapture(uint64_t asker) { captures_.giveUp(asker); }
  double capturedSamples() const { return captures_.samples(); } // so far, mean over the pixels
  // Tells whether nothing moves or is to be done, so that steps may come more slowly.
  bool isQuiet() const;

  // --- For programs (docs/control.md) [while the world can be used] ---
  //
  // Asks for a picture with the bytes of `vv -o`; takeStill() returns it once it is finished.
  void requestStill(const Still& still) { pictures_.requestStill(still); }
  std::optional<StillAnswer> takeStill() { return pictures_.takeStill(); }
  bool stillWaits() const { return pictures_.stillWaits(); } // it begins when the session advances
  // Shows a viewpoint at once. Returns false if there is none of this name or number.
  bool jumpToViewpoint(const std::string& name) { return pilot_.jumpToViewpoint(name); }
  void setPaused(bool paused) { pilot_.setPaused(paused); }
  // Lets the paused world run for some seconds.
  void skip(double seconds) { pilot_.skip(seconds, options_.fps); }
  // Says whether anybody looks at the pictures; if not, none are rendered after the first one.
  void setWatched(bool watched) { pictures_.setWatched(watched); }

  // Returns whether programs may use the world: it is at rest, and not held for a picture.
  bool isFree() const { return resting() && !isSaving(); }

  // Returns whether the world can be used.
  bool resting() const {
    return preparation_.state() != PickPreparation::State::running && !shared_.isMapping();
  }
  // Tells whether something moves and the next frame must wait for the current one.
  bool drawing() const { return pictures_.isDrawing(); }
  // Tells whether advance() should be called soon: a frame can be started that does not wait for
  // the frame rate.
  bool due() const { return pictures_.isDue(); }
  bool moving() const { return pictures_.isMoving(); }
  bool scripted() const { return replay_ != nullptr; }
  double time() const { return clock_.time(); } // time of the session's clock at the last step
  xvrml::Browser& browser() { return *browser_; }
  const Pilot& pilot() const { return pilot_; }
  Place place() const;
  std::string command(const std::vector<std::string>& arguments, uint32_t viewer = 0) const;
  SessionFacts facts(uint32_t viewer = 0) const;
  std::string takeMessage();
  std::string takeMessageOf(uint32_t guest);
  // Cancels the frame in flight. Returns false if it still reads the world after `seconds`.
  bool stop(double seconds);

 private:
  void step();
  void takeEvents();
  void take(const InputEvent& event);
  void takeTurns();
  const PictureLoop& picturesOf(uint32_t viewer) const;
  void loadSome();
  void chooseLookOnce();
  void want(Action fit);
  void settleCamera();
  void saveIfFinished();
  void giveUp(const std::string& why);
  // Tells whether scripts wait: for a fit, or for a picture that is to be saved.
  bool held() const { return fit_.isPending() || isSaving(); }
  bool isSaving() const { return !saveTo_.empty(); }
  Pilot::Keys keysWhileHeld() const {
    return isSaving() ? Pilot::Keys::shared : Pilot::Keys::ofWindow;
  }
  bool isRecording() const { return callbacks_.record && !replay_; }
  // Tells whether an event must wait, or is dropped, while the world is held for a picture.
  enum class Passage : uint8_t { passes, waits, isDropped };
  Passage passageOf(const InputEvent& event) const;
  static void postpone(InputEvent event, std::deque<InputEvent>& later);

  Options options_;
  Problems& problems_;
  Callbacks callbacks_;
  std::unique_ptr<xvrml::Browser> browser_;
  Pilot pilot_;
  SharedRenderer shared_;
  PictureLoop pictures_;
  Guests guests_;
  Captures captures_{shared_};
  const uint32_t channels_; // channels of saved pictures
  SessionClock clock_;
  Fit fit_;
  StepOrder order_;              // the order of the user's events
  double mostPreviewPixels_ = 0; // bound of each viewer's previews; 0: there is none
  std::unique_ptr<Replay> replay_;
  std::deque<InputEvent> waiting_;
  std::string saveTo_, message_; // saveTo_: the file of the finished picture; "": none is wanted
  enum class Saver : uint8_t { script, user };
  Saver saver_ = Saver::script; // who wants that file
  PictureWriter writer_;
  InlineQueue inlines_;
  bool isLookChosen_ = false;
  PickPreparation preparation_; // the last member: its destructor waits for a user of the others
};

} // namespace vv
