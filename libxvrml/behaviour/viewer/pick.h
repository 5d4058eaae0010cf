// pick.h: what a ray meets in a running world. Bounding boxes and meshes are kept for each node and
// dropped when something below changes. Asked by pointer, navigation and programs. [the browser's
// thread]
#pragma once

#include <memory>
#include <unordered_map>

#include "behaviour/viewer/pick_mesh.h"
#include "event/engine.h"

namespace xvrml {

struct PickRules {
  bool collision = false; // what the viewer collides with: proxies for children, nothing below
                          // collide FALSE (clause 6.8)
  bool bothSides = false; // back faces of solid geometry count
};

struct Hit {
  struct Step {
    Node* node;
    Matrix toWorld; // of the coordinate system of the node's children; a Shape's: of its geometry
  };
  double t;             // along the ray, in lengths of its direction
  Vector point, normal; // in the world; the normal is a unit vector
  Vec2f texCoord;
  std::vector<Step> path; // from a root to the Shape, prototype instances and Inlines included
};

class Picker {
 public:
  explicit Picker(const Engine& engine) : engine_(engine) {}
  // The nearest hit. view: the camera, which decides on levels of detail and turns Billboards.
  // False if there is none.
  bool pick(const PickRay& ray, const PickRules& rules, const Matrix& view,
            const std::vector<NodeRef>& roots, Hit& hit);
  PickBox bounds(const std::vector<NodeRef>& roots);

  void changed(Node& node);
  void forgotten(const Node& node) { entries_.erase(&node); }
  // The coordinate system of the last node's children, with Billboards turned to a viewer.
  static Matrix toWorld(const std::vector<Node*>& path, const Matrix& view);

 private:
  struct Entry {
    bool known = false;
    PickBox bounds; // in the coordinate system that the node stands in
    std::unique_ptr<PickMesh> mesh;
  };
  const PickBox& boundsOf(Node& node);
  PickBox boundsFromParts(Node& node, const std::vector<Node*>& parts);
  const PickMesh* meshOf(Node& shape);

  const Engine& engine_;
  std::unordered_map<const Node*, Entry> entries_;
};

} // namespace xvrml
