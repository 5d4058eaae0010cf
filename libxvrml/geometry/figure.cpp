// figure.cpp: linear blend skinning in double precision. A vertex p goes to
//   p + sum over its joints j of weight_j (M_j p - p),
// where M_j is the matrix from the joint to its figure. All joints are the identity at rest
// (ISO/IEC 19774-1 4.9), so a weight that is missing to 1 leaves that part of the vertex at rest.
#include "geometry/figure.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/deformable.h"
#include "geometry/node_matrix.h"
#include "xvrml/deformed.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Vertices that are being moved.
struct Vertices {
  std::vector<Vector> points;
  uint64_t missing = 0; // indices without a vertex
  bool moved = false;

  // Returns the vertex of an index; null: there is none.
  Vector* at(int32_t index) {
    if (index >= 0 && size_t(index) < points.size()) return &points[size_t(index)];
    ++missing;
    return nullptr;
  }
};

struct Joint {
  nodes::HAnimJoint* node;
  Matrix toFigure;
};

// Returns the nodes among which a skeleton goes on below a node; null: it ends here.
const MFNode* skeletonBelow(const Node& node) {
  switch (node.type().index) {
  case nodes::HAnimJoint::typeIndex: return &static_cast<const nodes::HAnimJoint&>(node).children;
  case nodes::HAnimSegment::typeIndex:
    return &static_cast<const nodes::HAnimSegment&>(node).children;
  case nodes::HAnimSite::typeIndex: return &static_cast<const nodes::HAnimSite&>(node).children;
  case nodes::Transform::typeIndex: return &static_cast<const nodes::Transform&>(node).children;
  case nodes::Group::typeIndex: return &static_cast<const nodes::Group&>(node).children;
  default: return nullptr;
  }
}

// Returns the joints of a skeleton in the order of the file. One that stands in several places has
// the first.
std::vector<Joint> jointsOf(const nodes::HAnimHumanoid& figure) {
  struct Open {
    Node* node;
    Matrix above;
  };
  std::vector<Open> open;
  const auto add = [&](const MFNode& list, const Matrix& above) {
    for (size_t i = list.size(); i-- > 0;) open.push_back({renderedNode(list[i].get()), above});
  };
  SeenNodes seen;
  std::vector<Joint> joints;
  add(figure.skeleton, Matrix());
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const MFNode* below = next.node ? skeletonBelow(*next.node) : nullptr;
    if (!below || !seen.insert(next.node)) continue;
    const Matrix toFigure =
        hasMatrix(*next.node) ? compose(next.above, matrixOf(*next.node)) : next.above;
    if (!finite(toFigure)) continue;
    if (auto* joint = nodeCast<nodes::HAnimJoint>(next.node)) joints.push_back({joint, toFigure});
    add(*below, toFigure);
  }
  return joints;
}

// Moves vertices by displacers, each by its weight.
void displace(const MFNode& displacers, Vertices& vertices) {
  for (const NodeRef& one : displacers) {
    const auto* displacer = nodeCast<nodes::HAnimDisplacer>(renderedNode(one.get()));
    if (!displacer) continue;
    const float weight = std::isfinite(displacer->weight) ? displacer->weight : 0;
    const size_t count = std::min(displacer->coordIndex.size(), displacer->displacements.size());
    for (size_t i = 0; i < count; ++i) {
      Vector* const p = vertices.at(displacer->coordIndex[i]);
      if (!p || weight == 0) continue;
      *p += vector(displacer->displacements[i]) * double(weight);
      vertices.moved = true;
    }
  }
}

// Adds what a joint does to the matrices of its vertices.
void blend(const Joint& joint, Vertices& vertices, std::vector<Matrix>& blended) {
  const Matrix change = joint.toFigure - Matrix();
  const bool acts = change != Matrix(0.0);
  vertices.moved = vertices.moved || (acts && !joint.node->skinCoordIndex.empty());
  const MFFloat& weights = joint.node->skinCoordWeight;
  for (size_t i = 0; i < joint.node->skinCoordIndex.size(); ++i) {
    const int32_t index = joint.node->skinCoordIndex[i];
    const float weight = i < weights.size() ? weights[i] : 1;
    if (vertices.at(index) && acts && std::isfinite(weight))
      blended[size_t(index)] += change * double(weight);
  }
}

// Normals are transformed by the matrix of cofactors, which is the inverse transpose but for a
// factor.
Vec3f moveNormal(const Matrix& m, const Vec3f& normal) {
  const auto row = [&](int i) { return Vector(m[i][0], m[i][1], m[i][2]); };
  const Vector a = row(0), b = row(1), c = row(2);
  Vector n = b.cross(c) * normal.x + c.cross(a) * normal.y + a.cross(b) * normal.z;
  if (a.dot(b.cross(c)) < 0) n = -n;
  const double length = n.length();
  if (!(length > 0) || !std::isfinite(length)) return normal;
  return {float(n.x / length), float(n.y / length), float(n.z / length)};
}

