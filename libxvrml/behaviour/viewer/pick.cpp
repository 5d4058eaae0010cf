// pick.cpp: finds the nearest hit of a ray. The walk over the world uses an explicit stack, so
// nesting costs no C++ stack.
#include "behaviour/viewer/pick.h"

#include <algorithm>
#include <cmath>

#include "event/hierarchy.h"
#include "geometry/clip_planes.h"
#include "geometry/descend.h"
#include "geometry/node_matrix.h"
#include "nodes/visible.h"
#include "xvrml/browser.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// The number of nodes that one ray may visit. Scenes built by events have no limit of their own.
constexpr size_t maximumSteps = 4'000'000;

// Appends the children that any viewer may see (all levels of an LOD), and proxies. A node that is
// invisible has empty bounds, which no ray hits.
void partsOf(Node& node, std::vector<Node*>& parts) {
  if (node.type().index == nodes::Shape::typeIndex || !isVisible(node)) return;
  if (const auto* choice = nodeCast<nodes::Switch>(&node)) {
    if (Node* chosen = chosenChild(*choice)) parts.push_back(chosen);
    return;
  }
  if (const auto* layer = nodeCast<nodes::CADLayer>(&node)) {
    return appendShownChildren(*layer, parts);
  }
  childrenInScene(node, parts);
}

// Appends the children that a ray with these rules may hit.
void appendHitCandidates(Node& node, const PickRules& rules, const Matrix& toWorld,
                         const Matrix& view, std::vector<Node*>& parts) {
  if (const auto* lod = nodeCast<nodes::LOD>(&node)) {
    if (!lod->level.empty()) parts.push_back(lod->level[levelFor(*lod, toWorld, view)].get());
  } else if (auto* collision = nodeCast<nodes::Collision>(&node)) {
    if (rules.collision && !collision->collide) return;
    if (rules.collision && collision->proxy) return parts.push_back(collision->proxy.get());
    for (const NodeRef& child : collision->children) parts.push_back(child.get());
  } else {
    partsOf(node, parts);
  }
}

// Holds what a ray may still hit: the part of it that ClipPlanes leave (ISO/IEC 19775-1 11.4.1).
struct Interval {
  double nearest, farthest;
  size_t planes = 0; // that have shortened it
};

// Shortens the interval to what the ClipPlanes among the children leave. toWorld: matrix of the
// children.
void shorten(Interval& interval, const std::vector<Node*>& children, const PickRay& ray,
             const Matrix& toWorld) {
  Matrix toLocal;
  if (!invert(toWorld, toLocal)) return;
  forEachHalfSpace(children, interval.planes, [&](const HalfSpace& kept) {
    const double distance = kept.distance(transformPoint(toLocal, ray.origin));
    const double approach = kept.normal.dot(transformDirection(toLocal, ray.direction));
    if (approach > 0)
      interval.nearest = std::max(interval.nearest, -distance / approach);
    else if (approach < 0)
      interval.farthest = std::min(interval.farthest, -distance / approach);
    else if (distance < 0)
      interval.farthest = -1;
  });
}

// Reduces the bounds of children to what ClipPlanes among them leave.
void cutByClipPlanes(PickBox& box, const std::vector<Node*>& children) {
  size_t planes = 0;
  forEachHalfSpace(children, planes, [&](const HalfSpace& kept) { box.cut(kept); });
}

} // namespace

void Picker::changed(Node& first) {
  if (!entries_.empty()) dropEntries(first);
}

// Drops what is known of a node and of all that holds it.
void Picker::dropEntries(Node& first) {
  std::vector<Node*> open{&first};
  while (!open.empty()) {
    Node* node = open.back();
    open.pop_back();
    jobs_.giveUp(*node);
    const auto found = entries_.find(node);
    // If a group or Shape has no entry, nothing above it has one.
    if (found != entries_.end())
      entries_.erase(found);
    else if (node != &first &&
             (node->type().index == nodes::Shape::typeIndex || node->type().is("grouping")))
      continue;
    if (!node->live) continue;
    for (Node* parent : liveOf(*node)->parents) open.push_back(parent);
  }
}

