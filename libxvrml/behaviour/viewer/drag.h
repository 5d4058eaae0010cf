// drag.h: what PlaneSensor, SphereSensor and CylinderSensor make of a pointer that is dragged
// (clauses 6.34, 6.44, 6.15). A Drag lives from the press of the button to its release; everything
// is in the sensor's coordinate system as it was at the press. Used by the pointer. [the browser's
// thread]
#pragma once

#include <memory>

#include "behaviour/viewer/pick_mesh.h"
#include "xvrml/behaviour.h"

namespace xvrml {

class Drag {
 public:
  virtual ~Drag() = default;
  virtual void move(Events& events, const PickRay& ray) = 0;
  // autoOffset: the next drag goes on where this one ended.
  virtual void end(Events& events) = 0;
};

// Null if the node is no drag sensor. point: where the ray has hit the geometry.
std::unique_ptr<Drag> beginDrag(Node& sensor, const PickRay& ray, const Vector& point);

} // namespace xvrml
