// guests.h: The people who look at a session's world with views of their own, beside the one whose
// viewer the world knows. Each has a pilot and pictures. Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>

#include "session/fit.h"
#include "session/picture_loop.h"
#include "session/pilot.h"

namespace vv {

struct Guest {
  Guest(const Pilot& leader, xvrml::Browser& browser, SharedRenderer& shared,
        const Options& options, uint32_t viewer)
      : pilot(leader, browser), pictures(shared, options, viewer) {}

  Pilot pilot;
  PictureLoop pictures;
  Fit fit;
  std::deque<InputEvent> waiting;
};

class Guests {
 public:
  // Makes a guest at the place of `leader`. viewer: a number that no other viewer has, not 0.
  Guest& add(uint32_t viewer, const Pilot& leader, xvrml::Browser& browser, SharedRenderer& shared,
             const Options& options);
  void remove(uint32_t viewer);
  // Returns null if there is no such guest.
  Guest* find(uint32_t viewer);
  const Guest* find(uint32_t viewer) const;

  // Places guests whose frame has found the extent of the world.
  void placeViewers();
  void step(double seconds);
  // Handles the input that waits. Pointer events stay in the queue while `pointerWaits`. onAction
  // receives the actions that are not the pilot's.
  using OnAction = std::function<void(uint32_t viewer, const InputEvent& event, Action action)>;
  void takeEvents(bool pointerWaits, const OnAction& onAction);

  const std::map<uint32_t, std::unique_ptr<Guest>>& all() const { return guests_; }

 private:
  std::map<uint32_t, std::unique_ptr<Guest>> guests_;
};

// Removes the next event from the queue. Pointer events stay there if `pointerWaits`. Returns false
// if there is no other.
bool takeEvent(std::deque<InputEvent>& queue, bool pointerWaits, InputEvent& event);

} // namespace vv
