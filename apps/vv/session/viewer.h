// viewer.h: Declares what a Pilot moves: the world's own viewer, or a guest who looks at the world
// beside it (xvrml/guest.h). [the browser's thread]
#pragma once

#include <cstdint>
#include <memory>

#include "xvrml/browser.h"

namespace vv {

class Viewer {
 public:
  virtual ~Viewer() = default;
  // Tells whether the world knows the viewer: its sensors see it, and its user may stop the time.
  virtual bool isOfWorld() const = 0;
  virtual xvrml::CameraSettings camera(double aspect) const = 0;
  virtual void setAspect(double aspect) = 0;
  virtual void setUp(const double up[3]) = 0;
  virtual void setTransition(double seconds) = 0; // see xvrml::Browser
  virtual void place(const double view[16]) = 0;
  virtual void move(const xvrml::NavigationInput& input, double seconds) = 0;
  virtual xvrml::Navigation navigation() const = 0;
  virtual bool setNavigation(xvrml::Navigation type) = 0;
  // The Viewpoint that the viewer stands at; null: none.
  virtual const xvrml::Node* viewpoint() const = 0;
  // Jumps to the Viewpoint itself, also if the viewer has left it by navigation.
  virtual void goTo(xvrml::Node& viewpoint) = 0;
  virtual void goBack() = 0; // returns to the Viewpoint
  // Goes to the next Viewpoint with a description, or the previous one.
  enum class Step : uint8_t { previous, next };
  virtual void step(Step step) = 0;
};

std::unique_ptr<Viewer> makeWorldViewer(xvrml::Browser& browser);
std::unique_ptr<Viewer> makeGuestViewer(xvrml::Browser& browser);

// Returns the Viewpoints that keys go through: those with a description, or all if none has one.
std::vector<xvrml::ViewpointName> visitedViewpoints(const xvrml::Browser& browser);

} // namespace vv
