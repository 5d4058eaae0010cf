#include "window/session.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "report/describe.h"
#include "report/messages.h"
#include "timeline.h"
#include "window/input/view_command.h"
#include "window/saving.h"
#include "world_start.h"

namespace vv {

using State = picture::LiveRenderer::State;

namespace {

// Returns whole seconds since 1970, because the command of a view contains them.
double realTime() {
  return double(std::chrono::duration_cast<std::chrono::seconds>(
                    std::chrono::system_clock::now().time_since_epoch())
                    .count());
}

bool equal(const xvrml::CameraSettings& a, const xvrml::CameraSettings& b) {
  return std::memcmp(a.matrix, b.matrix, sizeof a.matrix) == 0 && a.fovy == b.fovy &&
         a.height == b.height && a.shader == b.shader;
}

// Returns the options of a picture, completed for a running world.
Options forWindow(const Options& options, const Session::Callbacks& calls, const bool scripted) {
  Options own = options;
  own.render.samples = samplesInWindow(options);
  own.render.channels |= RT_VARIANCE; // RTstats then contains the error
  own.running.print = [](const std::string& text) { say(text); };
  // 0 in scripted sessions: the result must not depend on the machine's speed
  own.running.scriptPatience = scripted ? 0 : 0.05;
  if (!own.epoch && !scripted && !options.time) own.epoch = realTime();
  if (calls.openUrl)
    own.running.loadUrl = [open = calls.openUrl](const std::vector<std::string>& urls,
                                                 const std::vector<std::string>&,
                                                 const std::string& base) {
      if (!urls.empty() && urls[0].starts_with('#')) return false; // a viewpoint of this world
      open(urls, base);
      return true;
    };
  return own;
}

} // namespace

Session::Session(std::unique_ptr<xvrml::World> world, const Options& options, Problems& problems,
                 Callbacks calls, const InputScript* script)
    : options_(forWindow(options, calls, script || !options.recordInput.empty())),
      problems_(problems), callbacks_(std::move(calls)),
      browser_(startWorld(std::move(world), options_, problems)),
      pilot_(*browser_, options.time && !script ? *options.time : 0, options.view.fov),
      renderer_(*browser_, options_.render), channels_(options.render.channels),
      pacing_(options.fps), stepped_(script || !options.recordInput.empty()) {
  if (options.time && !script) WorldClock(*browser_, options.fps).advance(*options.time);
  if (script)
    replay_ =
        std::make_unique<Replay>(pilot_, *script, [this](const InputEvent& event, Action action) {
          if (action == Action::frameAll || action == Action::beginAgain)
            wantFit(action == Action::beginAgain);
          else
            callbacks_.onAction(event, action);
          if (blocked()) replay_->wait();
        });
  forEachNode(browser_->world(), [&](const xvrml::Node& node) {
    if (node.type().name == "Inline" && !xvrml::inlineScope(node))
      inlines_.emplace_back(const_cast<xvrml::Node*>(&node));
  });
  generation_ = browser_->generation();
}

Session::~Session() {
  if (preparer_.joinable()) preparer_.join();
}

void Session::begin(int width, int height, const std::optional<Place>& place,
                    const std::string& fragment) {
  resize(width, height);
  if (pilot_.begin(options_.view,
                   place || !fragment.empty() ? std::string() : options_.viewpoint) &&
      !place)
    wantFit(true);
  fitAgain_ = fit_ != Fit::none && !inlines_.empty();
  if (place) {
    pilot_.bindViewpoint(place->viewpoint);
    pilot_.putAt(place->camera);
  } else if (!fragment.empty() && !pilot_.bindViewpoint(fragment)) {
    sayWarning(fmt::format("there is no viewpoint \"{}\"", fragment));
  }
  pilot_.animateTransitions();
}

void Session::resize(int width, int height) {
  width_ = std::max(1, width);
  height_ = std::max(1, height);
  pilot_.setAspect(double(width_) / height_);
}

Session::Place Session::place() const {
  Place place{"", browser_->camera(1)};
  if (const xvrml::Node* viewpoint = browser_->bound().viewpoint) {
    size_t number = 0;
    for (const xvrml::ViewpointName& one : browser_->viewpoints()) {
      if (one.node.get() == viewpoint)
        place.viewpoint = one.name.empty() ? std::to_string(number) : one.name;
      ++number;
    }
  }
  return place;
}

// --- Time ---

void Session::advance(double seconds) {
  const double passed = last_ < 0 ? 0 : std::max(0.0, seconds - last_);
  last_ = seconds;
  if (!stepped_) clock_ += passed;
  if (!resting()) return;
  if (fit_ == Fit::mapping) {
    if (const auto view = fitAsAtFirst_ ? pilot_.initialView(options_.view) : std::nullopt)
      pilot_.present(renderer_.cameraOf(*view, pilot_.aspect()), renderer_.upOf(*view));
    else
      pilot_.frameAll(renderer_.bounds());
    fit_ = Fit::none;
    if (replay_) replay_->resume();
  }
  if (stepped_ && !blocked()) clock_ += std::min(passed, 0.25);
  if (begun_ || !blocked()) step(passed);
  takeEvents();
  loadSome();
  problems_.tell(browser_->world());
  draw();
  saveIfFinished();
  if (!prepared_ && shownAny_) prepare();
}

// Casts the first ray on a thread of its own. With millions of triangles this takes seconds,
// because it builds the acceleration structures, and the window must not wait. Meanwhile nothing
// else uses the world (resting()).
void Session::prepare() {
  prepared_ = preparing_ = true;
  preparer_ = std::thread([this, camera = pilot_.camera()] {
    const double* m = camera.matrix;
    const double origin[] = {m[12], m[13], m[14]}, direction[] = {-m[8], -m[9], -m[10]};
    try {
      xvrml::PickHit hit;
      browser_->pick(origin, direction, {}, hit);
    } catch (const std::exception&) {} // out of memory: the next user of the structures reports it
    preparing_ = false;
  });
}

void Session::step(double) {
  if (!stepped_) {
    pilot_.step(time_ = clock_);
    return;
  }
  constexpr int most = 10; // maximum number of steps before a picture
  for (int i = 0; i < most && double(next_) / options_.fps <= clock_ && !blocked(); ++i) {
    time_ = double(next_) / options_.fps;
    if (replay_ && !replay_->step(time_)) return;
    if (!replay_) pilot_.step(time_);
    ++next_;
  }
  clock_ = std::min(clock_, double(next_) / options_.fps);
}

// Handles the user's input. In a scripted session only window commands are taken from the user.
void Session::takeEvents() {
  std::deque<InputEvent> later; // pointer events wait for prepare()
  while (!waiting_.empty()) {
    if (!prepared_ && !replay_ && waiting_.front().kind <= InputEvent::Kind::wheel) {
      later.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
      continue;
    }
    const InputEvent event = std::move(waiting_.front());
    waiting_.pop_front();
    Action action = Action::none;
    if (callbacks_.record) callbacks_.record(time_, event);
    if (!replay_)
      action = pilot_.handle(event);
    else if (event.kind == InputEvent::Kind::down)
      action = actionOf(event);
    const bool ofWindow = action >= Action::save && action != Action::none;
    if ((action == Action::frameAll || action == Action::beginAgain) && !replay_)
      wantFit(action == Action::beginAgain);
    else if (ofWindow)
      callbacks_.onAction(event, action);
  }
  waiting_ = std::move(later);
}

// Loads Inlines after the first picture, a few at a time.
void Session::loadSome() {
  if (inlines_.empty() || !shownAny_) return;
  // a Script has replaced the world
  if (browser_->generation() != generation_) return inlines_.clear();
  const auto start = std::chrono::steady_clock::now();
  while (!inlines_.empty() &&
         std::chrono::steady_clock::now() - start < std::chrono::milliseconds(10)) {
    const xvrml::NodeRef node = std::move(inlines_.front());
    inlines_.pop_front();
    if (xvrml::inlineScope(*node) || !browser_->loadInline(*node)) continue;
    forEachNodeBelow(*node, [&](const xvrml::Node& below) {
      if (below.type().name == "Inline" && !xvrml::inlineScope(below))
        inlines_.emplace_back(const_cast<xvrml::Node*>(&below));
    });
  }
  if (inlines_.empty() && fitAgain_ && !pilot_.hasViewerMoved()) wantFit(true);
}

// --- The picture ---

void Session::wantFit(bool asAtFirst) {
  fit_ = Fit::wanted;
  fitAsAtFirst_ = asAtFirst;
}

void Session::draw() {
  if (width_ <= 0) return;
  const State state = renderer_.state();
  const bool dirty = !begun_ || fit_ == Fit::wanted || !equal(pilot_.camera(), shown_) ||
                     browser_->hasChanges() || pilot_.headlight() != shownHeadlight_ ||
                     (!moving_ && (frame_.width != width_ || frame_.height != height_));
  // moving frames overlap; a frame being refined is cancelled instead
  const bool behind = state == State::ready && moving_;
  if (state == State::rendering || (state == State::ready && !behind)) {
    if (dirty && !moving_ && (shownAny_ || fit_ == Fit::wanted)) renderer_.cancel();
    return;
  }
  if (state == State::mapping) return;
  // so that the first picture comes early
  if (dirty)
    start(true);
  else if (!behind && (moving_ || !refined_))
    start(false);
}

void Session::start(bool moving) {
  picture::LiveFrame frame;
  frame.view.shader = options_.view.shader;
  const bool presenting = fit_ == Fit::wanted && fitAsAtFirst_;
  if (const auto view = presenting ? pilot_.initialView(options_.view) : std::nullopt)
    frame.view = *view;
  else if (presenting && !begun_) {
    frame.view.fit = true;
    frame.view.fov = options_.view.fov;
  } else
    frame.view.viewer = pilot_.camera();
  shown_ = pilot_.camera();
  if (shownHeadlight_ != pilot_.headlight()) {
    shownHeadlight_ = pilot_.headlight();
    const auto on = xvrml::MapOptions::Headlight::on, off = xvrml::MapOptions::Headlight::off;
    const auto wanted = !shownHeadlight_ ? options_.render.headlight : *shownHeadlight_ ? on : off;
    renderer_.change([&](picture::RenderSettings& s) { s.headlight = wanted; });
  }
  const double now = last_;
  if (moving && moving_ && now > lastStart_)
    gap_ = gap_ <= 0 ? now - lastStart_ : .9 * gap_ + .1 * (now - lastStart_);
  if (!moving) gap_ = 0;
  lastStart_ = now;
  frame_ = pacing_.next(width_, height_, moving, options_.render.samples);
  frame.width = frame_.width;
  frame.height = frame_.height;
  frame.samples = frame_.samples;
  moving_ = moving;
  refined_ = !moving;
  renderer_.start(frame);
  begun_ = true;
  if (fit_ == Fit::wanted) fit_ = Fit::mapping;
}

bool Session::look(picture::LivePicture& picture) {
  if (!renderer_.look(picture)) return false;
  // Partial pictures are not shown over the previous one while something moves: that would tear.
  const bool shown = picture.finished || !shownAny_ || !moving_;
  shownAny_ = true;
  if (picture.finished)
    pacing_.took({picture.width, picture.height, 1}, picture.seconds, picture.alone,
                 picture.overhead, picture.samples);
  const RTstats stats = picture.finished ? picture.stats : facts_.stats;
  const xvrml::MapStats map = picture.finished ? picture.map : facts_.map;
  facts_.width = picture.width;
  facts_.height = picture.height;
  facts_.samples = picture.samples;
  facts_.finished = picture.finished;
  facts_.stats = stats;
  facts_.map = map;
  return shown;
}

std::string Session::save(const std::string& path) {
  picture::Picture picture;
  return renderer_.copy(picture) ? savePicture(picture, path, channels_)
                                 : "there is no picture yet";
}

void Session::saveIfFinished() {
  if (saveTo_.empty() || moving_ || !refined_ || renderer_.state() != State::idle ||
      browser_->hasChanges() || !equal(pilot_.camera(), shown_))
    return;
  message_ = save(std::exchange(saveTo_, {}));
  if (replay_) replay_->resume();
}

bool Session::stop(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (preparing_ || renderer_.state() != State::idle) {
    renderer_.cancel();
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

// --- Reports ---

std::string Session::command(const std::vector<std::string>& arguments) const {
  std::optional<bool> headlight = pilot_.headlight();
  if (!headlight && options_.render.headlight != xvrml::MapOptions::Headlight::automatic)
    headlight = options_.render.headlight == xvrml::MapOptions::Headlight::on;
  return viewCommand({browser_->world().path, pilot_.camera(), width_, height_, browser_->now(),
                      options_.epoch, headlight},
                     arguments);
}

std::string Session::takeMessage() {
  std::string text = std::exchange(message_, {});
  std::string pilots = pilot_.takeMessage();
  if (const std::string failure = renderer_.takeFailure(); !failure.empty()) {
    sayError(failure);
    return failure;
  }
  return pilots.empty() ? text : pilots;
}

SessionFacts Session::facts() const {
  SessionFacts facts;
  facts.frameRate = moving_ && gap_ > 0 ? 1 / gap_ : 0;
  facts.width = facts_.width;
  facts.height = facts_.height;
  facts.samples = facts_.samples;
  facts.wanted = moving_ ? 0 : options_.render.samples;
  facts.stats = facts_.stats;
  facts.map = facts_.map;
  facts.finished = facts_.finished;
  const xvrml::Diagnostics& d = browser_->world().diagnostics;
  facts.errors = d.errors();
  facts.warnings = d.warnings();
  if (!d.list().empty()) facts.lastProblem = d.list().back().text();
  facts.navigation = navigationName(browser_->navigation());
  facts.description = browser_->description();
  facts.loading = !inlines_.empty();
  if (const auto& cluster = options_.render.cluster) {
    facts.cluster = true;
    facts.workers = cluster->workers();
  }
  return facts;
}

} // namespace vv