template <class T> const T* deformableOf(const Node& node) { return dynamic_cast<const T*>(&node); }
template <class T> T* deformableOf(Node& node) { return dynamic_cast<T*>(&node); }

// Draws vectors in place of the node's own. Returns whether that is a change.
template <class Deformable, class Vectors>
bool show(Deformable& node, std::span<const typename Vectors::value_type> drawn, Vectors vectors) {
  if (drawn.size() == vectors.size() &&
      (drawn.empty() || std::memcmp(drawn.data(), vectors.data(), drawn.size_bytes()) == 0))
    return false;
  node.moved = std::make_unique<Vectors>(std::move(vectors));
  return true;
}

// Returns points in the precision of a node. A point that it cannot hold stays at rest.
template <class V> std::vector<V> pointsAs(const std::vector<V>& rest, const Vertices& vertices) {
  using Number = decltype(V::x);
  std::vector<V> points(rest);
  for (size_t i = 0; i < points.size(); ++i) {
    const Vector& p = vertices.points[i];
    const V moved{Number(p.x), Number(p.y), Number(p.z)};
    if (std::isfinite(moved.x) && std::isfinite(moved.y) && std::isfinite(moved.z))
      points[i] = moved;
  }
  return points;
}

// The node that has the vertices of a figure, in single or in double precision.
class Coordinates {
 public:
  explicit Coordinates(const NodeRef& node) {
    Node* const rendered = renderedNode(node.get());
    if (!rendered) return;
    single_ = deformableOf<DeformableCoordinate>(*rendered);
    exact_ = deformableOf<DeformableCoordinateDouble>(*rendered);
  }
  Node* node() const { return single_ ? static_cast<Node*>(single_) : exact_; }
  Vertices atRest() const {
    Vertices vertices;
    const auto add = [&vertices](const auto& points) {
      vertices.points.reserve(points.size());
      for (const auto& p : points) vertices.points.emplace_back(p.x, p.y, p.z);
    };
    single_ ? add(single_->point) : add(exact_->point);
    return vertices;
  }
  // Draws the vertices where they are now. Returns whether that is a change.
  bool show(const Vertices& vertices) const {
    if (!vertices.moved) return straighten(*node());
    return single_
               ? xvrml::show(*single_, drawnPoints(*single_), pointsAs(single_->point, vertices))
               : xvrml::show(*exact_, drawnPoints(*exact_), pointsAs(exact_->point, vertices));
  }

 private:
  DeformableCoordinate* single_ = nullptr;
  DeformableCoordinateDouble* exact_ = nullptr;
};

DeformableNormal* normalOf(const nodes::HAnimHumanoid& figure) {
  Node* const rendered = renderedNode(figure.skinNormal.get());
  return rendered ? deformableOf<DeformableNormal>(*rendered) : nullptr;
}

void warnOf(const Node& node, const Vertices& vertices, Diagnostics* diagnostics) {
  if (vertices.missing > 0 && diagnostics)
    diagnostics->warn(node.source,
                      fmt::format("{}: {} indices of its joints or displacers are no vertex of the "
                                  "{} that it has; they move nothing",
                                  node.type().name, vertices.missing, vertices.points.size()));
}

// Returns whether a figure was bound in another pose than its rest.
bool hasBindingPose(const nodes::HAnimHumanoid& figure) {
  const auto anyOther = [](const auto& values, const auto& rest) {
    return std::any_of(values.begin(), values.end(),
                       [&](const auto& value) { return !(value == rest); });
  };
  return (figure.skinBindingCoords && !(figure.skinBindingCoords == figure.skinCoord)) ||
         (figure.skinBindingNormals && !(figure.skinBindingNormals == figure.skinNormal)) ||
         anyOther(figure.jointBindingPositions, Vec3f{0, 0, 0}) ||
         anyOther(figure.jointBindingScales, Vec3f{1, 1, 1}) ||
         std::any_of(figure.jointBindingRotations.begin(), figure.jointBindingRotations.end(),
                     [](const Rotation& rotation) { return rotation.angle != 0; });
}

// The skin is bent from its rest, which skinCoord has whatever the binding pose is
// (docs/decisions/0105-skins.md).
void warnOfBindings(const nodes::HAnimHumanoid& figure, Diagnostics* diagnostics) {
  if (!diagnostics || !hasBindingPose(figure)) return;
  diagnostics->warn(figure.source,
                    "HAnimHumanoid: its binding pose (skinBindingCoords, skinBindingNormals and "
                    "jointBinding...) has no effect: the skin is bent from skinCoord, at rest");
}

