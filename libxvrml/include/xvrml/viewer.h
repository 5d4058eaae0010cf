// viewer.h: the viewer's side of a running world: keys, navigation, picking rays, viewpoints.
// Windows, tests and programs pass these to Browser.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "xvrml/camera.h"
#include "xvrml/node.h"

namespace xvrml {

// Navigation types (clause 6.29).
enum class Navigation : uint8_t { none, walk, fly, examine };

// The user's movement for the next moment. Each number lies in [-1,1] and is a part of full speed.
// - walk and fly: NavigationInfo.speed metres a second, a quarter turn a second.
// - examine: turn and tilt move around the centre; ahead comes nearer by a factor of e a second;
//   right and up move the picture.
struct NavigationInput {
  double ahead = 0, right = 0, up = 0;
  double turn = 0; // turn to the left
  double tilt = 0; // tilt upwards
  double roll = 0; // roll clockwise; fly only
};

// Keys that move the viewer:
// - arrows walk and turn: four times as fast with shift, sideways and up with alt;
// - page up and page down go to the previous and next Viewpoint that has a description;
// - home goes back to the bound Viewpoint.
enum class Key : uint8_t { left, right, up, down, pageUp, pageDown, home, shift, alt };

struct PickOptions {
  bool collision = false; // hits what the viewer collides with (clause 6.8), not what is visible
  bool bothSides = false; // also hits the backs of solid geometry
  // Interval along the ray, in lengths of the direction.
  double nearest = 0, farthest = std::numeric_limits<double>::infinity();
};

struct PickHit {
  double distance = 0;                     // distance in lengths of the ray's direction
  std::array<double, 3> point{}, normal{}; // in world coordinates; normal: unit vector
  Vec2f texCoord;
  struct Step {
    NodeRef node;
    // Matrix of the children's coordinate system (for a Shape, of its geometry's) to the world,
    // column-major.
    std::array<double, 16> toWorld;
  };
  // Nodes from a root of the world to the Shape, prototype instances and Inlines included.
  std::vector<Step> path;
};

// Where a node stands in the scene.
struct NodePlacement {
  // Nodes from a root of the world to the node, prototype instances and Inlines included.
  std::vector<PickHit::Step> path;
  // Bounds of what is drawn of the node, in the coordinate system of its parent. Empty for nodes
  // that draw nothing by themselves.
  Bounds bounds{};
};

struct ViewpointName {
  NodeRef node;
  std::string name, description; // DEF name and description; both may be empty
};

} // namespace xvrml
