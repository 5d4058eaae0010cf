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

} // namespace

Session::Session(std::unique_ptr<xvrml::World> world, const Options& options, Problems& problems,
                 Callbacks calls, const InputScript* script)
    : options_(forWindow(options, calls, script || !options.recordInput.empty())),
      problems_(problems), callbacks_(std::move(calls)),
      browser_(startWorld(std::move(world), options_, problems)),
      pilot_(*browser_, options.time && !script ? *options.time : 0, options.view),
      shared_(*browser_, options_.render), pictures_(shared_, options_, 0),
      channels_(options.render.channels),
      clock_(script || !options.recordInput.empty() ? SessionClock::Mode::stepped
                                                    : SessionClock::Mode::real,
             options.fps),
      inlines_(*browser_) {
  if (options_.render.linear && !options_.has(Job::serve))
    pilot_.allowFalseColours(options_.falseColour);
  if (options.time && !script) WorldClock(*browser_, options.fps).advance(*options.time);
  if (script)
    replay_ =
        std::make_unique<Replay>(pilot_, *script, [this](const InputEvent& event, Action action) {
          if (action == Action::frameAll || action == Action::beginAgain)
            want(action);
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
  if (pilot_.begin(options_.view, named ? options_.viewpoint : std::string()) && !place)
    fit_.want(Fit::Direction::initial);
  fit_.setRepeat(fit_.isPending() && inlines_.isLoading() ? Fit::Repeat::whenLoaded
                                                          : Fit::Repeat::never);
  if (place) {
    pilot_.bindViewpoint(place->viewpoint);
    pilot_.putAt(place->camera);
  } else if (!fragment.empty() && !pilot_.bindViewpoint(fragment)) {
    sayWarning(fmt::format("there is no viewpoint \"{}\"", fragment));
  }
  pilot_.animateTransitions();
}

void Session::resize(int width, int height) {
  pictures_.resize(width, height);
  pilot_.setAspect(double(pictures_.width()) / pictures_.height());
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

// Decides once whether the camera of a model's file is left out; the viewer has been placed so.
void Session::settleCamera() {
  if (options_.view.authored != picture::View::Authored::unlessCut) return;
  const picture::LiveRenderer& live = shared_.live;
  settleView(live.leavesViewpointOut(options_.view, pilot_.aspect()), live.viewpoints(),
             options_.quiet, options_.view);
}

// --- Time ---

void Session::advance(double seconds) {
  clock_.read(seconds,
              isSaving() ? SessionClock::Reading::isHeld : SessionClock::Reading::advances);
  if (!resting()) return;
  if (pictures_.placeViewer(pilot_, fit_)) {
    settleCamera();
    if (replay_) replay_->resume();
  }
  guests_.placeViewers();
  if (captures_.isWaiting()) return captures_.advance();
  step();
  takeEvents();
  loadSome();
  problems_.tell(browser_->world());
  takeTurns();
  saveIfFinished();
  // Meanwhile nothing else uses the world (resting()).
  if (pictures_.hasShown()) preparation_.begin(*browser_, pilot_.camera());
}

void Session::step() {
  if (isSaving()) return;
  if (!held()) clock_.pass();
  if (held() && !pictures_.hasStarted()) return;
  clock_.run({[this] { return held(); },
              [this](double time) {
                if (replay_) return replay_->step(time);
                order_.begin();
                pilot_.step(time);
                guests_.step(time);
                return true;
              }});
}

// After a save, only the window's keys act until the next step. While the world is held for the
// picture, what ends an action of the user or moves the pointer is handled afterwards; what would
// begin one is dropped. A replay waits for fits, so a recorded session does the same.
Session::Passage Session::passageOf(const InputEvent& event) const {
  using Kind = InputEvent::Kind;
  if (replay_) return Passage::passes;
  if (isRecording() && fit_.isPending()) return Passage::waits;
  if (!order_.isEnded() || pilot_.windowAction(event, keysWhileHeld()) != Action::none)
    return Passage::passes;
  const bool ends = event.kind == Kind::move || event.kind == Kind::release ||
                    event.kind == Kind::leave || event.kind == Kind::up;
  return ends || !isSaving() ? Passage::waits : Passage::isDropped;
}

// Adds an event to those that wait. Where moves follow each other, only the last one counts.
void Session::postpone(InputEvent event, std::deque<InputEvent>& later) {
  const bool moves = event.kind == InputEvent::Kind::move && !later.empty() &&
                     later.back().kind == InputEvent::Kind::move;
  if (moves)
    later.back() = std::move(event);
  else
    later.push_back(std::move(event));
}

// Handles the user's input. In a scripted session only window commands are taken from the user.
void Session::takeEvents() {
  const bool pointerWaits = preparation_.state() == PickPreparation::State::waiting && !replay_;
  std::deque<InputEvent> later;
  while (!waiting_.empty()) {
    const InputEvent event = std::move(waiting_.front());
    waiting_.pop_front();
    const Passage passage = passageOf(event);
    if (passage == Passage::isDropped) continue;
    // Keys of the window do not overtake what waits for the next step.
    const bool isBehind = order_.isEnded() && !isSaving() && !replay_ && !later.empty();
    const bool waits = passage == Passage::waits || isBehind;
    if (waits || (pointerWaits && event.kind <= InputEvent::Kind::wheel)) {
      postpone(event, later);
      continue;
    }
    take(event);
  }
  waiting_ = std::move(later);
  if (!isSaving()) guests_.takeEvents(pointerWaits, callbacks_.onGuestAction);
}

// Handles an event of the user. A key that gives up a save, or that only a replay would pass to the
// world, is not recorded.
void Session::take(const InputEvent& event) {
  const bool apart = order_.isEnded(), wasSaving = isSaving();
  if (isRecording() && !apart) callbacks_.record(clock_.time(), event);
  Action action = Action::none;
  if (replay_)
    action = event.kind == InputEvent::Kind::down ? actionOf(event) : Action::none;
  else
    action = apart ? pilot_.windowAction(event, keysWhileHeld()) : pilot_.handle(event);
  if (!replay_) order_.note(action);
  if ((action == Action::frameAll || action == Action::beginAgain) && !replay_)
    want(action);
  else if (action >= Action::save)
    callbacks_.onAction(event, action);
  const bool gaveUp = wasSaving && !isSaving();
  if (isRecording() && apart && !gaveUp && pilot_.windowAction(event) != Action::none)
    callbacks_.record(clock_.time(), event);
}

// Loads Inlines after the first picture, a few at a time.
void Session::loadSome() {
  if (!pictures_.hasShown() || !inlines_.loadSome()) return;
  if (fit_.repeat() == Fit::Repeat::whenLoaded && !pilot_.hasViewerMoved())
    fit_.want(Fit::Direction::initial);
}

// --- The picture ---

// Shows the whole world. fit: Action::frameAll or Action::beginAgain.
void Session::want(Action fit) {
  fit_.want(fit == Action::beginAgain ? Fit::Direction::initial : Fit::Direction::current);
}

// Lets the viewers draw: those for whom something has changed, each in turn, or else those whose
// picture could be better, in the order of their numbers.
void Session::takeTurns() {
  using Urgency = PictureLoop::Urgency;
  if (captures_.isPending()) return;
  if (!isLookChosen_ && !inlines_.isLoading()) {
    if (!shared_.isIdle()) return shared_.cancel();
    chooseLookOnce();
  }
  const double now = clock_.reading();
  if (isSaving() || guests_.all().empty())
    return pictures_.advance(
        pilot_, fit_, now, isSaving() ? PictureLoop::Need::stillPicture : PictureLoop::Need::none);
  std::vector<std::pair<uint32_t, Guest*>> viewers{{0, nullptr}};
  for (const auto& [viewer, guest] : guests_.all()) viewers.emplace_back(viewer, guest.get());
  const auto urgencyOf = [&](const Guest* guest) {
    return guest ? guest->pictures.urgency(guest->pilot, guest->fit)
                 : pictures_.urgency(pilot_, fit_);
  };
  const bool changed = std::any_of(viewers.begin(), viewers.end(), [&](const auto& one) {
    return urgencyOf(one.second) == Urgency::change;
  });
  if (changed) { // begin after the viewer who had the last turn
    const auto next = std::find_if(viewers.begin(), viewers.end(),
                                   [&](const auto& one) { return one.first > shared_.viewer(); });
    std::rotate(viewers.begin(), next, viewers.end());
  }
  for (const auto& [viewer, guest] : viewers) {
    if (changed && urgencyOf(guest) != Urgency::change) continue;
    if (guest)
      guest->pictures.advance(guest->pilot, guest->fit, now, PictureLoop::Need::none);
    else
      pictures_.advance(pilot_, fit_, now, PictureLoop::Need::none);
    if (shared_.isMapping()) return;
  }
}

bool Session::look(picture::LivePicture& picture, uint32_t& viewer) {
  if (pictures_.lookForStill()) return false;
  const bool idle = shared_.isIdle();
  while (shared_.live.look(picture)) {
    viewer = shared_.viewerOf(picture.number);
    const bool captured = captures_.note(picture, viewer);
    Guest* const guest = guests_.find(viewer);
    if (captured || (!guest && viewer != 0)) continue;
    if (guest ? guest->pictures.note(picture) : pictures_.note(picture)) return true;
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

void Session::setMotion(PictureLoop::Motion motion, uint32_t viewer) {
  Guest* const guest = guests_.find(viewer);
  (guest ? guest->pictures : pictures_).setMotion(motion);
}

void Session::save(const std::string& path) {
  picture::Picture picture;
  if (isSaving()) {
    message_ = fmt::format("{} is not saved: another picture is waited for", path);
  } else if (!replay_ && !pictures_.isOutdated(pilot_, fit_) && pictures_.copyStill(picture)) {
    writer_.begin(std::move(picture), path, channels_, pilot_.falseColour());
  } else {
    saveTo_ = path;
    saver_ = Saver::user;
  }
}

void Session::saveWhenFinished(const std::string& path) {
  if (isSaving()) giveUp("another picture is wanted");
  saveTo_ = path;
  saver_ = Saver::script;
}

bool Session::giveUpSaving() {
  if (!isSaving() || saver_ == Saver::script) return false;
  giveUp("given up");
  return true;
}

void Session::giveUp(const std::string& why) {
  message_ = fmt::format("{} is not saved: {}", std::exchange(saveTo_, {}), why);
  say("vv: " + message_);
  if (replay_) replay_->resume();
}

std::string Session::savingText() const {
  if (!isSaving() || saver_ == Saver::script) return {};
  const double taken = pictures_.hasStill() ? pictures_.facts().samples : 0;
  return fmt::format("Saving the picture of this instant: {:.0f} of {} samples; Escape gives up",
                     taken, options_.render.samples);
}

// A script continues, and a user's world goes on, when the picture has all its samples. Contents of
// Inlines that are still to come belong to it.
void Session::saveIfFinished() {
  if (!isSaving() || inlines_.isLoading() || !pictures_.isFinished(pilot_)) return;
  picture::Picture picture;
  if (!pictures_.copyStill(picture)) return;
  writer_.begin(std::move(picture), std::exchange(saveTo_, {}), channels_, pilot_.falseColour());
  if (replay_) replay_->resume();
}

std::string Session::endSaving() {
  if (isSaving()) {
    picture::Picture picture;
    bool copied = pictures_.copyStill(picture);
    // For a moment, while a frame ends, there is no copy.
    for (int i = 0; i < 1000 && !copied && pictures_.hasStill(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      copied = pictures_.copyStill(picture);
    }
    if (copied)
      writer_.begin(std::move(picture), std::exchange(saveTo_, {}), channels_, pilot_.falseColour(),
                    fmt::format(", with {:.0f} of {} samples", pictures_.facts().samples,
                                options_.render.samples));
    else
      giveUp("its picture has not begun yet");
  }
  writer_.wait();
  const std::string written = writer_.takeMessage();
  return written.empty() ? std::exchange(message_, {}) : written;
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

// --- Guests ---

void Session::addGuest(uint32_t viewer, int width, int height) {
  Guest& guest = guests_.add(viewer, pilot_, *browser_, shared_, options_);
  guest.pilot.step(clock_.time());
  guest.pictures.setMotion(pictures_.motion());
  guest.pictures.setMostPreviewPixels(mostPreviewPixels_);
  resizeGuest(viewer, width, height);
}

void Session::setMostPreviewPixels(double pixels) {
  mostPreviewPixels_ = pixels;
  pictures_.setMostPreviewPixels(pixels);
  for (const auto& [viewer, guest] : guests_.all()) guest->pictures.setMostPreviewPixels(pixels);
}

bool Session::release() {
  if (!resting() || !shared_.isIdle() || !pictures_.hasStarted() || isSaving() ||
      captures_.isPending() || pictures_.stillWaits())
    return false;
  shared_.release();
  pictures_.loseStill();
  for (const auto& [viewer, guest] : guests_.all()) guest->pictures.loseStill();
  return true;
}

void Session::removeGuest(uint32_t viewer) {
  if (!isGuest(viewer)) return;
  guests_.remove(viewer);
  shared_.forget(viewer);
}

void Session::resizeGuest(uint32_t viewer, int width, int height) {
  Guest* const guest = guests_.find(viewer);
  if (!guest) return;
  guest->pictures.resize(width, height);
  guest->pilot.setAspect(double(guest->pictures.width()) / guest->pictures.height());
}

void Session::handleFor(uint32_t viewer, const InputEvent& event) {
  Guest* const guest = guests_.find(viewer);
  if (guest)
    guest->waiting.push_back(event);
  else if (viewer == 0)
    handle(event);
}

const Pilot& Session::pilotOf(uint32_t viewer) const {
  const Guest* const guest = guests_.find(viewer);
  return guest ? guest->pilot : pilot_;
}

const PictureLoop& Session::picturesOf(uint32_t viewer) const {
  const Guest* const guest = guests_.find(viewer);
  return guest ? guest->pictures : pictures_;
}

void Session::capture(uint32_t viewer, uint64_t asker, Captures::Done done) {
  Guest* const guest = guests_.find(viewer);
  const Pilot& pilot = guest ? guest->pilot : pilot_;
  const Fit& fit = guest ? guest->fit : fit_;
  PictureLoop& pictures = guest ? guest->pictures : pictures_;
  // The picture that is shown may be the one that is wanted, or become it.
  if (!captures_.isPending() && pictures.isRefining() && !pictures.isOutdated(pilot, fit)) {
    picture::Picture picture;
    if (pictures.isFinished(pilot)) {
      if (pictures.copyStill(picture)) return done(&picture);
    } else if (shared_.viewer() == (guest ? viewer : 0) && !pictures.isInterrupted() &&
               !shared_.isIdle()) {
      return captures_.adopt(asker, pictures.number(), std::move(done));
    }
  }
  captures_.want({asker, pictures.stillOf(pilot), pictures.headlightOf(pilot),
                  pictures.transformOf(pilot), std::move(done)});
}

bool Session::isQuiet() const {
  const auto quiet = [](const Pilot& pilot, const PictureLoop& pictures, const Fit& fit) {
    return !pilot.isSteering() && !fit.isPending() && pictures.isFinished(pilot);
  };
  return resting() && waiting_.empty() && !inlines_.isLoading() && !captures_.isPending() &&
         quiet(pilot_, pictures_, fit_) &&
         std::all_of(guests_.all().begin(), guests_.all().end(), [&](const auto& one) {
           const Guest& guest = *one.second;
           return guest.waiting.empty() && quiet(guest.pilot, guest.pictures, guest.fit);
         });
}

} // namespace vv
