// pointer.h: the pointing device (clause 4.6.7.3): the sensors that its ray is over, those that
// have grabbed it, and their events. Anchors are treated as TouchSensors. [the browser's thread]
#pragma once

#include "behaviour/viewer/drag.h"
#include "behaviour/viewer/pick.h"

namespace xvrml {

class Interaction;

class Pointer {
 public:
  explicit Pointer(Interaction& interaction) : interaction_(interaction) {}

  // Points along a ray in world coordinates, in one cascade. button: whether the button is pressed.
  void point(const PickRay& ray, bool button);
  // Takes the pointer away with its button released: nothing is under it any more, and active
  // sensors end without a click.
  void leave();
  // Called when a sensor's `enabled` has changed.
  void enabledChanged(Node& sensor);
  // Releases sensors that have left the scene. Returns whether there was one.
  bool dropAbsent();
  void forget(const Node& sensor); // the sensor is no longer part of the world
  // Returns the sensors and Anchors that have grabbed the pointer, else those under it.
  std::vector<NodeRef> sensors() const;

 private:
  struct Candidate {
    NodeRef sensor;
    Matrix toWorld; // matrix from the sensor's parent coordinate system to the world
  };
  struct Active {
    NodeRef sensor;
    Matrix toLocal;
    std::unique_ptr<Drag> drag; // null for a TouchSensor or Anchor
  };
  std::vector<Candidate> candidatesOf(const Hit& hit) const;
  bool isOver(const Node& sensor) const;
  void sendOver(Node& sensor, bool over);
  void setOver(const std::vector<Candidate>& candidates);
  void touch(const Candidate& candidate, const Hit& hit);
  void press(const std::vector<Candidate>& candidates, const PickRay& ray, const Hit& hit);
  void release(bool click);

  Interaction& interaction_;
  // Sensors with isOver TRUE, and Anchors under the pointer
  std::vector<NodeRef> over_;
  std::vector<Active> active_; // sensors that have grabbed the pointer
  std::vector<NodeRef> clicked_;
  PickRay last_{};
  bool button_ = false, pointed_ = false;
};

} // namespace xvrml
