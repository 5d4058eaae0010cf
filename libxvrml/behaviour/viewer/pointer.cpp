#include "behaviour/viewer/pointer.h"

#include <algorithm>

#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "xvrml/browser.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

bool isTouch(const Node& node) { return node.type().index == nodes::TouchSensor::typeIndex; }

bool isEnabledSensor(Node& node) {
  if (const auto* touch = nodeCast<nodes::TouchSensor>(&node)) return touch->enabled;
  if (const auto* plane = nodeCast<nodes::PlaneSensor>(&node)) return plane->enabled;
  if (const auto* sphere = nodeCast<nodes::SphereSensor>(&node)) return sphere->enabled;
  if (const auto* cylinder = nodeCast<nodes::CylinderSensor>(&node)) return cylinder->enabled;
  return false;
}

const std::vector<NodeRef>* childrenOf(Node& node) {
  if (const Scope* content = inlineScope(node)) return &content->roots;
  if (node.type().index < 0 || !node.type().is("parent")) return nullptr;
  const FieldInfo* children = fieldNamed<"children">(node);
  return children && children->type == FieldType::MFNode
             ? static_cast<MFNode*>(node.storage(*children))
             : nullptr;
}

bool holds(const std::vector<NodeRef>& list, const Node& node) {
  return std::any_of(list.begin(), list.end(), [&](const NodeRef& n) { return n.get() == &node; });
}

Vec3f narrow(const Vector& v) { return {float(v.x), float(v.y), float(v.z)}; }

} // namespace

// Returns the enabled sensors of the lowest group above the geometry that has any; all of them take
// part (4.6.7.3).
std::vector<Pointer::Candidate> Pointer::candidatesOf(const Hit& hit) const {
  std::vector<Candidate> found;
  const auto look = [&](const std::vector<NodeRef>& siblings, const Matrix& toWorld) {
    for (const NodeRef& sibling : siblings)
      if (Node* node = renderedNode(sibling.get()); node && isEnabledSensor(*node))
        found.push_back({NodeRef(node), toWorld});
  };
  for (size_t i = hit.path.size(); i-- > 0 && found.empty();) {
    const Hit::Step& step = hit.path[i];
    if (const auto* children = childrenOf(*step.node)) look(*children, step.toWorld);
    if (auto* anchor = nodeCast<nodes::Anchor>(step.node); anchor && !anchor->url.empty())
      found.push_back({NodeRef(anchor), step.toWorld});
  }
  if (found.empty() && interaction_.scope) look(interaction_.scope->roots, Matrix());
  return found;
}

bool Pointer::isOver(const Node& sensor) const { return holds(over_, sensor); }

// Sends isOver, which all sensors have in X3D (ISO/IEC 19775-1 20.3.2); Anchors have no events.
void Pointer::sendOver(Node& sensor, bool over) {
  if (sensor.type().index != nodes::Anchor::typeIndex)
    sendFrom<"isOver">(interaction_.engine, sensor, over);
}

// While a sensor has grabbed the pointer, no other sensor sends events (4.6.7.3).
void Pointer::setOver(const std::vector<Candidate>& candidates) {
  const auto mayChange = [&](const Node& sensor) {
    return active_.empty() || std::any_of(active_.begin(), active_.end(), [&](const Active& a) {
             return a.sensor.get() == &sensor;
           });
  };
  const auto under = [&](const Node& sensor) {
    return std::any_of(candidates.begin(), candidates.end(),
                       [&](const Candidate& c) { return c.sensor.get() == &sensor; });
  };
  std::erase_if(over_, [&](const NodeRef& sensor) {
    if (!mayChange(*sensor) || under(*sensor)) return false;
    sendOver(*sensor, false);
    return true;
  });
  for (const Candidate& c : candidates) {
    if (!mayChange(*c.sensor) || isOver(*c.sensor)) continue;
    over_.push_back(c.sensor);
    sendOver(*c.sensor, true);
  }
}

// Sends hit events in the sensor's coordinate system (6.51). Normals are transformed by the
// transpose of the inverse point transformation.
void Pointer::touch(const Candidate& candidate, const Hit& hit) {
  Matrix toLocal;
  if (!invert(candidate.toWorld, toLocal)) return;
  Engine& engine = interaction_.engine;
  sendFrom<"hitPoint_changed">(engine, *candidate.sensor,
                               narrow(transformPoint(toLocal, hit.point)));
  sendFrom<"hitNormal_changed">(
      engine, *candidate.sensor,
      narrow(transformDirection(candidate.toWorld.transposed(), hit.normal).normalized()));
  sendFrom<"hitTexCoord_changed">(engine, *candidate.sensor, hit.texCoord);
}

