#include "session/session.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "process/messages.h"
#include "start/look.h"
#include "start/world_clock.h"
#include "start/world_start.h"

namespace vv {

namespace {

// Returns whole seconds since 1970, because the command of a view contains them.
double realTime() {
  return double(std::chrono::duration_cast<std::chrono::seconds>(
                    std::chrono::system_clock::now().time_since_epoch())
                    .count());
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

// Returns the direction from which an action shows the whole world: frameAll or beginAgain.
Fit::Direction directionOf(Action action) {
  return action == Action::beginAgain ? Fit::Direction::initial : Fit::Direction::current;
}

// Adds an event to those that wait. Where moves follow each other, only the last one counts.
void postpone(InputEvent event, std::deque<InputEvent>& later) {
  const bool moves = event.kind == InputEvent::Kind::move && !later.empty() &&
                     later.back().kind == InputEvent::Kind::move;
  if (moves)
    later.back() = std::move(event);
  else
    later.push_back(std::move(event));
}

} // namespace

Session::Session(std::unique_ptr<xvrml::World> world, const Options& options, Problems& problems,
                 Callbacks calls, const InputScript* script)
    : options_(forWindow(options, calls, script || !options.recordInput.empty())),
      problems_(problems), callbacks_(std::move(calls)),
      browser_(startWorld(std::move(world), options_, problems)),
      shared_(*browser_, options_.render),
      viewers_(*browser_, options.time && !script ? *options.time : 0, options.view, shared_,
               options_),
      channels_(options.render.channels), saver_(own_, options_, channels_, script != nullptr,
                                                 [this] {
                                                   if (replay_) replay_->resume();
                                                 }),
      clock_(script || !options.recordInput.empty() ? SessionClock::Mode::stepped
                                                    : SessionClock::Mode::real,
             options.fps),
      inlines_(*browser_) {
  if (options_.render.linear && !options_.has(Job::serve))
    own_.pilot.allowFalseColours(options_.falseColour);
  if (options.time && !script) WorldClock(*browser_, options.fps).advance(*options.time);
  if (script)
    replay_ = std::make_unique<Replay>(
        own_.pilot, *script, [this](const InputEvent& event, Action action) {
          if (action == Action::frameAll || action == Action::beginAgain)
            own_.fit.want(directionOf(action));
          else if (action != Action::reload) // the script would begin again, and reload again
            callbacks_.onAction(event, action);
          if (held()) replay_->wait();
        });
  inlines_.collect();
  chooseLookOnce();
}

// An Inline may hold a Viewpoint or a light, so the look is chosen when all are loaded.
void Session::chooseLookOnce() {
  if (isLookChosen_ || inlines_.isLoading()) return;
  isLookChosen_ = true;
  shared_.live.change([this](picture::RenderSettings& settings) {
    Options given = options_; // the variance is the window's own
    given.render.channels = channels_;
    chooseLook(given, browser_->world(), settings);
    shared_.view = settings.view;
  });
}

void Session::begin(int width, int height, const std::optional<Place>& place,
                    const std::string& fragment) {
  resize(width, height);
  const bool named = isOfCommandLine(options_, browser_->world()) && !place && fragment.empty();
  if (!place && fragment.empty()) chooseView(options_, browser_->world(), options_.view);
  if (own_.pilot.begin(options_.view, named ? options_.viewpoint : std::string()) && !place)
    own_.fit.want(Fit::Direction::initial);
  own_.fit.setRepeat(own_.fit.isPending() && inlines_.isLoading() ? Fit::Repeat::whenLoaded
                                                                  : Fit::Repeat::never);
  if (place) {
    own_.pilot.bindViewpoint(place->viewpoint);
    own_.pilot.putAt(place->camera);
  } else if (!fragment.empty() && !own_.pilot.bindViewpoint(fragment)) {
    sayWarning(fmt::format("there is no viewpoint \"{}\"", fragment));
  }
  own_.pilot.animateTransitions();
}

void Session::resize(int width, int height) { own_.resize(width, height); }

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

// Decides once whether the camera of a model's file is left out; the viewer has been placed so.
void Session::settleCamera() {
  if (options_.view.authored != picture::View::Authored::unlessCut) return;
  const picture::LiveRenderer& live = shared_.live;
  settleView(live.leavesViewpointOut(options_.view, own_.pilot.aspect()), live.viewpoints(),
             options_.quiet, options_.view);
}

// --- Time ---

void Session::advance(double seconds) {
  clock_.read(seconds,
              saver_.isWaiting() ? SessionClock::Reading::isHeld : SessionClock::Reading::advances);
  editor_.journal().advance(seconds);
  if (!resting()) return;
  if (own_.pictures.placeViewer(own_.pilot, own_.fit)) {
    settleCamera();
    if (replay_) replay_->resume();
  }
  viewers_.placeGuests();
  if (captures_.isWaiting()) return captures_.advance();
  bool moves = viewers_.haveMoved();
  step();
  viewers_.noteViews(); // what moves by itself is no user
  takeEvents();
  moves |= viewers_.haveMoved();
  viewers_.noteViews();
  captures_.yield(moves, clock_.reading());
  loadSome();
  problems_.tell(browser_->world());
  takeTurns();
  // Contents of Inlines that are still to come belong to a saved picture.
  if (!inlines_.isLoading()) saver_.writeIfFinished();
  // Meanwhile nothing else uses the world (resting()).
  if (own_.pictures.hasShown()) preparation_.begin(*browser_, own_.pilot.camera());
}

void Session::step() {
  if (saver_.isWaiting()) return;
  if (!held()) clock_.pass();
  if (held() && !own_.pictures.hasStarted()) return;
  clock_.run({[this] { return held(); },
              [this](double time) {
                if (replay_) return replay_->step(time);
                order_.begin();
                own_.pilot.step(time);
                viewers_.stepGuests(time);
                return true;
              }});
}

// After a save, only the window's keys act until the next step. While the world is held for the
// picture, what ends an action of the user or moves the pointer is handled afterwards; what would
// begin one is dropped. A replay waits for fits, so a recorded session does the same.
Session::Passage Session::passageOf(const InputEvent& event) const {
  using Kind = InputEvent::Kind;
  if (replay_) return Passage::passes;
  if (isRecording() && own_.fit.isPending()) return Passage::waits;
  if (!order_.isEnded() || own_.pilot.windowAction(event, keysWhileHeld()) != Action::none)
    return Passage::passes;
  const bool ends = event.kind == Kind::move || event.kind == Kind::release ||
                    event.kind == Kind::leave || event.kind == Kind::up;
  return ends || !saver_.isWaiting() ? Passage::waits : Passage::isDropped;
}

// Handles the user's input. In a scripted session only window commands are taken from the user.
void Session::takeEvents() {
  const bool pointerWaits = preparation_.state() == PickPreparation::State::waiting && !replay_;
  std::deque<InputEvent> later;
  while (!own_.waiting.empty()) {
    const InputEvent event = std::move(own_.waiting.front());
    own_.waiting.pop_front();
    const Passage passage = passageOf(event);
    if (passage == Passage::isDropped) continue;
    // Keys of the window do not overtake what waits for the next step.
    const bool isBehind = order_.isEnded() && !saver_.isWaiting() && !replay_ && !later.empty();
    const bool waits = passage == Passage::waits || isBehind;
    if (waits || (pointerWaits && event.kind <= InputEvent::Kind::wheel)) {
      postpone(event, later);
      continue;
    }
    take(event);
  }
  own_.waiting = std::move(later);
  if (!saver_.isWaiting()) viewers_.takeGuestEvents(pointerWaits, callbacks_.onGuestAction);
}

// Handles an event of the user. A key that gives up a save, or that only a replay would pass to the
// world, is not recorded.
void Session::take(const InputEvent& event) {
  const bool apart = order_.isEnded(), wasSaving = saver_.isWaiting();
  if (isRecording() && !apart) callbacks_.record(clock_.time(), event);
  Action action = Action::none;
  if (replay_)
    action = event.kind == InputEvent::Kind::down ? actionOf(event) : Action::none;
  else
    action = apart ? own_.pilot.windowAction(event, keysWhileHeld()) : own_.pilot.handle(event);
  if (!replay_) order_.note(action);
  if ((action == Action::frameAll || action == Action::beginAgain) && !replay_)
    own_.fit.want(directionOf(action));
  else if (action >= Action::save)
    callbacks_.onAction(event, action);
  const bool gaveUp = wasSaving && !saver_.isWaiting();
  if (isRecording() && apart && !gaveUp && own_.pilot.windowAction(event) != Action::none)
    callbacks_.record(clock_.time(), event);
}

// Loads Inlines after the first picture, a few at a time.
void Session::loadSome() {
  if (!own_.pictures.hasShown() || !inlines_.loadSome()) return;
  if (own_.fit.repeat() == Fit::Repeat::whenLoaded && !own_.pilot.hasViewerMoved())
    own_.fit.want(Fit::Direction::initial);
}

// --- The picture ---

// Lets the viewers draw.
void Session::takeTurns() {
  if (captures_.isPending()) return;
  if (measuring_.isPending()) return measuring_.advance();
  if (!isLookChosen_ && !inlines_.isLoading()) {
    if (!shared_.isIdle()) return shared_.cancel();
    chooseLookOnce();
  }
  const double now = clock_.reading();
  if (saver_.isWaiting())
    own_.pictures.advance(own_.pilot, own_.fit, now, PictureLoop::Need::stillPicture);
  else
    viewers_.takeTurns(now);
}

bool Session::look(picture::LivePicture& picture, uint32_t& viewer) {
  if (own_.pictures.lookForStill()) return false;
  const bool idle = shared_.isIdle();
  while (shared_.live.look(picture)) {
    viewer = shared_.viewerOf(picture.number);
    const bool captured = captures_.note(picture, viewer);
    SessionViewer* const one = viewers_.find(viewer);
    if (!captured && one && one->pictures.note(picture)) return true;
  }
  if (idle) captures_.noteIdle();
  return false;
}

bool Session::look(picture::LivePicture& picture) {
  uint32_t viewer = 0;
  while (look(picture, viewer))
    if (viewer == 0) return true;
  return false;
}

bool Session::stop(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (preparation_.state() == PickPreparation::State::running || !shared_.isIdle()) {
    shared_.cancel();
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

// --- Viewers ---

void Session::addGuest(uint32_t number, int width, int height) {
  SessionViewer& guest = viewers_.add(number);
  guest.pilot.step(clock_.time());
  guest.resize(width, height);
}

void Session::handle(const InputEvent& event, uint32_t viewer) {
  if (SessionViewer* const one = viewers_.find(viewer)) one->waiting.push_back(event);
}

bool Session::release() {
  if (!resting() || !shared_.isIdle() || !own_.pictures.hasStarted() || saver_.isWaiting() ||
      captures_.isPending() || measuring_.isPending() || own_.pictures.stillWaits())
    return false;
  shared_.release();
  for (const auto& [number, viewer] : viewers_.all()) viewer->pictures.loseStill();
  return true;
}

void Session::capture(uint32_t viewer, uint64_t asker, Captures::Done done, bool givesWay) {
  SessionViewer& one = viewers_.findOrOwn(viewer);
  const Pilot& pilot = one.pilot;
  PictureLoop& pictures = one.pictures;
  Captures::Request request{asker,
                            pictures.stillOf(pilot),
                            pictures.headlightOf(pilot),
                            pictures.transformOf(pilot),
                            std::move(done),
                            givesWay};
  // The picture that is shown may be the one that is wanted, or become it.
  if (!captures_.isPending() && pictures.isRefining() && !one.isOutdated()) {
    picture::Picture picture;
    if (pictures.isFinished(pilot)) {
      if (pictures.copyStill(picture)) return request.done(&picture);
    } else if (shared_.viewer() == pictures.viewer() && !pictures.isInterrupted() &&
               !shared_.isIdle()) {
      return captures_.adopt(std::move(request), pictures.number());
    }
  }
  captures_.want(std::move(request));
}

bool Session::isQuiet() const {
  const auto isQuiet = [](const auto& one) { return one.second->isQuiet(); };
  return resting() && !inlines_.isLoading() && !captures_.isPending() && !captures_.isPostponed() &&
         !measuring_.isPending() &&
         std::all_of(viewers_.all().begin(), viewers_.all().end(), isQuiet);
}

} // namespace vv
