#include "control/unattended.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "control/control.h"
#include "options/shader_text.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/cluster_report.h"
#include "report/problems.h"
#include "session/ending.h"
#include "session/session.h"
#include "session/world_loader.h"
#include "xvrml/node_plugin.h"

namespace vv::control {

namespace {

using Clock = std::chrono::steady_clock;

class Unattended {
 public:
  explicit Unattended(const Options& options)
      : options_(options), problems_(options_),
        control_(std::make_unique<Control>(
            options_, Host{[this](LoadRequest request) { open(std::move(request)); },
                           [this] { ended_ = true; }})) {
    options_.view.shader = readCameraShader(options_);
  }

  int run() {
    if (!options_.input.empty()) open({{options_.input}, "", {}});
    constexpr double shortest = .002; // while something is under way that tells nobody of its end
    double next = 0;
    while (!ended_ && !interrupted()) {
      const bool busy = control_->isBusy() || loader_.busy() || (session_ && !session_->resting());
      const double rest = std::max(0.0, next - seconds());
      control_->wait(busy ? std::min(rest, shortest) : rest);
      takeWorld();
      if (seconds() >= next) {
        advance();
        next = std::max(next + 1 / options_.fps, seconds());
      }
      if (session_) session_->look(picture_);
      if (control_->serve(session_.get(), loader_.busy()))
        next = std::min(next, seconds() + shortest);
      report();
    }
    return end();
  }

 private:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  void advance() {
    if (!session_) return;
    try {
      session_->advance(seconds());
    } catch (const std::exception& error) { sayError(error.what()); }
  }

  void open(LoadRequest request) {
    request.options = options_.load;
    loader_.begin(std::move(request));
  }

  void takeWorld() {
    if (session_ && !session_->resting()) return; // the old session cannot end yet
    LoadAnswer answer;
    if (!loader_.take(answer)) return;
    const std::shared_ptr<LeftEdits> left = answer.left;
    const auto [wrong, code] = useWorld(
        std::move(answer), [&](std::unique_ptr<xvrml::World> world, const std::string& fragment) {
          begin(std::move(world), fragment, left.get());
        });
    if (wrong.empty()) return;
    sayError(wrong);
    control_->loadFailed(wrong);
    if (hadWorld_ || options_.input.empty()) return;
    failed_ = code; // the world of the command line cannot be used
    ended_ = true;
  }

  void begin(std::unique_ptr<xvrml::World> world, const std::string& fragment, LeftEdits* left) {
    Session::Callbacks calls;
    calls.onAction = [](const InputEvent&, Action) {}; // nobody presses keys
    calls.openUrl = [this](const std::vector<std::string>& urls, const std::string& base) {
      open({urls, base, {}});
    };
    auto fresh =
        std::make_unique<Session>(std::move(world), options_, problems_, std::move(calls), nullptr);
    if (options_.strict && Problems::any(fresh->browser().world()))
      throw Failure{exitProblems, "the world is not used, because of --strict"};
    if (left) fresh->editor().journal().adopt(*left);
    fresh->pictures().setWatched(false);
    fresh->begin(options_.render.width, options_.render.height, {}, fragment);
    control_->detach();
    keepEdits(session_.get());
    session_ = std::move(fresh); // ends the previous session
    session_->editor().journal().look();
    hadWorld_ = true;
  }

  void report() {
    if (options_.render.cluster)
      for (const std::string& line : clusterMessageLines(options_.render.cluster->takeMessages(),
                                                         options_.verbose, options_.quiet))
        say(line);
    if (session_ && session_->resting()) static_cast<void>(session_->takeMessage());
  }

  int end() {
    keepEdits(session_.get());
    const int code = interrupted() ? exitInterrupted : failed_;
    control_.reset(); // sends the last answers, before the process may end
    stopOrExit(session_.get(), code, Control::isWriting() ? Others::work : Others::rest);
    return code;
  }

  Options options_;
  Problems problems_;
  WorldLoader loader_;
  std::unique_ptr<Session> session_; // null: no world has been loaded yet
  std::unique_ptr<Control> control_; // refers to nodes of the session's world
  picture::LivePicture picture_;
  const Clock::time_point start_ = Clock::now();
  int failed_ = exitDone; // exit code of a world that could not be loaded
  bool ended_ = false, hadWorld_ = false;
};

} // namespace

int runUnattended(const Options& options) {
  for (const std::string& refused : xvrml::loadNodePlugins(options.nodePath)) sayWarning(refused);
  deferInterrupt(true, 1); // before clients hear of the address: its socket file must not stay
  Unattended unattended(options);
  return unattended.run();
}

} // namespace vv::control