void Pointer::press(const std::vector<Candidate>& candidates, const PickRay& ray, const Hit& hit) {
  for (const Candidate& c : candidates) {
    Matrix toLocal;
    if (!invert(c.toWorld, toLocal)) continue;
    const PickRay local{transformPoint(toLocal, ray.origin),
                        transformDirection(toLocal, ray.direction)};
    active_.push_back(
        {c.sensor, toLocal, beginDrag(*c.sensor, local, transformPoint(toLocal, hit.point))});
    sendFrom<"isActive">(interaction_.engine, *c.sensor, true); // no effect for an Anchor
  }
}

void Pointer::release(bool click) {
  Engine& engine = interaction_.engine;
  for (const Active& a : std::exchange(active_, {})) {
    sendFrom<"isActive">(engine, *a.sensor, false);
    if (a.drag) a.drag->end(engine);
    if (!click || !isOver(*a.sensor)) continue;
    if (isTouch(*a.sensor)) sendFrom<"touchTime">(engine, *a.sensor, engine.now());
    if (a.sensor->type().index == nodes::Anchor::typeIndex) clicked_.push_back(a.sensor);
  }
}

void Pointer::point(const PickRay& ray, bool button) {
  Engine& engine = interaction_.engine;
  if (engine.settling() || !interaction_.scope) return; // a listener must not move the pointer
  Hit hit;
  const PickRules rules{.mayLag = !button && !button_}; // a click must hit what is seen
  const bool hits = interaction_.picker.pick(ray, rules, interaction_.viewer.view(),
                                             interaction_.scope->roots, hit);
  const std::vector<Candidate> candidates = hits ? candidatesOf(hit) : std::vector<Candidate>();
  const bool moved = !pointed_ || ray.origin != last_.origin || ray.direction != last_.direction;
  engine.beginCascade(engine.now());
  if (moved) {
    setOver(candidates);
    for (const Candidate& c : candidates)
      if (isTouch(*c.sensor) && isOver(*c.sensor)) touch(c, hit);
    for (const Active& a : active_)
      if (a.drag)
        a.drag->move(engine, {transformPoint(a.toLocal, ray.origin),
                              transformDirection(a.toLocal, ray.direction)});
  }
  if (button && !button_) {
    setOver(candidates); // count what has moved under a pointer at rest
    press(candidates, ray, hit);
  } else if (!button && button_) {
    release(true);
    setOver(candidates);
  }
  button_ = button;
  last_ = ray;
  pointed_ = true;
  engine.settle();
  for (const NodeRef& anchor : std::exchange(clicked_, {}))
    if (engine.browser()) engine.browser()->activate(*anchor);
}

void Pointer::leave() {
  Engine& engine = interaction_.engine;
  if (engine.settling()) return;
  engine.beginCascade(engine.now());
  release(false);
  setOver({});
  button_ = pointed_ = false;
  engine.settle();
}

// Releases a disabled sensor at once (4.6.7.3). An enabled sensor waits for the pointer to move.
void Pointer::enabledChanged(Node& sensor) {
  Engine& engine = interaction_.engine;
  if (isEnabledSensor(sensor)) return;
  const NodeRef keep(&sensor);
  std::erase_if(active_, [&](const Active& a) {
    if (a.sensor.get() != &sensor) return false;
    sendFrom<"isActive">(engine, sensor, false);
    if (a.drag) a.drag->end(engine);
    return true;
  });
  std::erase_if(over_, [&](const NodeRef& o) {
    if (o.get() != &sensor) return false;
    sendOver(sensor, false);
    return true;
  });
}

bool Pointer::dropAbsent() {
  Engine& engine = interaction_.engine;
  bool dropped = false;
  std::erase_if(active_, [&](const Active& a) {
    if (isInScene(*a.sensor)) return false;
    sendFrom<"isActive">(engine, *a.sensor, false);
    if (a.drag) a.drag->end(engine);
    return dropped = true;
  });
  std::erase_if(over_, [&](const NodeRef& o) {
    if (isInScene(*o)) return false;
    sendOver(*o, false);
    return dropped = true;
  });
  return dropped;
}

void Pointer::forget(const Node& sensor) {
  std::erase_if(active_, [&](const Active& a) { return a.sensor.get() == &sensor; });
  std::erase_if(over_, [&](const NodeRef& o) { return o.get() == &sensor; });
}

std::vector<NodeRef> Pointer::sensors() const {
  if (active_.empty()) return over_;
  std::vector<NodeRef> list;
  for (const Active& a : active_) list.push_back(a.sensor);
  return list;
}

namespace {

void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  if (isField<"enabled">(node, in)) interactionOf(events).pointer.enabledChanged(node);
}

} // namespace

void addPointingBehaviours(const AddBehaviour& add) {
  for (const NodeType* type : nodeTypes())
    if (type->is("pointingSensor")) add(*type, {.receive = receive});
}

} // namespace xvrml
