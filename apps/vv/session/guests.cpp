#include "session/guests.h"

#include <algorithm>
#include <utility>

namespace vv {

Guest& Guests::add(uint32_t viewer, const Pilot& leader, xvrml::Browser& browser,
                   SharedRenderer& shared, const Options& options) {
  std::unique_ptr<Guest>& guest = guests_[viewer];
  guest = std::make_unique<Guest>(leader, browser, shared, options, viewer);
  return *guest;
}

void Guests::remove(uint32_t viewer) {
  Guest* const guest = find(viewer);
  if (!guest) return;
  InputEvent leaving;
  leaving.kind = InputEvent::Kind::leave;
  guest->pilot.handle(leaving); // a sensor may be in its hand
  guests_.erase(viewer);
}

Guest* Guests::find(uint32_t viewer) {
  const auto found = guests_.find(viewer);
  return found == guests_.end() ? nullptr : found->second.get();
}

const Guest* Guests::find(uint32_t viewer) const { return const_cast<Guests*>(this)->find(viewer); }

void Guests::placeViewers() {
  for (const auto& [viewer, guest] : guests_) guest->pictures.placeViewer(guest->pilot, guest->fit);
}

void Guests::step(double seconds) {
  for (const auto& [viewer, guest] : guests_) guest->pilot.step(seconds);
}

void Guests::takeEvents(bool pointerWaits, const OnAction& onAction) {
  for (const auto& [viewer, guest] : guests_) {
    InputEvent event;
    while (takeEvent(guest->waiting, pointerWaits, event)) {
      const Action action = guest->pilot.handle(event);
      if (action == Action::frameAll || action == Action::beginAgain)
        guest->fit.want(action == Action::beginAgain ? Fit::Direction::initial
                                                     : Fit::Direction::current);
      else if (action >= Action::save)
        onAction(viewer, event, action);
    }
  }
}

bool takeEvent(std::deque<InputEvent>& queue, bool pointerWaits, InputEvent& event) {
  const auto found = std::find_if(queue.begin(), queue.end(), [&](const InputEvent& one) {
    return !pointerWaits || one.kind > InputEvent::Kind::wheel;
  });
  if (found == queue.end()) return false;
  event = std::move(*found);
  queue.erase(found);
  return true;
}

} // namespace vv
