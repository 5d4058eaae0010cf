#include "geometry/node_matrix.h"

#include "xvrml/nodes.h"

namespace xvrml {
namespace {

template <class T> Matrix matrixIn(const Node& node) {
  const auto& t = static_cast<const T&>(node);
  return transformMatrix({t.center, t.translation, t.scale, t.rotation, t.scaleOrientation});
}

} // namespace

bool hasMatrix(const Node& node) {
  const int index = node.type().index;
  return index == nodes::Transform::typeIndex || index == nodes::CADPart::typeIndex;
}

Matrix matrixOf(const Node& node) {
  const int index = node.type().index;
  if (index == nodes::Transform::typeIndex) return matrixIn<nodes::Transform>(node);
  if (index == nodes::CADPart::typeIndex) return matrixIn<nodes::CADPart>(node);
  return {};
}

} // namespace xvrml
