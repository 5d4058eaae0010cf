// camera.h: where a world is looked at from.
#pragma once

namespace xvrml {

class Node;

struct CameraSettings {
  double matrix[16]; // camera to world, column-major, rotation and translation only; looks along
                     // -z, +y up
  double fovy = 0.785398; // radians, vertical; 0: orthographic
  double height = 0;      // orthographic: world units
  Node* shader = nullptr; // an ORTShader that makes the rays; null: the stock camera. It must live
                          // as long as the settings
};

struct Bounds {
  double minimum[3], maximum[3];
  bool empty = true;
};

// The bindable nodes at the tops of their stacks (clause 4.6.10); null: none is bound, the
// standard's defaults hold.
struct BoundNodes {
  Node *viewpoint = nullptr, *background = nullptr, *fog = nullptr, *navigationInfo = nullptr;
  bool operator==(const BoundNodes&) const = default;
};

} // namespace xvrml
