// viewpoint.h: the fields that viewpoint nodes have (the abstract type in bindable.node), for code
// that uses any of them. [any thread]
#pragma once

#include <optional>

#include "nodes/bindable.h"

namespace xvrml {

// References to the fields of a viewpoint node; valid as long as the node. A pointer is null if the
// node's type lacks the field.
struct ViewpointFields {
  const Vec3f& position;
  const Rotation& orientation;
  const bool& jump;
  const std::string& description;
  const float* fieldOfView;      // angle of a view in perspective
  const MFFloat* extent;         // left, bottom, right, top of a view in parallel projection
  const Vec3f* centerOfRotation; // a field of X3D
  const bool* retainUserOffsets; // a field of X3D
  const bool* viewAll;           // a field of X3D
  Node* navigationInfo;          // a field of X3D, as written; null: none
  Node* shader;                  // camera shader as written; null: the built-in camera
};

inline bool isViewpoint(const Node* node) {
  return node && bindableStack(node->type()) == BindableStack::viewpoint;
}

inline std::optional<ViewpointFields> viewpointFields(const Node* node) {
  if (!isViewpoint(node)) return std::nullopt;
  const auto at = [&](std::string_view name, FieldType type) -> const void* {
    const FieldInfo* field = node->type().find(name);
    return field && field->type == type ? node->storage(*field) : nullptr;
  };
  const auto* info = static_cast<const SFNode*>(at("navigationInfo", FieldType::SFNode));
  const auto* shader = static_cast<const SFNode*>(at("shader", FieldType::SFNode));
  // nodegen has checked that the node has the fields of its abstract type, which are not optional.
  // A GeoViewpoint is placed by its matrix (geometry/node_matrix.h), not by its position.
  static const SFVec3f origin;
  const auto* position = static_cast<const SFVec3f*>(at("position", FieldType::SFVec3f));
  return ViewpointFields{position ? *position : origin,
                         *static_cast<const SFRotation*>(at("orientation", FieldType::SFRotation)),
                         *static_cast<const SFBool*>(at("jump", FieldType::SFBool)),
                         *static_cast<const SFString*>(at("description", FieldType::SFString)),
                         static_cast<const SFFloat*>(at("fieldOfView", FieldType::SFFloat)),
                         static_cast<const MFFloat*>(at("fieldOfView", FieldType::MFFloat)),
                         static_cast<const SFVec3f*>(at("centerOfRotation", FieldType::SFVec3f)),
                         static_cast<const SFBool*>(at("retainUserOffsets", FieldType::SFBool)),
                         static_cast<const SFBool*>(at("viewAll", FieldType::SFBool)),
                         info ? info->get() : nullptr,
                         shader ? shader->get() : nullptr};
}

} // namespace xvrml
