// window.cpp: Runs the window's loop: it passes user input to the session and the session's
// pictures to the screen, while worlds are read on another thread.
#include "window/window.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "control/control.h"
#include "libpicture/false_colour.h"
#include "options/shader_text.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/cluster_report.h"
#include "report/progress.h"
#include "session/ending.h"
#include "session/overlay.h"
#include "session/saving.h"
#include "session/session.h"
#include "session/world_loader.h"
#include "session/world_watch.h"
#include "start/world_start.h"
#include "window/editing.h"
#include "window/input_recording.h"
#include "window/screen.h"
#include "window/sound/speaker.h"
#include "xvrml/node_plugin.h"

namespace vv {

namespace {

using Clock = std::chrono::steady_clock;

// Seconds between two steps of a session for the sake of the user's input.
constexpr double inputInterval = 0.004;

class Window {
 public:
  Window(const Options& options, const std::vector<std::string>& arguments)
      : options_(options), arguments_(arguments), problems_(options_),
        screen_("vv", options.render.width, options.render.height), speaker_(mixer_) {
    options_.view.shader = readCameraShader(options_);
    painter_ = std::make_unique<PanelPainter>(int(14 * screen_.scale()));
    deferInterrupt(true, 1); // before clients hear of the address: its socket file must not stay
    if (!options_.control.empty())
      control_ = std::make_unique<control::Control>(
          options_,
          control::Host{[this](const LoadRequest& request) {
                          leaveWorld([this, request] { open(request, request.left != nullptr); },
                                     [this] {
                                       control_->loadFailed("the user keeps this world, whose "
                                                            "edits are not saved");
                                     });
                        },
                        [this] { ended_ = true; }});
  }

  int run();

 private:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  // Waits for events. The wait is short if a picture or a command of a program may be due, and
  // longer if the window is hidden or shows a finished picture, since events end it. It is never
  // nothing: that would take the processor from the picture that is drawn.
  void wait(double time);

  // Tells whether the session advances. next: the time that keeps the frame rate. A moving picture
  // that is almost finished is waited for, since the next one can then begin at once. When nothing
  // moves, the user's input does not wait for the frame rate.
  bool isTime(double time, double next, double period) const;
  void passOn();
  void show();

  // Shows the legend of false colours, in the height of the window.
  void showLegend();

  // Says once of each filter that it has made a preview.
  void sayFilter();
  void advanceSession();

  // --- Worlds ---
  void open(LoadRequest request, bool keepPlace);
  void takeWorld();
  void begin(std::unique_ptr<xvrml::World> world, const std::string& fragment, LeftEdits* left);

  void reload();
  // Goes on at once, or when the user has decided what becomes of edits that are not saved.
  void leaveWorld(std::function<void()> go, std::function<void()> stay = {});

  // --- Keys ---
  void onAction(const InputEvent& event, Action action);

  // A second S gives up what the first one waits for.
  void save(const InputEvent& event, const char* suffix);
  void switchMotion();
  void command();
  void showHelp(bool shown);
  void edit();

  // --- Reports ---
  void message(const std::string& text, double time);
  std::string bottomLine();

  // Reports messages about workers in the terminal; problems also appear in the window.
  void reportClusterMessages();
  void tell();
  void sound();
  int end();

  Options options_;
  const std::vector<std::string>& arguments_;
  Problems problems_;
  Screen screen_;
  Mixer mixer_;
  Speaker speaker_;
  WorldLoader loader_;
  InputRecording recording_{options_.recordInput,
                            [this](const std::string& text) { message(text, 1e9); }};
  std::unique_ptr<PanelPainter> painter_;
  std::unique_ptr<Session> session_;          // null: no world has been loaded yet
  std::unique_ptr<control::Control> control_; // null: no program controls the world
  WorldWatch watch_{options_};
  Questions questions_{screen_};
  Editing editing_{screen_, questions_, arguments_,
                   [this](LoadRequest edits) { open(std::move(edits), true); }};
  uint64_t saves_ = 0; // times that the file of the world has been saved
  picture::LivePicture picture_;
  std::vector<InputEvent> events_, input_;
  const Clock::time_point start_ = Clock::now();
  int width_ = 0, height_ = 0;
  int failed_ = exitDone; // exit code of a world that could not be loaded
  bool ended_ = false, keepPlace_ = false, help_ = false;
  std::set<std::string> filtersSaid_;
  bool first_ = false;            // the first picture of the world is still missing
  double advanced_ = 0;           // when the session advanced last
  std::pair<double, int> legend_; // the end of its scale, 0: there is none, and its height
  PictureLoop::Motion motion_ = PictureLoop::Motion::rebuilt;
  double loadStart_ = 0;

