// pick.h: intersects rays with the running world. Bounding boxes and meshes are cached per node and
// dropped when something below changes. Used by the pointer, navigation and programs. [the
// browser's thread]
#pragma once

#include <memory>
#include <unordered_map>

#include "behaviour/viewer/pick_mesh.h"
#include "event/engine.h"

namespace xvrml {

struct PickRules {
  // Intersects as for collision (clause 6.8): proxies replace children, and collide FALSE hides its
  // children.
  bool collision = false;
  bool bothSides = false; // back faces of solid geometry count too
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
  PickBox bounds(const std::vector<NodeRef>& roots);

  void changed(Node& node);
  void forgotten(const Node& node) { entries_.erase(&node); }
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
  PickMesh* meshOf(Node& shape);

  const Engine& engine_;
  std::unordered_map<const Node*, Entry> entries_;
};

} // namespace xvrml
