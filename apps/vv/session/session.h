// session.h: Owns a world that is shown, in the window or on a page, and connects the parts that
// work on it: the browser and its pilot, the clock, the picture loop, the Inlines and the fit. The
// states are in the parts. It is independent of the windowing system. Each world has its own
// session. [the browser's thread]
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/world_editor.h"
#include "libpicture/live.h"
#include "options/options.h"
#include "report/problems.h"
#include "session/captures.h"
#include "session/inline_queue.h"
#include "session/input/step_order.h"
#include "session/measuring.h"
#include "session/pick_preparation.h"
#include "session/picture_saver.h"
#include "session/replay.h"
#include "session/saving.h"
#include "session/session_clock.h"
#include "session/session_viewers.h"

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
    SessionViewers::OnAction onGuestAction;
  };
  // script: replaces the user's events; may be null. Throws the errors of startWorld.
  Session(std::unique_ptr<xvrml::World> world, const Options& options, Problems& problems,
          Callbacks calls, const InputScript* script);

  // Sets the camera of the first picture: from the options, from another session, or from the
  // fragment of a URL.
  void begin(int width, int height, const std::optional<Place>& place, const std::string& fragment);
  void resize(int width, int height);
  // Takes input of a viewer; that of unknown ones is ignored.
  void handle(const InputEvent& event, uint32_t viewer = 0);
  // Advances the session: events, the world's clock, pending Inlines, and the next frame. seconds:
  // time of any clock. Never waits.
  void advance(double seconds);
  // Returns a newer picture than the last one, of viewer 0; false if there is none.
  bool look(picture::LivePicture& picture);
  // Does the same for all viewers.
  bool look(picture::LivePicture& picture, uint32_t& viewer);

  // The parts that others use directly. [while the world can be used, where they change]
  PictureSaver& saver() { return saver_; }
  SessionViewers& viewers() { return viewers_; }
  Captures& captures() { return captures_; }
  Measuring& measuring() { return measuring_; }
  Pilot& pilot() { return own_.pilot; }
  PictureLoop& pictures() { return own_.pictures; }
  const PictureLoop& pictures() const { return own_.pictures; }
  WorldEditor& editor() { return editor_; }

  // --- [while the world can be used] ---
  // Adds a guest who stands where viewer 0 stands. number: one that no other viewer has, not 0.
  void addGuest(uint32_t number, int width, int height);
  // Frees the pictures of all viewers, because nobody looks. Returns false if that cannot be now.
  bool release();
  // Renders the true picture of this instant for a viewer, with all samples. asker: any number, by
  // which it can be given up. givesWay: see Captures::Request.
  void capture(uint32_t viewer, uint64_t asker, Captures::Done done, bool givesWay = false);
  // Tells whether nothing moves or is to be done, so that steps may come more slowly.
  bool isQuiet() const;

  // Lets the paused world run for some seconds.
  void skip(double seconds) { own_.pilot.skip(seconds, options_.fps); }
  // Returns whether programs may use the world: it is at rest, and not held for a picture.
  bool isFree() const { return resting() && !saver_.isWaiting(); }

  // Returns whether the world can be used.
  bool resting() const {
    return preparation_.state() != PickPreparation::State::running && !shared_.isMapping();
  }
  double time() const { return clock_.time(); } // time of the session's clock at the last step
  xvrml::Browser& browser() { return *browser_; }
  Place place() const;
  std::string command(const std::vector<std::string>& arguments, uint32_t viewer = 0) const;
  SessionFacts facts(uint32_t viewer = 0) const;
  std::string takeMessage();
  // Cancels the frame in flight. Returns false if it still reads the world after `seconds`.
  bool stop(double seconds);

 private:
  void step();
  void takeEvents();
  void take(const InputEvent& event);
  void takeTurns();
  void loadSome();
  void chooseLookOnce();
  void settleCamera();
  // Tells whether scripts wait: for a fit, or for a picture that is to be saved.
  bool held() const { return own_.fit.isPending() || saver_.isWaiting(); }
  Pilot::Keys keysWhileHeld() const {
    return saver_.isWaiting() ? Pilot::Keys::shared : Pilot::Keys::ofWindow;
  }
  bool isRecording() const { return callbacks_.record && !replay_; }
  // Tells whether an event must wait, or is dropped, while the world is held for a picture.
  enum class Passage : uint8_t { passes, waits, isDropped };
  Passage passageOf(const InputEvent& event) const;

  Options options_;
  Problems& problems_;
  Callbacks callbacks_;
  std::unique_ptr<xvrml::Browser> browser_;
  WorldEditor editor_{*browser_, options_.render.shaderPath};
  SharedRenderer shared_;
  SessionViewers viewers_;
  SessionViewer& own_ = viewers_.own();
  Captures captures_{shared_};
  Measuring measuring_{shared_, samplesOfSensors(options_)};
  const uint32_t channels_; // channels of saved pictures
  PictureSaver saver_;
  SessionClock clock_;
  StepOrder order_; // the order of the user's events
  std::unique_ptr<Replay> replay_;
  InlineQueue inlines_;
  bool isLookChosen_ = false;
  PickPreparation preparation_; // the last member: its destructor waits for a user of the others
};

} // namespace vv
