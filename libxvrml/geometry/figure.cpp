// figure.cpp: linear blend skinning in double precision. A vertex p goes to
//   p + sum over its joints j of weight_j (M_j p - p),
// where M_j is the matrix from the joint to its figure. All joints are the identity at rest
// (ISO/IEC 19774-1 4.9), so a weight that is missing to 1 leaves that part of the vertex at rest.
#include "geometry/figure.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include "base/deformable.h"
#include "geometry/node_matrix.h"
#include "xvrml/deformed.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

using Vectors = std::vector<Vec3f>;

// Vertices that are being moved.
struct Vertices {
  Vectors points;
  uint64_t missing = 0; // indices without a vertex
  bool moved = false;

  // Returns the vertex of an index; null: there is none.
  Vec3f* at(int32_t index) {
    if (index >= 0 && size_t(index) < points.size()) return &points[size_t(index)];
    ++missing;
    return nullptr;
  }
};

struct Joint {
  const nodes::HAnimJoint* node;
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
    if (const auto* joint = nodeCast<nodes::HAnimJoint>(next.node))
      joints.push_back({joint, toFigure});
    add(*below, toFigure);
  }
  return joints;
}

// Returns where a vertex goes; its former place if floats cannot hold the new one.
Vec3f finiteOr(const Vec3f& former, const Vec3f& moved) {
  return std::isfinite(moved.x) && std::isfinite(moved.y) && std::isfinite(moved.z) ? moved
                                                                                    : former;
}

// Moves vertices by displacers, each by its weight.
void displace(const MFNode& displacers, Vertices& vertices) {
  for (const NodeRef& one : displacers) {
    const auto* displacer = nodeCast<nodes::HAnimDisplacer>(renderedNode(one.get()));
    if (!displacer) continue;
    const float weight = std::isfinite(displacer->weight) ? displacer->weight : 0;
    const size_t count = std::min(displacer->coordIndex.size(), displacer->displacements.size());
    for (size_t i = 0; i < count; ++i) {
      Vec3f* const p = vertices.at(displacer->coordIndex[i]);
      if (!p || weight == 0) continue;
      const Vec3f& d = displacer->displacements[i];
      *p = finiteOr(*p, {p->x + weight * d.x, p->y + weight * d.y, p->z + weight * d.z});
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

Vec3f movePoint(const Matrix& m, const Vec3f& point) {
  const Vector p = transformPoint(m, vector(point));
  return finiteOr(point, {float(p.x), float(p.y), float(p.z)});
}

// Draws vectors in place of the node's own; null: its own. Returns whether that is a change.
template <class T> bool show(T* node, std::span<const Vec3f> drawn, const Vectors* vectors) {
  auto* const deformable = dynamic_cast<Deformable<T>*>(node);
  if (!deformable || (!vectors && !deformable->moved)) return false;
  const bool same =
      vectors && drawn.size() == vectors->size() &&
      (drawn.empty() || std::memcmp(drawn.data(), vectors->data(), drawn.size_bytes()) == 0);
  if (same) return false;
  deformable->moved = vectors ? std::make_unique<Vectors>(*vectors) : nullptr;
  return true;
}

void warnOf(const Node& node, const Vertices& vertices, Diagnostics* diagnostics) {
  if (vertices.missing > 0 && diagnostics)
    diagnostics->warn(node.source,
                      fmt::format("{}: {} indices of its joints or displacers are no vertex of the "
                                  "{} that it has; they move nothing",
                                  node.type().name, vertices.missing, vertices.points.size()));
}

std::vector<Node*> deformSegment(const nodes::HAnimSegment& segment, Diagnostics* diagnostics) {
  auto* const coord = nodeCast<nodes::Coordinate>(renderedNode(segment.coord.get()));
  if (!coord || segment.displacers.empty()) return {};
  Vertices vertices{coord->point};
  displace(segment.displacers, vertices);
  warnOf(segment, vertices, diagnostics);
  if (!show(coord, drawnPoints(*coord), vertices.moved ? &vertices.points : nullptr)) return {};
  return {coord};
}

std::vector<Node*> deformSkin(const nodes::HAnimHumanoid& figure, Diagnostics* diagnostics) {
  auto* const coord = nodeCast<nodes::Coordinate>(renderedNode(figure.skinCoord.get()));
  if (!coord) return {};
  auto* const normal = nodeCast<nodes::Normal>(renderedNode(figure.skinNormal.get()));
  const std::vector<Joint> joints = jointsOf(figure);
  Vertices vertices{coord->point};
  for (const Joint& joint : joints) displace(joint.node->displacers, vertices);
  std::vector<Matrix> blended(vertices.points.size());
  for (const Joint& joint : joints) blend(joint, vertices, blended);
  warnOf(figure, vertices, diagnostics);
  Vectors normals = normal ? normal->vector : Vectors();
  const bool fits = normals.size() == blended.size();
  if (normal && !fits && vertices.moved && diagnostics)
    diagnostics->warn(figure.source, fmt::format("HAnimHumanoid: skinNormal has {} normals and "
                                                 "skinCoord {} vertices; the normals stay as they "
                                                 "are at rest",
                                                 normals.size(), blended.size()));
  for (size_t i = 0; vertices.moved && i < blended.size(); ++i) {
    vertices.points[i] = movePoint(blended[i], vertices.points[i]);
    if (fits) normals[i] = moveNormal(blended[i], normals[i]);
  }
  std::vector<Node*> changed;
  if (show(coord, drawnPoints(*coord), vertices.moved ? &vertices.points : nullptr))
    changed.push_back(coord);
  if (normal && show(normal, drawnNormals(*normal), vertices.moved && fits ? &normals : nullptr))
    changed.push_back(normal);
  return changed;
}

} // namespace

std::span<const Vec3f> drawnPoints(const nodes::Coordinate& node) {
  const auto* deformable = dynamic_cast<const Deformable<nodes::Coordinate>*>(&node);
  return deformable && deformable->moved ? *deformable->moved : node.point;
}

std::span<const Vec3f> drawnNormals(const nodes::Normal& node) {
  const auto* deformable = dynamic_cast<const Deformable<nodes::Normal>*>(&node);
  return deformable && deformable->moved ? *deformable->moved : node.vector;
}

bool deforms(const NodeType& type) {
  return type.index == nodes::HAnimHumanoid::typeIndex ||
         type.index == nodes::HAnimSegment::typeIndex;
}

std::vector<Node*> deform(const Node& node, Diagnostics* diagnostics) {
  if (const auto* figure = nodeCast<nodes::HAnimHumanoid>(&node))
    return deformSkin(*figure, diagnostics);
  if (const auto* segment = nodeCast<nodes::HAnimSegment>(&node))
    return deformSegment(*segment, diagnostics);
  return {};
}

} // namespace xvrml
