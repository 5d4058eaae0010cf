// pick.h: intersects rays with the running world. Bounding boxes and meshes are cached per node and
// dropped when something below changes. Used by the pointer, navigation and programs. [the
// browser's thread; large meshes are prepared on others, which have copies of their nodes]
#pragma once

#include <memory>
#include <unordered_map>

#include "behaviour/viewer/pick_mesh.h"
#include "event/engine.h"
#include "geometry/geometry_jobs.h"

namespace xvrml {

struct PickRules {
  // Intersects as for collision (clause 6.8): proxies replace children, and collide FALSE hides its
  // children.
  bool collision = false;
  bool bothSides = false; // back faces of solid geometry count too
  // The ray of a moving picture: with Picker::setLagging it passes through large meshes that are
  // not prepared yet.
  bool mayLag = false;
};

struct Hit {
  struct Step {
    Node* node;
    Matrix toWorld; // children's coordinates (for a Shape, its geometry's) to world
  };
  double t;             // distance along the ray, in lengths of its direction
  Vector point, normal; // place and unit normal in world coordinates
  Vec2f texCoord;
  // Path of nodes from a root to the Shape, prototype instances and Inlines included.
  std::vector<Step> path;
};

class Picker {
 public:
  explicit Picker(const Engine& engine) : engine_(engine) {}
  // Finds the nearest hit. view: the camera, which selects levels of detail and turns Billboards.
  // Returns false if nothing is hit.
  bool pick(const PickRay& ray, const PickRules& rules, const Matrix& view,
            const std::vector<NodeRef>& roots, Hit& hit);
  // mayLag: as in PickRules.
  PickBox bounds(const std::vector<NodeRef>& roots, bool mayLag = false);
  // If true, large meshes are prepared beside the world for those who may lag. False: everybody
  // waits for them, so that the same input gives the same world; this is the default.
  void setLagging(bool lagging) { lagging_ = lagging; }

  void changed(Node& node);
  void forgotten(const Node& node) {
    jobs_.giveUp(node);
    entries_.erase(&node);
  }
  // Returns the world matrix of the last node's children, with Billboards turned to the viewer.
  static Matrix toWorld(const std::vector<Node*>& path, const Matrix& view);

 private:
  struct Entry {
    bool known = false;
    PickBox bounds; // bounds in the coordinate system of the node's parent
    std::unique_ptr<PickMesh> mesh;
  };
  const PickBox& boundsOf(Node& node);
  PickBox boundsFromParts(Node& node, const std::vector<Node*>& parts);
  PickMesh* meshOf(Node& shape); // null: there is none, or it is not prepared yet
  void settleJobs(bool mayLag);
  void dropEntries(Node& first);

  using Jobs = GeometryJobs<std::unique_ptr<PickMesh>>;
  const Engine& engine_;
  Jobs jobs_;
  bool lagging_ = false, lags_ = false; // lags_: the present ray does
  std::unordered_map<const Node*, Entry> entries_;
};

} // namespace xvrml