PickMesh* Picker::meshOf(Node& node) {
  const auto& shape = static_cast<nodes::Shape&>(node);
  Node* geometry = renderedNode(shape.geometry.get());
  if (!geometry) return nullptr;
  Entry& entry = entries_[geometry];
  if (entry.mesh) return entry.mesh.get();
  Browser* const browser = engine_.browser();
  const Limits limits = browser ? browser->world().options.limits : Limits();
  const auto prepare = [limits](const NodeRef& copy) {
    auto mesh = std::make_unique<PickMesh>(*copy, &limits);
    mesh->prepare();
    return mesh;
  };
  if (lags_ && jobs_.ask(*geometry, prepare) != Jobs::State::none) return nullptr;
  entry.mesh = std::make_unique<PickMesh>(*geometry, browser ? &limits : nullptr);
  return entry.mesh.get();
}

// Takes over the meshes that are prepared. Those who may not lag wait for all of them.
void Picker::settleJobs(bool mayLag) {
  lags_ = lagging_ && mayLag;
  if (jobs_.empty()) return;
  for (const NodeRef& geometry : jobs_.nodes(true))
    if (!geometry->live || liveOf(*geometry)->parents.size() == 0) jobs_.giveUp(*geometry);
  for (const NodeRef& geometry : jobs_.nodes(!lags_)) {
    auto mesh = jobs_.take(*geometry);
    dropEntries(*geometry); // the boxes around it lack the mesh
    if (mesh) entries_[geometry.get()].mesh = std::move(*mesh);
  }
}

PickBox Picker::boundsFromParts(Node& node, const std::vector<Node*>& parts) {
  PickBox box;
  if (node.type().index == nodes::Shape::typeIndex) {
    if (const PickMesh* mesh = isVisible(node) ? meshOf(node) : nullptr) box = mesh->bounds();
    return box;
  }
  for (Node* part : parts)
    if (part) box.extend(entries_[part].bounds);
  cutByClipPlanes(box, parts);
  if (box.empty()) return box;
  PickBox outer;
  if (hasMatrix(node)) {
    Matrix inner;
    if (innerMatrix(node, Matrix(), Matrix(), inner)) outer.extend(box, inner);
  } else if (node.type().index == nodes::Billboard::typeIndex) { // for any rotation
    const Vector far(std::max(std::abs(box.low.x), std::abs(box.high.x)),
                     std::max(std::abs(box.low.y), std::abs(box.high.y)),
                     std::max(std::abs(box.low.z), std::abs(box.high.z)));
    outer.extend(Vector(far.length()));
    outer.extend(Vector(-far.length()));
  } else {
    return box;
  }
  outer.pad();
  return outer;
}

const PickBox& Picker::boundsOf(Node& first) {
  if (const auto found = entries_.find(&first); found != entries_.end() && found->second.known)
    return found->second.bounds;
  std::vector<Node*> open{&first}, parts;
  while (!open.empty()) {
    Node* node = open.back();
    if (entries_[node].known) {
      open.pop_back();
      continue;
    }
    parts.clear();
    partsOf(*node, parts);
    bool ready = true;
    for (Node* part : parts) {
      if (!part || entries_[part].known) continue;
      open.push_back(part);
      ready = false;
    }
    if (!ready) continue;
    const PickBox box = boundsFromParts(*node, parts);
    Entry& entry = entries_[node];
    entry.bounds = box;
    entry.known = true;
    open.pop_back();
  }
  return entries_[&first].bounds;
}

PickBox Picker::bounds(const std::vector<NodeRef>& roots, bool mayLag) {
  settleJobs(mayLag);
  PickBox box;
  std::vector<Node*> parts;
  for (const NodeRef& root : roots) {
    if (root) box.extend(boundsOf(*root));
    parts.push_back(root.get());
  }
  cutByClipPlanes(box, parts);
  return box;
}

