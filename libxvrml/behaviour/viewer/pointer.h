// pointer.h: the pointing device (clause 4.6.7.3): which sensors a ray is over, which of them have
// grabbed it, and their events. Anchors take part as TouchSensors. [the browser's thread]
#pragma once

#include "behaviour/viewer/drag.h"
#include "behaviour/viewer/pick.h"

namespace xvrml {

class Interaction;

class Pointer {
 public:
  explicit Pointer(Interaction& interaction) : interaction_(interaction) {}

  // The pointer points along a ray in world coordinates; button: it is pressed. One cascade.
  void point(const PickRay& ray, bool button);
  // The pointer is nowhere, its button released: nothing is over any more, what is active ends
  // without a click.
  void leave();
  // A sensor's enabled has changed.
  void enabledChanged(Node& sensor);
  // Sensors that have left the scene let go. True if there was one.
  bool dropAbsent();
  void forget(const Node& sensor); // no longer part of the world
  // Sensors and Anchors under the pointer, or those that have grabbed it.
  std::vector<NodeRef> sensors() const;

 private:
  struct Candidate {
    NodeRef sensor;
    Matrix toWorld; // of the coordinate system it stands in
  };
  struct Active {
    NodeRef sensor;
    Matrix toLocal;
    std::unique_ptr<Drag> drag; // null: TouchSensor, Anchor
  };
  std::vector<Candidate> candidatesOf(const Hit& hit) const;
  bool isOver(const Node& sensor) const;
  void setOver(const std::vector<Candidate>& candidates);
  void touch(const Candidate& candidate, const Hit& hit);
  void press(const std::vector<Candidate>& candidates, const PickRay& ray, const Hit& hit);
  void release(bool click);

  Interaction& interaction_;
  std::vector<NodeRef>
      over_; // TouchSensors whose isOver is TRUE, drag sensors and Anchors under the pointer
  std::vector<Active> active_; // those that have grabbed the pointer
  std::vector<NodeRef> clicked_;
  PickRay last_{};
  bool button_ = false, pointed_ = false;
};

} // namespace xvrml
