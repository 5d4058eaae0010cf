// springs.cpp: Implements the nodes of springs.node. See docs/node-plugins.md.
#include <cmath>

#include "xvrml/nodes.h"
#include <springs_nodes.h>

namespace {

using namespace xvrml;

// Sweeps a circle along a helix.
NodeRef expandSpring(const Node& node) {
  const auto& spring = static_cast<const nodes::Spring&>(node);
  constexpr int stepsPerTurn = 16, corners = 10;
  constexpr float circle = 6.2831853f;
  auto* tube = new nodes::Extrusion();
  NodeRef made(tube);
  tube->crossSection.clear();
  for (int i = 0; i <= corners; ++i) {
    const float angle = -circle * float(i % corners) / float(corners);
    tube->crossSection.push_back({spring.wire * std::cos(angle), spring.wire * std::sin(angle)});
  }
  tube->spine.clear();
  const int steps = spring.turns * stepsPerTurn;
  for (int i = 0; i <= steps; ++i) {
    const float angle = circle * float(i) / float(stepsPerTurn);
    tube->spine.push_back({spring.radius * std::cos(angle), spring.height * float(i) / float(steps),
                           spring.radius * std::sin(angle)});
  }
  tube->creaseAngle = 1.5f;
  return made;
}

// Uses the field's own nodes as children, so that routes and behaviour keep working.
NodeRef expandHanging(const Node& node) {
  const auto& hanging = static_cast<const nodes::Hanging&>(node);
  auto* place = new nodes::Transform();
  NodeRef made(place);
  place->translation = {0, -hanging.length, 0};
  place->children = hanging.children;
  return made;
}

void receiveCounter(Events& events, Node& node, const FieldInfo& in, const Value&) {
  if (in.name != "count") return;
  auto& counter = static_cast<nodes::Counter&>(node);
  const FieldInfo& value = *counter.type().find("value");
  events.store(node, value, counter.value + 1);
  events.send(node, value, counter.value);
}

} // namespace

const xvrml::NodeImplementation xvrml::nodes::Spring::implementation = {.behaviour = {},
                                                                        .expand = expandSpring};
const xvrml::NodeImplementation xvrml::nodes::Hanging::implementation = {.behaviour = {},
                                                                         .expand = expandHanging};
const xvrml::NodeImplementation xvrml::nodes::Counter::implementation = {
    .behaviour = {.receive = receiveCounter}};
