// viewpoint.h: the common fields of Viewpoint and ORTViewpoint, for code that uses either. [any
// thread]
#pragma once

#include <optional>

#include "xvrml/nodes.h"

namespace xvrml {

// References to the fields of a viewpoint node; valid as long as the node.
struct ViewpointFields {
  const Vec3f& position;
  const Rotation& orientation;
  const float& fieldOfView;
  const bool& jump;
  const std::string& description;
  Node* shader; // as written; null: the built-in camera
};

inline bool isViewpoint(const Node* node) {
  return node && (node->type().index == nodes::Viewpoint::typeIndex ||
                  node->type().index == nodes::ORTViewpoint::typeIndex);
}

inline std::optional<ViewpointFields> viewpointFields(const Node* node) {
  const auto of = [](const auto& v, Node* shader) {
    return ViewpointFields{v.position, v.orientation, v.fieldOfView, v.jump, v.description, shader};
  };
  if (!isViewpoint(node)) return std::nullopt;
  if (node->type().index == nodes::Viewpoint::typeIndex)
    return of(static_cast<const nodes::Viewpoint&>(*node), nullptr);
  const auto& own = static_cast<const nodes::ORTViewpoint&>(*node);
  return of(own, own.shader.get());
}

} // namespace xvrml
