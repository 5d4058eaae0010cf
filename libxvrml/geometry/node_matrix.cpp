#include "geometry/node_matrix.h"

#include <array>

#include "base/globe.h"
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

// Returns the matrix from the axes of a place to geocentric metres.
Matrix frameOf(const GlobePlace& place) {
  const auto row = [](const Vec3d& v, double w) { return std::array{v.x, v.y, v.z, w}; };
  const std::array<double, 4> rows[] = {row(place.east, 0), row(place.up, 0), row(place.south, 0),
                                        row(place.center, 1)};
  Matrix matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix.x[i][j] = rows[i][size_t(j)];
  return matrix;
}

// Returns the matrix of a place on the globe, as the world counts.
Matrix placeIn(const Node& node, const MFString& system, const Vec3d& coordinates) {
  const std::optional<GlobePlace> place = placeOnGlobe(system, coordinates);
  return place ? compose(globeToWorld(node), frameOf(*place)) : Matrix();
}
Matrix locationMatrix(const Node& node) {
  const auto& location = static_cast<const nodes::GeoLocation&>(node);
  return placeIn(node, location.geoSystem, location.geoCoords);
}
Matrix viewpointMatrix(const Node& node) {
  const auto& viewpoint = static_cast<const nodes::GeoViewpoint&>(node);
  return placeIn(node, viewpoint.geoSystem, viewpoint.position);
}

// Acts in the axes of its center, on children in the coordinates of the globe (ISO/IEC 19775-1
// 25.3.10).
Matrix geoMatrix(const Node& node) {
  const auto& t = static_cast<const nodes::GeoTransform&>(node);
  const Matrix frame = placeIn(node, t.geoSystem, t.geoCenter);
  Matrix toFrame;
  if (!invert(frame, toFrame)) return {};
  return compose(
      frame, compose(transformMatrix({{}, t.translation, t.scale, t.rotation, t.scaleOrientation}),
                     toFrame));
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
  case nodes::GeoLocation::typeIndex: return locationMatrix;
  case nodes::GeoViewpoint::typeIndex: return viewpointMatrix;
  case nodes::CollidableShape::typeIndex: return partMatrixIn<nodes::CollidableShape>;
  case nodes::CollidableOffset::typeIndex: return partMatrixIn<nodes::CollidableOffset>;
  default: return nullptr;
  }
}

} // namespace

Matrix globeToWorld(const Node& node) {
  const GlobeOrigin* const origin = globeOriginOf(node);
  if (!origin || !origin->place) return {};
  GlobePlace base = *origin->place;
  if (!origin->turns) base = {base.center, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Matrix toBase;
  return invert(frameOf(base), toBase) ? toBase : Matrix();
}

bool hasMatrix(const Node& node) { return functionFor(node.type().index) != nullptr; }

Matrix matrixOf(const Node& node) {
  const MatrixFunction function = functionFor(node.type().index);
  return function ? function(node) : Matrix();
}

// ISO/IEC 14772-1 6.49, ISO/IEC 19775-1 33.4.6 and 33.4.7.
Matrix textureMatrixOf(const Node* textureTransform) {
  if (const auto* t = nodeCast<nodes::TextureTransform>(textureTransform))
    return textureMatrix(t->center, t->rotation, t->scale, t->translation);
  if (const auto* t = nodeCast<nodes::TextureTransform3D>(textureTransform)) {
    const Vector center = vector(t->center);
    const Matrix turn = compose(scaling(vector(t->scale)), rotation(t->rotation));
    return compose(compose(translation(-center), turn),
                   translation(center + vector(t->translation)));
  }
  Matrix matrix;
  if (const auto* t = nodeCast<nodes::TextureTransformMatrix3D>(textureTransform)) {
    const Matrix4f& given = *t->matrix;
    for (int i = 0; i < 16; ++i) (&matrix.x[0][0])[i] = double(given.m[i]);
  }
  return matrix;
}

} // namespace xvrml
