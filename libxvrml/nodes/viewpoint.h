// viewpoint.h: the fields that all viewpoint nodes have (the abstract type in bindable.node), for
// code that uses any of them. [any thread]
#pragma once

#include <optional>

#include "nodes/bindable.h"

namespace xvrml {

// References to the fields of a viewpoint node; valid as long as the node.
struct ViewpointFields {
  const Vec3f& position;
  const Rotation& orientation;
  const float& fieldOfView;
  const bool& jump;
  const std::string& description;
  Node* shader; // camera shader as written; null: the built-in camera
};

inline bool isViewpoint(const Node* node) {
  return node && bindableStack(node->type()) == BindableStack::viewpoint;
}

inline std::optional<ViewpointFields> viewpointFields(const Node* node) {
  if (!isViewpoint(node)) return std::nullopt;
  // nodegen has checked that the node has the fields of its abstract types.
  const auto at = [&](std::string_view name) { return node->storage(*node->type().find(name)); };
  const FieldInfo* shader = node->type().find("shader");
  return ViewpointFields{*static_cast<const SFVec3f*>(at("position")),
                         *static_cast<const SFRotation*>(at("orientation")),
                         *static_cast<const SFFloat*>(at("fieldOfView")),
                         *static_cast<const SFBool*>(at("jump")),
                         *static_cast<const SFString*>(at("description")),
                         shader ? static_cast<const SFNode*>(node->storage(*shader))->get()
                                : nullptr};
}

} // namespace xvrml
