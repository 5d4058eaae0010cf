#include "session/session_viewers.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace vv {

namespace {

// Removes the next event from the queue. Pointer events stay there if `pointerWaits`. Returns false
// if there is no other.
bool takeEvent(std::deque<InputEvent>& queue, bool pointerWaits, InputEvent& event) {
  const auto found = std::find_if(queue.begin(), queue.end(), [&](const InputEvent& one) {
    return !pointerWaits || one.kind > InputEvent::Kind::wheel;
  });
  if (found == queue.end()) return false;
  event = std::move(*found);
  queue.erase(found);
  return true;
}

} // namespace

void SessionViewer::resize(int width, int height) {
  pictures.resize(width, height);
  pilot.setAspect(double(pictures.width()) / pictures.height());
}

SessionViewers::SessionViewers(xvrml::Browser& browser, double time, const picture::View& view,
                               SharedRenderer& shared, const Options& options)
    : browser_(browser), shared_(shared), options_(options) {
  viewers_[0] = std::make_unique<SessionViewer>(browser, time, view, shared, options);
}

SessionViewer* SessionViewers::find(uint32_t number) {
  const auto found = viewers_.find(number);
  return found == viewers_.end() ? nullptr : found->second.get();
}

const SessionViewer& SessionViewers::findOrOwn(uint32_t number) const {
  const auto found = viewers_.find(number);
  return found == viewers_.end() ? own() : *found->second;
}

SessionViewer& SessionViewers::findOrOwn(uint32_t number) {
  return const_cast<SessionViewer&>(std::as_const(*this).findOrOwn(number));
}

SessionViewer& SessionViewers::add(uint32_t number) {
  std::unique_ptr<SessionViewer>& guest = viewers_[number];
  guest = std::make_unique<SessionViewer>(own().pilot, browser_, shared_, options_, number);
  guest->pictures.setMotion(own().pictures.motion());
  guest->pictures.setMostPreviewPixels(mostPreviewPixels_);
  return *guest;
}

void SessionViewers::remove(uint32_t guest) {
  if (!isGuest(guest)) return;
  InputEvent leaving;
  leaving.kind = InputEvent::Kind::leave;
  find(guest)->pilot.handle(leaving); // a sensor may be in its hand
  viewers_.erase(guest);
  shared_.forget(guest);
}

void SessionViewers::setMostPreviewPixels(double pixels) {
  mostPreviewPixels_ = pixels;
  for (const auto& [number, viewer] : viewers_) viewer->pictures.setMostPreviewPixels(pixels);
}

void SessionViewers::placeGuests() {
  for (const auto& [number, viewer] : viewers_)
    if (number != 0) viewer->pictures.placeViewer(viewer->pilot, viewer->fit);
}

void SessionViewers::stepGuests(double seconds) {
  for (const auto& [number, viewer] : viewers_)
    if (number != 0) viewer->pilot.step(seconds);
}

void SessionViewers::takeGuestEvents(bool pointerWaits, const OnAction& onAction) {
  for (const auto& [number, guest] : viewers_) {
    InputEvent event;
    while (number != 0 && takeEvent(guest->waiting, pointerWaits, event)) {
      const Action action = guest->pilot.handle(event);
      if (action == Action::frameAll || action == Action::beginAgain)
        guest->fit.want(action == Action::beginAgain ? Fit::Direction::initial
                                                     : Fit::Direction::current);
      else if (action >= Action::save)
        onAction(number, event, action);
    }
  }
}

void SessionViewers::noteViews() {
  for (const auto& [number, viewer] : viewers_)
    viewer->noted = {viewer->pilot.camera(), viewer->pilot.aspect()};
}

bool SessionViewers::haveMoved() const {
  return std::any_of(viewers_.begin(), viewers_.end(), [](const auto& one) {
    const Pilot& pilot = one.second->pilot;
    return pilot.isSteering() || one.second->noted != EditView{pilot.camera(), pilot.aspect()};
  });
}

void SessionViewers::takeTurns(double now) {
  using Urgency = PictureLoop::Urgency;
  std::vector<std::pair<uint32_t, SessionViewer*>> turns;
  for (const auto& [number, viewer] : viewers_) turns.emplace_back(number, viewer.get());
  const bool changed = std::any_of(turns.begin(), turns.end(), [](const auto& one) {
    return one.second->urgency() == Urgency::change;
  });
  if (changed) { // begin after the viewer who had the last turn
    const auto next = std::find_if(turns.begin(), turns.end(),
                                   [&](const auto& one) { return one.first > shared_.viewer(); });
    std::rotate(turns.begin(), next, turns.end());
  }
  for (const auto& [number, viewer] : turns) {
    if (changed && viewer->urgency() != Urgency::change) continue;
    viewer->pictures.advance(viewer->pilot, viewer->fit, now, PictureLoop::Need::none);
    if (shared_.isMapping()) return;
  }
}

} // namespace vv
