// drag.h: the output of PlaneSensor, SphereSensor and CylinderSensor while the pointer is dragged
// (clauses 6.34, 6.44, 6.15). A Drag lives from the press of the button to its release. Everything
// is in the sensor's coordinate system at the time of the press. Used by the pointer. [the
// browser's thread]
#pragma once

#include <memory>

#include "behaviour/viewer/pick_mesh.h"
#include "xvrml/behaviour.h"

namespace xvrml {

class Drag {
 public:
  virtual ~Drag() = default;
  virtual void move(Events& events, const PickRay& ray) = 0;
  // Ends the drag. With autoOffset the next drag continues from here.
  virtual void end(Events& events) = 0;
};

// Returns null if the node is no drag sensor. point: where the ray hits the geometry.
std::unique_ptr<Drag> beginDrag(Node& sensor, const PickRay& ray, const Vector& point);

} // namespace xvrml
