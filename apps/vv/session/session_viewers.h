// session_viewers.h: The people who look at a session's world. Each has a pilot and pictures.
// Number 0 is the one whose viewer the world knows; the others are guests, who have views of their
// own. Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>

#include "edit/edit_model.h"
#include "session/fit.h"
#include "session/picture_loop.h"
#include "session/pilot.h"

namespace vv {

struct SessionViewer {
  // Makes the viewer that the world knows. time, view: as for Pilot.
  SessionViewer(xvrml::Browser& browser, double time, const picture::View& view,
                SharedRenderer& shared, const Options& options)
      : pilot(browser, time, view), pictures(shared, options, 0) {}
  // Makes a guest at the place of `leader`.
  SessionViewer(const Pilot& leader, xvrml::Browser& browser, SharedRenderer& shared,
                const Options& options, uint32_t number)
      : pilot(leader, browser), pictures(shared, options, number) {}

  // Sets the size of the pictures in pixels.
  void resize(int width, int height);
  // Tells whether the last frame does not show the world as it is now.
  bool isOutdated() const { return pictures.isOutdated(pilot, fit); }
  // Returns whether the viewer stands where the first picture, or one of the whole world, shows it.
  bool isPlaced() const { return !fit.isPending(); }
  PictureLoop::Urgency urgency() const { return pictures.urgency(pilot, fit); }
  // Tells whether nothing moves or is to be drawn for this viewer.
  bool isQuiet() const {
    return waiting.empty() && !pilot.isSteering() && !fit.isPending() && pictures.isFinished(pilot);
  }

  Pilot pilot;
  PictureLoop pictures;
  Fit fit;
  std::deque<InputEvent> waiting;
  EditView noted; // the view when it was noted last
};

class SessionViewers {
 public:
  // The arguments are those of SessionViewer, and must live as long.
  SessionViewers(xvrml::Browser& browser, double time, const picture::View& view,
                 SharedRenderer& shared, const Options& options);

  // The viewer that the world knows.
  SessionViewer& own() { return *viewers_.begin()->second; }
  const SessionViewer& own() const { return *viewers_.begin()->second; }
  // Returns null if there is no such viewer.
  SessionViewer* find(uint32_t number);
  // Returns the viewer that the world knows if there is no such viewer.
  SessionViewer& findOrOwn(uint32_t number);
  const SessionViewer& findOrOwn(uint32_t number) const;
  // Indexed by number.
  const std::map<uint32_t, std::unique_ptr<SessionViewer>>& all() const { return viewers_; }

  bool hasGuests() const { return viewers_.size() > 1; }
  bool isGuest(uint32_t number) const { return number != 0 && viewers_.count(number) != 0; }
  // Adds a guest who stands where viewer 0 stands. number: one that no other viewer has, not 0.
  SessionViewer& add(uint32_t number);
  void remove(uint32_t guest);
  // Bounds the pixels of each viewer's previews, also of those who come later.
  void setMostPreviewPixels(double pixels);

  // Places guests whose frame has found the extent of the world.
  void placeGuests();
  void stepGuests(double seconds);
  // Handles the guests' input that waits. Pointer events stay in the queue while `pointerWaits`.
  // onAction receives the actions that are not the pilot's.
  using OnAction = std::function<void(uint32_t viewer, const InputEvent& event, Action action)>;
  void takeGuestEvents(bool pointerWaits, const OnAction& onAction);

  // Note all views, and tell whether some have changed since, or are about to by a user.
  void noteViews();
  bool haveMoved() const;

  // Lets the viewers draw: those for whom something has changed, each in turn, or else those whose
  // picture could be better, in the order of their numbers. now: time of any clock.
  void takeTurns(double now);

 private:
  xvrml::Browser& browser_;
  SharedRenderer& shared_;
  const Options& options_;
  std::map<uint32_t, std::unique_ptr<SessionViewer>> viewers_;
  double mostPreviewPixels_ = 0; // 0: there is no bound
};

} // namespace vv