bool Picker::pick(const PickRay& whole, const PickRules& rules, const Matrix& view,
                  const std::vector<NodeRef>& roots, Hit& hit) {
  const double probe = whole.origin.dot(whole.origin) + whole.direction.dot(whole.direction);
  if (!std::isfinite(probe) || !(whole.direction.length() > 0)) return false;
  settleJobs(rules.mayLag);
  constexpr uint32_t none = ~0u, stale = none - 1;
  struct Visit {
    Node* node;
    uint32_t parent; // index into `ancestors`
  };
  PickRay ray = whole;
  std::vector<Visit> open;
  std::vector<Hit::Step> ancestors; // from a root down to the current node
  std::vector<Interval> intervals;  // what is left of the ray below each of them
  std::vector<Node*> parts;
  bool found = false;
  MeshHit best{};
  for (size_t i = roots.size(); i-- > 0;)
    if (roots[i]) open.push_back({roots[i].get(), none});
  for (const NodeRef& root : roots) parts.push_back(root.get());
  Interval ofRoots{whole.nearest, whole.farthest};
  shorten(ofRoots, parts, whole, Matrix());
  // A ray is transformed into a parent's coordinate system once, not once per child.
  uint32_t movedFor = stale;
  PickRay moved = ray;
  bool movable = true;
  for (size_t steps = 0; !open.empty() && steps < maximumSteps; ++steps) {
    const Visit visit = open.back();
    open.pop_back();
    ancestors.resize(visit.parent + 1); // drops the finished subtrees; none + 1 is 0
    intervals.resize(visit.parent + 1);
    const Interval interval = visit.parent == none ? ofRoots : intervals[visit.parent];
    const Matrix outside = visit.parent == none ? Matrix() : ancestors[visit.parent].toWorld;
    if (visit.parent != movedFor) {
      Matrix toLocal;
      movable = invert(outside, toLocal);
      moved = {transformPoint(toLocal, whole.origin), transformDirection(toLocal, whole.direction),
               whole.nearest, whole.farthest};
      movedFor = visit.parent;
    }
    if (!movable) continue;
    moved.nearest = interval.nearest;
    moved.farthest = std::min(ray.farthest, interval.farthest);
    if (!(moved.nearest <= moved.farthest)) continue;
    if (!moved.intersects(boundsOf(*visit.node))) continue;
    if (visit.node->type().index == nodes::Shape::typeIndex) {
      MeshHit meshHit;
      PickMesh* const mesh = meshOf(*visit.node);
      if (!mesh || !mesh->intersect(moved, rules.bothSides, meshHit) ||
          (found && meshHit.t >= best.t))
        continue;
      best = meshHit;
      ray.farthest = best.t;
      found = true;
      hit.path = ancestors;
      hit.path.push_back({visit.node, outside});
      continue;
    }
    Matrix inner;
    if (!innerMatrix(*visit.node, outside, view, inner)) continue;
    parts.clear();
    appendHitCandidates(*visit.node, rules, outside, view, parts);
    const uint32_t index = uint32_t(ancestors.size());
    ancestors.push_back({visit.node, inner});
    intervals.push_back(interval);
    shorten(intervals.back(), parts, whole, inner);
    if (movedFor == index) movedFor = stale; // another node now has this index
    for (size_t i = parts.size(); i-- > 0;)
      if (parts[i]) open.push_back({parts[i], index});
  }
  if (!found) return false;
  hit.t = best.t;
  hit.point = whole.at(best.t);
  hit.texCoord = best.texCoord;
  // Normals are transformed by the transpose of the inverse.
  Matrix inverse;
  invert(hit.path.back().toWorld, inverse);
  hit.normal = transformDirection(inverse.transposed(), best.normal).normalized();
  return true;
}

Matrix Picker::toWorld(const std::vector<Node*>& path, const Matrix& view) {
  Matrix matrix;
  for (const Node* node : path) {
    Matrix inner;
    if (!innerMatrix(*node, matrix, view, inner) && !finite(inner)) return matrix;
    matrix = inner;
  }
  return matrix;
}

} // namespace xvrml
