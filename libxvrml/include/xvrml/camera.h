// camera.h: the camera, bounds and bound nodes of a world. [any thread]
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

  // Numbers that are none (NaN) equal each other, so that each camera equals itself.
  bool operator==(const CameraSettings& other) const {
    const auto same = [](double a, double b) { return a == b || (a != a && b != b); };
    bool equal = same(fovy, other.fovy) && same(height, other.height) && shader == other.shader;
    for (int i = 0; i < 16; ++i) equal = equal && same(matrix[i], other.matrix[i]);
    return equal;
  }
};

// The ray through a place of the picture, from -1 at its left and bottom to 1 at its right and top.
struct CameraRay {
  double origin[3], direction[3]; // in the world; the direction is not normalised
};
// aspect: width / height of the picture. A camera with a shader is taken as the built-in one.
CameraRay rayThrough(const CameraSettings& camera, double aspect, double x, double y);
// Finds the place of the picture where a point of the world appears. Returns false if the point is
// not in front of the camera.
bool projectPoint(const CameraSettings& camera, double aspect, const double point[3], double& x,
                  double& y);

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
