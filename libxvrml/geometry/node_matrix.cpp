#include "geometry/node_matrix.h"

#include "xvrml/nodes.h"

namespace xvrml {
namespace {

template <class T> Matrix matrixIn(const Node& node) {
  const auto& t = static_cast<const T&>(node);
  return transformMatrix({t.center, t.translation, t.scale, t.rotation, t.scaleOrientation});
}

// The parts of rigid bodies turn about their own origin and are never scaled.
template <class T> Matrix partMatrixIn(const Node& node) {
  const auto& part = static_cast<const T&>(node);
  return transformMatrix({{}, part.translation, {1, 1, 1}, part.rotation, {}});
}
// The center is a place of a globe, which nothing here knows.
Matrix geoMatrix(const Node& node) {
  const auto& t = static_cast<const nodes::GeoTransform&>(node);
  return transformMatrix({{}, t.translation, t.scale, t.rotation, t.scaleOrientation});
}

using MatrixFunction = Matrix (*)(const Node& node);
// Returns the function for a type; null: its nodes have no matrix.
MatrixFunction functionFor(int index) {
  switch (index) {
  case nodes::Transform::typeIndex: return matrixIn<nodes::Transform>;
  case nodes::CADPart::typeIndex: return matrixIn<nodes::CADPart>;
  case nodes::EspduTransform::typeIndex: return matrixIn<nodes::EspduTransform>;
  case nodes::HAnimHumanoid::typeIndex: return matrixIn<nodes::HAnimHumanoid>;
  case nodes::HAnimJoint::typeIndex: return matrixIn<nodes::HAnimJoint>;
  case nodes::HAnimSite::typeIndex: return matrixIn<nodes::HAnimSite>;
  case nodes::GeoTransform::typeIndex: return geoMatrix;
  case nodes::CollidableShape::typeIndex: return partMatrixIn<nodes::CollidableShape>;
  case nodes::CollidableOffset::typeIndex: return partMatrixIn<nodes::CollidableOffset>;
  default: return nullptr;
  }
}

} // namespace

bool hasMatrix(const Node& node) { return functionFor(node.type().index) != nullptr; }

Matrix matrixOf(const Node& node) {
  const MatrixFunction function = functionFor(node.type().index);
  return function ? function(node) : Matrix();
}

} // namespace xvrml
