// session.h: Owns a world that is shown in the window: its browser, its pilot, and the renderer
// that draws it while both continue. It is independent of the windowing system. Each world has its
// own session. [the browser's thread]
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "libpicture/live.h"
#include "options/options.h"
#include "report/problems.h"
#include "window/input/replay.h"
#include "window/pacing.h"
#include "window/pilot.h"

namespace vv {

// The facts about a session that the overlay shows.
struct SessionFacts {
  double frameRate = 0; // pictures per second while something moves; 0: nothing moves
  int width = 0, height = 0;
  double samples = 0, wanted = 0;
  RTstats stats{}; // statistics of the last finished picture
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
  };
  // script: replaces the user's events; may be null. Throws the errors of startWorld.
  Session(std::unique_ptr<xvrml::World> world, const Options& options, Problems& problems,
          Callbacks calls, const InputScript* script);
  ~Session();

  // Sets the camera of the first picture: from the options, from another session, or from the
  // fragment of a URL.
  void begin(int width, int height, const std::optional<Place>& place, const std::string& fragment);
  void resize(int width, int height);
  void handle(const InputEvent& event) { waiting_.push_back(event); }
  // Advances the session: events, the world's clock, pending Inlines, and the next frame. seconds:
  // time of any clock. Never waits.
  void advance(double seconds);
  // Returns a newer picture than the last one; false if there is none.
  bool look(picture::LivePicture& picture);
  // Saves the current state of the picture. Returns a message for the user.
  std::string save(const std::string& path);
  // Saves the picture when all its samples are taken; the script waits until then.
  void saveWhenFinished(const std::string& path) { saveTo_ = path; }

  // Returns whether the world can be used.
  bool resting() const {
    return !preparing_ && renderer_.state() != picture::LiveRenderer::State::mapping;
  }
  // Tells whether something moves and the next frame must wait for the current one.
  bool drawing() const {
    const auto state = renderer_.state();
    return moving_ && (state == picture::LiveRenderer::State::mapping ||
                       state == picture::LiveRenderer::State::rendering);
  }
  bool scripted() const { return replay_ != nullptr; }
  double time() const { return time_; } // time of the session's clock at the last step
  xvrml::Browser& browser() { return *browser_; }
  const Pilot& pilot() const { return pilot_; }
  Place place() const;
  std::string command(const std::vector<std::string>& arguments) const;
  SessionFacts facts() const;
  std::string takeMessage();
  // Cancels the frame in flight. Returns false if it still reads the world after `seconds`.
  bool stop(double seconds);

 private:
  void step(double passed);
  void takeEvents();
  void loadSome();
  void draw();
  void wantFit(bool asAtFirst);
  void start(bool moving);
  void saveIfFinished();
  void prepare();
  bool blocked() const { return fit_ != Fit::none || !saveTo_.empty(); }

  Options options_;
  Problems& problems_;
  Callbacks callbacks_;
  std::unique_ptr<xvrml::Browser> browser_;
  Pilot pilot_;
  picture::LiveRenderer renderer_;
  const uint32_t channels_; // channels of saved pictures
  Pacing pacing_;
  std::unique_ptr<Replay> replay_;
  std::deque<InputEvent> waiting_;

  // --- Time ---
  bool stepped_; // advances in steps of 1/fps, for scripts
  long long next_ = 0;
  double clock_ = 0, time_ = 0, last_ = -1;

  // --- The picture ---
  int width_ = 0, height_ = 0;
  // Tells whether to show the whole world when its extent is known.
  enum class Fit : uint8_t { none, wanted, mapping } fit_ = Fit::none;
  bool fitAsAtFirst_ = true; // true: the initial view; false: the current direction
  // fit again when the Inlines are loaded: the picture shows the whole world so far
  bool fitAgain_ = false;
  xvrml::CameraSettings shown_{};
  std::optional<bool> shownHeadlight_;
  bool begun_ = false, moving_ = false, refined_ = false, shownAny_ = false;
  FrameSize frame_; // size of the frame in flight, or of the last one
  // start of the last frame; smoothed time between frames while something moves
  double lastStart_ = 0, gap_ = 0;
  picture::LivePicture facts_; // state of the picture, without the pixels
  std::string saveTo_, message_;
  std::deque<xvrml::NodeRef> inlines_; // Inlines to load
  uint64_t generation_ = 0;            // generation of the browser's world that contains inlines_
  // Builds the structures for picking and collision in parallel with the first picture.
  std::thread preparer_;
  std::atomic<bool> preparing_{false};
  bool prepared_ = false;
};

} // namespace vv
