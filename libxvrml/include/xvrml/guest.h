// guest.h: a further viewer of a running world, for somebody who looks at it beside the user. The
// world does not know a guest: no sensor, Collision or bindable node gets an event because of one.
// [the browser's thread]
#pragma once

#include <memory>

#include "xvrml/browser.h"

namespace xvrml {

class Guest {
 public:
  // The guest stands where the world's viewer stands. The browser must outlive it.
  explicit Guest(Browser& browser);
  ~Guest();
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;

  // Returns the camera at the guest's position. aspect: width / height.
  CameraSettings camera(double aspect) const;
  // Places the guest, which stays attached to its Viewpoint. view: as for Browser::placeViewer.
  void place(const double view[16]);
  // Jumps to a Viewpoint, which then carries the guest along. Does nothing for another node.
  void goTo(Node& viewpoint);
  // Returns the Viewpoint that carries the guest; null: none, or it has left the world.
  Node* viewpoint() const;
  // Sets the direction that is up while no Viewpoint carries the guest. An invalid one is ignored.
  void setUp(const double up[3]);
  // Returns the navigation type in use: of those that the bound NavigationInfo lists, the chosen
  // one, else the first.
  Navigation navigation() const;
  bool setNavigation(Navigation type); // returns false if the bound NavigationInfo forbids it
  // Moves the guest for dt seconds, with the speed, size and obstacles of the world's viewer.
  void navigate(const NavigationInput& input, double dt);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace xvrml