  OverlayLevel level_ = OverlayLevel::brief;
  std::string loading_, message_, bottom_;
  double messageEnds_ = 0, shownAt_ = -1;
  std::vector<std::string> lines_; // those that the overlay shows
  int linesWidth_ = 0;             // the width that they were painted for
};

int Window::run() {
  if (options_.has(Job::edit)) edit();
  if (!options_.input.empty()) open({{options_.input}, "", {}}, false);
  double next = 0;
  while (!ended_ && !interrupted()) {
    const double now = seconds();
    wait(std::max(0.0, next - now));
    passOn();
    takeWorld();
    const double period = 1 / options_.fps, time = seconds();
    if (isTime(time, next, period)) {
      advanceSession();
      next = time < next ? time + period : std::max(next + period, time);
      advanced_ = time;
    }
    if (session_ && session_->look(picture_)) show();
    if (control_) control_->serve(session_.get(), loader_.busy());
    tell();
    screen_.present();
  }
  return end();
}

void Window::wait(double time) {
  const bool soon = session_ && (session_->pictures().isDrawing() || session_->pictures().isDue());
  const bool idle = !session_ || !screen_.visible() || (input_.empty() && session_->isQuiet());
  const double most = idle && !control_ ? .05 : .004;
  const bool isBusy =
      session_ && !session_->saver().isWaiting() &&
      (!input_.empty() || !session_->viewers().own().waiting.empty() || editing_.isBusy());
  const auto mayAsk = [this](const InputEvent& event) {
    return session_ && editing_.mayAsk(session_->editor(), event);
  };
  const auto isHeld = [this] { return session_ && session_->isFree() && editing_.isSearching(); };
  questions_.wait(soon ? .001 : std::min(time, most), mayAsk, isHeld, isBusy, events_);
}

bool Window::isTime(double time, double next, double period) const {
  if (!session_) return false;
  if (time >= next + (session_->pictures().isDrawing() ? period : 0)) return true;
  const bool urgent =
      session_->pictures().isDue() || (!input_.empty() && !session_->pictures().isMoving());
  return urgent && time >= advanced_ + inputInterval;
}

void Window::passOn() {
  for (InputEvent& event : std::exchange(events_, {})) {
    if (help_ && event.kind == InputEvent::Kind::down && event.text == "Escape") {
      showHelp(false);
      continue;
    }
    if (editing_.take(event)) continue;
    if (event.kind == InputEvent::Kind::quit) leaveWorld([this] { ended_ = true; });
    if (event.kind == InputEvent::Kind::open)
      leaveWorld([this, file = event.text] { open({{file}, "", {}}, false); });
    if (event.kind == InputEvent::Kind::quit || event.kind == InputEvent::Kind::open) continue;
    if (session_)
      input_.push_back(std::move(event));
    else if (event.kind == InputEvent::Kind::down)
      onAction(event, actionOf(event));
  }
}

void Window::show() {
  screen_.setPicture(picture_.shownWidth, picture_.shownHeight, picture_.rgb);
  showLegend();
  if (std::exchange(first_, false) && options_.verbose)
    say(fmt::format("vv: first picture{}, {}x{}, after {}", picture_.raster ? " (fast view)" : "",
                    picture_.width, picture_.height, duration(seconds() - loadStart_)));
  if (options_.verbose && picture_.purpose == picture::LiveFrame::Purpose::preview) sayFilter();
}

void Window::showLegend() {
  const std::pair<double, int> legend(picture_.scaleEnd, screen_.height());
  if (std::exchange(legend_, legend) == legend) return;
  if (picture_.scaleEnd <= 0) return screen_.setPanel(Screen::right, Panel());
  const picture::Picture drawn = picture::falseColourLegend(picture_.scaleEnd, screen_.height());
  screen_.setPanel(Screen::right, {drawn.width, drawn.height, picture::displayBytesAlpha(drawn)});
}

void Window::sayFilter() {
  const std::string filter = filterText(picture_.denoisedBy);
  if (filtersSaid_.insert(filter).second) say("vv: previews are " + filter);
}

void Window::advanceSession() {
  if (!session_) return;
  if (screen_.width() != width_ || screen_.height() != height_) {
    width_ = screen_.width();
    height_ = screen_.height();
    session_->resize(width_, height_);
  }
  for (const InputEvent& event : std::exchange(input_, {})) session_->handle(event);
  try {
    session_->advance(seconds());
  } catch (const std::exception& error) { say(fmt::format("vv: error: {}", error.what())); }
  if (session_->isFree()) editing_.update(*session_, seconds());
  if (session_->resting()) {
    screen_.setHand(session_->pilot().overSensor());
    sound();
    if (std::exchange(saves_, session_->editor().saves()) != saves_)
      watch_.follow(session_->browser().world());
    if (watch_.changed(seconds())) reload();
  }
}

void Window::open(LoadRequest request, bool keepPlace) {
  request.options = loadOptionsForShowing(options_);
  keepPlace_ = keepPlace && session_;
  loading_ = request.urls.empty() ? "" : request.urls[0];
  loadStart_ = seconds();
  loader_.begin(std::move(request));
  shownAt_ = -1;
}

void Window::takeWorld() {
  if (session_ && !session_->resting()) return; // the old session cannot end yet
  LoadAnswer answer;
  if (!loader_.take(answer)) return;
  loading_.clear();
  const std::shared_ptr<LeftEdits> left = answer.left;
  const auto [wrong, code] = useWorld(
      std::move(answer), [&](std::unique_ptr<xvrml::World> world, const std::string& fragment) {
        begin(std::move(world), fragment, left.get());
      });
  if (wrong.empty()) return;
  sayError(wrong);
  message(wrong, 1e9);
  if (control_) control_->loadFailed(wrong);
  if (!session_) failed_ = code;
}

void Window::begin(std::unique_ptr<xvrml::World> world, const std::string& fragment,
                   LeftEdits* left) {
  std::optional<Session::Place> place;
  if (keepPlace_) place = session_->place();
  world->options.loadInlines = true;
  Session::Callbacks calls;
  calls.onAction = [this](const InputEvent& event, Action action) { onAction(event, action); };
  calls.openUrl = [this](const std::vector<std::string>& urls, const std::string& base) {
    leaveWorld([this, urls, base] { open({urls, base, {}}, false); });
  };
  // A recording and a script are of one world: the first one, or for a script the same one again.
  Options options = options_;
  if (session_) options.recordInput.clear();
  const bool scripted = !session_ || keepPlace_;
  if (!options.recordInput.empty())
    calls.record = [this](double time, const InputEvent& event) {
      recording_.write(inputLine(time, event));
    };
  auto fresh = std::make_unique<Session>(std::move(world), options, problems_, std::move(calls),
                                         scripted ? options_.script.get() : nullptr);
  if (left) fresh->editor().journal().adopt(*left);
  width_ = screen_.width();
  height_ = screen_.height();
  fresh->pictures().setMotion(motion_);
  fresh->begin(width_, height_, place, fragment);
  mixer_.set({});
  const std::string saved = session_ ? session_->saver().end() : "";
  const std::string recorded = session_ ? recording_.end() : "";
  if (control_) control_->detach();
  editing_.reset();
  saves_ = 0;
  keepEdits(session_.get());
  session_ = std::move(fresh); // ends the previous session
  session_->editor().journal().look();
  failed_ = exitDone;
  first_ = true;
  message(saved.empty() ? recorded : saved, 6);
  const std::string& path = session_->browser().world().path;
  screen_.setTitle(path + " - vv");
  watch_.follow(session_->browser().world());
}

void Window::reload() {
  if (!session_) return;
  const std::string path = session_->browser().world().path;
  if (path == "-") return message("standard input cannot be read again", 3);
  leaveWorld([this, path] { open({{path}, "", {}}, true); });
}

void Window::leaveWorld(std::function<void()> go, std::function<void()> stay) {
  session_ ? editing_.leave(session_->editor(), std::move(go), std::move(stay)) : go();
}

void Window::onAction(const InputEvent& event, Action action) {
  switch (action) {
  case Action::save:
  case Action::saveExr: save(event, action == Action::save ? "png" : "exr"); break;
  case Action::samples: switchMotion(); break;
  case Action::command: command(); break;
  case Action::reload: reload(); break;
  case Action::overlay:
    level_ = OverlayLevel((int(level_) + 1) % 3);
    shownAt_ = -1;
    break;
  case Action::edit: edit(); break;
  case Action::help: showHelp(!help_); break;
  case Action::fullScreen: screen_.toggleFullScreen(); break;
  case Action::quit:
    if (event.text != "Escape" || !session_ || !session_->saver().giveUp())
      leaveWorld([this] { ended_ = true; });
    break;
  default: break;
  }
}

void Window::save(const InputEvent& event, const char* suffix) {
  if (!session_) return;
  if (event.kind == InputEvent::Kind::save) return session_->saver().saveWhenFinished(event.text);
  if (session_->saver().giveUp()) return;
  session_->saver().finishWriting();
  session_->saver().save(freeName(session_->browser().world().path, suffix));
}

void Window::switchMotion() {
  using Motion = PictureLoop::Motion;
  motion_ = motion_ == Motion::rebuilt ? Motion::samples : Motion::rebuilt;
  if (session_) session_->pictures().setMotion(motion_);
  message(motion_ == Motion::rebuilt ? "rebuilt pictures while something moves"
                                     : "raw samples while something moves",
          3);
}

void Window::command() {
  if (!session_) return;
  const std::string line = session_->command(arguments_);
  writeOut(line + "\n");
  message(line, 6);
}

void Window::showHelp(bool shown) {
  help_ = shown;
  screen_.setPanel(Screen::middle,
                   shown ? painter_->paint(helpLines(editing_.isOpen()), screen_.width(), true)
                         : Panel());
}

// A recording would not have the edits, and its replay would show another world.
void Window::edit() {
  if (recording_.isOn() || options_.script)
    return message("no editor here: recordings and scripts of input have no edits", 4);
  editing_.open(!editing_.isOpen());
}

void Window::message(const std::string& text, double time) {
  message_ = text;
  messageEnds_ = seconds() + time;
  shownAt_ = -1;
}

std::string Window::bottomLine() {
  if (!loading_.empty()) return fmt::format("loading {} ...", loading_);
  if (const std::string text = session_ ? session_->saver().text() : ""; !text.empty()) return text;
  if (!message_.empty() && seconds() < messageEnds_) return message_;
  if (!session_) return failed_ ? message_ : "drop a world file here; F1 lists the keys";
  if (!session_->resting()) return bottom_;
  if (const xvrml::ScriptCounts counts = session_->browser().scripts(); counts.waiting > 0)
    return fmt::format("starting Scripts: {} of {} ...", counts.scripts - counts.waiting,
                       counts.scripts);
  const std::string hint = session_->pilot().hint();
  return hint.empty() ? session_->browser().description() : hint;
}

void Window::reportClusterMessages() {
  if (!options_.render.cluster) return;
  const std::vector<picture::ClusterMessage> notes = options_.render.cluster->takeMessages();
  for (const picture::ClusterMessage& note : notes)
    if (note.level >= 2) message(note.text, 6);
  for (const std::string& line : clusterMessageLines(notes, options_.verbose, options_.quiet))
    say(line);
}

void Window::tell() {
  reportClusterMessages();
  if (session_ && session_->resting())
    if (const std::string text = session_->takeMessage(); !text.empty()) message(text, 3);
  if (const auto told = editing_.takeMessage()) message(told->text, told->lasts ? 1e9 : 6);
  const std::string bottom = bottomLine();
  if (bottom != bottom_ || shownAt_ < 0) {
    bottom_ = bottom;
    screen_.setPanel(Screen::bottom,
                     bottom.empty() ? Panel() : painter_->paint({bottom}, screen_.width()));
  }
  if (shownAt_ >= 0 && seconds() - shownAt_ < .2) return;
  if (session_ && !session_->resting()) return;
  shownAt_ = seconds();
  std::vector<std::string> lines;
  if (session_) lines = overlayLines(session_->facts(), session_->pilot().paused(), level_);
  const int width = screen_.freeWidth();
  if (std::exchange(linesWidth_, width) == width && lines == lines_) return;
  lines_ = lines;
  screen_.setPanel(Screen::top, painter_->paint(lines, width));
}

void Window::sound() {
  const std::vector<xvrml::Heard> audible = session_->pilot().paused()
                                                ? std::vector<xvrml::Heard>()
                                                : xvrml::heardIn(session_->browser());
  if (!audible.empty() && !speaker_.tried())
    if (const std::string why = speaker_.open(); !why.empty() && options_.verbose)
      say("vv: no sound: " + why);
  if (speaker_.tried()) mixer_.set(audible);
}

int Window::end() {
  keepEdits(session_.get());
  recording_.close();
  const int code = interrupted()                                   ? exitInterrupted
                   : failed_ == exitDone && recording_.hasFailed() ? exitRender
                                                                   : failed_;
  if (session_) session_->saver().end();
  control_.reset(); // sends the last answers, before the process may end
  stopOrExit(session_.get(), code, control::Control::isWriting() ? Others::work : Others::rest);
  return code;
}

} // namespace

int runWindow(const Options& options, const std::vector<std::string>& arguments) {
  for (const std::string& refused : xvrml::loadNodePlugins(options.nodePath)) sayWarning(refused);
  Window window(options, arguments);
  return window.run();
}

} // namespace vv
