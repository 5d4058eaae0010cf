// session.h: a world that is being looked at: its browser, its pilot, and the renderer that draws
// it while both go on. It knows no windowing system. Another world is another session. [the
// browser's thread]
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

// What the overlay tells of a session.
struct SessionFacts {
  double frameRate = 0; // pictures a second while something moves; 0: nothing does
  int width = 0, height = 0;
  double samples = 0, wanted = 0;
  RTstats stats{}; // of the last picture that was finished
  xvrml::MapStats map{};
  uint64_t errors = 0, warnings = 0;
  std::string lastProblem, navigation, description;
  bool loading = false, finished = false, cluster = false;
  std::vector<RTworker> workers; // of a cluster
};

class Session {
 public:
  struct Place { // where the viewer of another session was
    std::string viewpoint;
    xvrml::CameraSettings camera;
  };
  struct Calls {
    std::function<void(const InputEvent&, Action)> business; // what the keys ask of the window
    // Worlds that Anchors and Scripts ask for.
    std::function<void(const std::vector<std::string>& urls, const std::string& base)> openUrl;
    std::function<void(double time, const InputEvent&)>
        record; // what the user has done; null: nobody wants to know
  };
  // script: events instead of the user's; null: none. Throws as startWorld does.
  Session(std::unique_ptr<xvrml::World> world, const Options& options, Problems& problems,
          Calls calls, const InputScript* script);
  ~Session();

  // Where the first picture is taken from: as the options say, where another session was, or from
  // the fragment of a URL.
  void begin(int width, int height, const std::optional<Place>& place, const std::string& fragment);
  void resize(int width, int height);
  void handle(const InputEvent& event) { waiting_.push_back(event); }
  // Time passes: events, the world's clock, what is left to be loaded, and the next frame. seconds:
  // on any clock. Never waits.
  void advance(double seconds);
  // A newer picture than the last one; false if there is none.
  bool look(picture::LivePicture& picture);
  // What the picture has so far, into a file. Returns what there is to tell.
  std::string save(const std::string& path);
  // Writes the picture as soon as all its samples are taken; the script waits until then.
  void saveWhenFinished(const std::string& path) { saveTo_ = path; }

  bool resting() const {
    return !preparing_ && renderer_.state() != picture::LiveRenderer::State::mapping;
  } // the world can be used
  // Something that moves, and the next frame has to wait for it.
  bool drawing() const {
    const auto state = renderer_.state();
    return moving_ && (state == picture::LiveRenderer::State::mapping ||
                       state == picture::LiveRenderer::State::rendering);
  }
  bool scripted() const { return replay_ != nullptr; }
  double time() const { return time_; } // of the session's clock, at the last step
  xvrml::Browser& browser() { return *browser_; }
  const Pilot& pilot() const { return pilot_; }
  Place place() const;
  std::string command(const std::vector<std::string>& arguments) const;
  SessionFacts facts() const;
  std::string takeMessage();
  // The frame in flight ends; false if it still reads the world after this time.
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
  Calls calls_;
  std::unique_ptr<xvrml::Browser> browser_;
  Pilot pilot_;
  picture::LiveRenderer renderer_;
  const uint32_t channels_; // of pictures that are saved
  Pacing pacing_;
  std::unique_ptr<Replay> replay_;
  std::deque<InputEvent> waiting_;

  // Time.
  bool stepped_; // in steps of 1/fps, for scripts
  long long next_ = 0;
  double clock_ = 0, time_ = 0, last_ = -1;

  // The picture.
  int width_ = 0, height_ = 0;
  enum class Fit : uint8_t {
    none,
    wanted,
    mapping
  } fit_ = Fit::none;        // the whole world in view, once its extent is known
  bool fitAsAtFirst_ = true; // as the world begins; false: in the direction of now
  bool fitAgain_ = false;    // the picture still shows it all, and more is loaded
  xvrml::CameraSettings shown_{};
  std::optional<bool> shownHeadlight_;
  bool begun_ = false, moving_ = false, refined_ = false, shownAny_ = false;
  FrameSize frame_;                // in flight, or the last one
  double lastStart_ = 0, gap_ = 0; // of frames while something moves, smoothed
  picture::LivePicture facts_;     // without the pixels
  std::string saveTo_, message_;
  std::deque<xvrml::NodeRef> inlines_; // to be loaded
  uint64_t generation_ = 0;            // of the browser's world that they are in
  // What the pointer and the viewer's feet meet is made ready beside the first picture.
  std::thread preparer_;
  std::atomic<bool> preparing_{false};
  bool prepared_ = false;
};

} // namespace vv