std::vector<Node*> deformSegment(const nodes::HAnimSegment& segment, Diagnostics* diagnostics) {
  const Coordinates coord(segment.coord);
  if (!coord.node() || segment.displacers.empty()) return {};
  Vertices vertices = coord.atRest();
  displace(segment.displacers, vertices);
  warnOf(segment, vertices, diagnostics);
  if (!coord.show(vertices)) return {};
  return {coord.node()};
}

std::vector<Node*> deformSkin(const nodes::HAnimHumanoid& figure, Diagnostics* diagnostics) {
  warnOfBindings(figure, diagnostics);
  const Coordinates coord(figure.skinCoord);
  if (!coord.node()) return {};
  DeformableNormal* const normal = normalOf(figure);
  const std::vector<Joint> joints = jointsOf(figure);
  Vertices vertices = coord.atRest();
  for (const Joint& joint : joints) displace(joint.node->displacers, vertices);
  std::vector<Matrix> blended(vertices.points.size());
  for (const Joint& joint : joints) blend(joint, vertices, blended);
  warnOf(figure, vertices, diagnostics);
  MFVec3f normals = normal ? normal->vector : MFVec3f();
  const bool fits = normals.size() == blended.size();
  if (normal && !fits && vertices.moved && diagnostics)
    diagnostics->warn(figure.source, fmt::format("HAnimHumanoid: skinNormal has {} normals and "
                                                 "skinCoord {} vertices; the normals stay as they "
                                                 "are at rest",
                                                 normals.size(), blended.size()));
  for (size_t i = 0; vertices.moved && i < blended.size(); ++i) {
    vertices.points[i] = transformPoint(blended[i], vertices.points[i]);
    if (fits) normals[i] = moveNormal(blended[i], normals[i]);
  }
  std::vector<Node*> changed;
  if (coord.show(vertices)) changed.push_back(coord.node());
  if (normal && (vertices.moved && fits ? show(*normal, drawnNormals(*normal), std::move(normals))
                                        : straighten(*normal)))
    changed.push_back(normal);
  return changed;
}

} // namespace

std::span<const Vec3f> drawnPoints(const nodes::Coordinate& node) {
  const auto* deformable = deformableOf<DeformableCoordinate>(node);
  return deformable && deformable->moved ? *deformable->moved : node.point;
}

std::span<const Vec3d> drawnPoints(const nodes::CoordinateDouble& node) {
  const auto* deformable = deformableOf<DeformableCoordinateDouble>(node);
  return deformable && deformable->moved ? *deformable->moved : node.point;
}

std::span<const Vec3f> drawnNormals(const nodes::Normal& node) {
  const auto* deformable = deformableOf<DeformableNormal>(node);
  return deformable && deformable->moved ? *deformable->moved : node.vector;
}

bool deforms(const NodeType& type) {
  return type.index == nodes::HAnimHumanoid::typeIndex ||
         type.index == nodes::HAnimSegment::typeIndex;
}

std::vector<nodes::HAnimJoint*> jointsOfSkeleton(const nodes::HAnimHumanoid& figure) {
  std::vector<nodes::HAnimJoint*> joints;
  for (const Joint& joint : jointsOf(figure)) joints.push_back(joint.node);
  return joints;
}

std::vector<Node*> skinOf(const Node& node) {
  std::vector<Node*> parts;
  const auto add = [&parts](Node* part) {
    if (part) parts.push_back(part);
  };
  if (const auto* figure = nodeCast<nodes::HAnimHumanoid>(&node)) {
    add(Coordinates(figure->skinCoord).node());
    if (!parts.empty()) add(normalOf(*figure)); // without vertices nothing moves
  } else if (const auto* segment = nodeCast<nodes::HAnimSegment>(&node)) {
    if (!segment->displacers.empty()) add(Coordinates(segment->coord).node());
  }
  return parts;
}

bool straighten(Node& part) {
  const auto reset = [](auto* deformable) {
    return std::exchange(deformable->moved, nullptr) != nullptr;
  };
  if (auto* single = deformableOf<DeformableCoordinate>(part)) return reset(single);
  if (auto* exact = deformableOf<DeformableCoordinateDouble>(part)) return reset(exact);
  auto* const normal = deformableOf<DeformableNormal>(part);
  return normal && reset(normal);
}

const FieldInfo& vectorsOf(const Node& part) {
  return *part.type().find(part.type().index == nodes::Normal::typeIndex ? "vector" : "point");
}

std::vector<Node*> deform(const Node& node, Diagnostics* diagnostics) {
  if (const auto* figure = nodeCast<nodes::HAnimHumanoid>(&node))
    return deformSkin(*figure, diagnostics);
  if (const auto* segment = nodeCast<nodes::HAnimSegment>(&node))
    return deformSegment(*segment, diagnostics);
  return {};
}

} // namespace xvrml
