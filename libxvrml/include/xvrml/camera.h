// camera.h: the camera, bounds and bound nodes of a world.
#pragma once

namespace xvrml {

class Node;

struct CameraSettings {
  // Camera to world, column-major, rotation and translation only. The camera looks along -z; +y is
  // up.
  double matrix[16];
  double fovy = 0.785398; // radians, vertical; 0: orthographic
  double height = 0;      // height of an orthographic picture in world units
  // An ORTShader that generates the rays; null: the built-in camera. It must outlive these
  // settings.
  Node* shader = nullptr;
};

struct Bounds {
  double minimum[3], maximum[3];
  bool empty = true;
};

// The bindable nodes at the tops of their stacks (clause 4.6.10). Null: none is bound, and the
// standard's defaults apply.
struct BoundNodes {
  Node *viewpoint = nullptr, *background = nullptr, *fog = nullptr, *navigationInfo = nullptr;
  bool operator==(const BoundNodes&) const = default;
};

} // namespace xvrml
