// viewer.h: what a window, a test or a program hands to a running world for the one who looks at
// it, and what it may ask: keys, navigation, rays. Used with Browser.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "xvrml/node.h"

namespace xvrml {

// Ways to move (clause 6.29).
enum class Navigation : uint8_t { none, walk, fly, examine };

// What the user wants for the next moment. Everything in [-1,1], parts of full speed:
// NavigationInfo.speed metres a second for walk and fly, a quarter turn a second. examine: turn and
// tilt go round the centre, ahead comes nearer by a factor of e a second, right and up move the
// picture.
struct NavigationInput {
  double ahead = 0, right = 0, up = 0;
  double turn = 0; // to the left
  double tilt = 0; // upwards
  double roll = 0; // clockwise; fly only
};

// Arrows walk and turn, with shift four times as fast, with alt sideways and up; page up and down
// lead to the previous and next Viewpoint that has a description, home back to the bound one.
enum class Key : uint8_t { left, right, up, down, pageUp, pageDown, home, shift, alt };

struct PickOptions {
  bool collision = false; // what the viewer collides with (clause 6.8) instead of what is seen
  bool bothSides = false; // backs of solid geometry count
  double nearest = 0,
         farthest = std::numeric_limits<double>::infinity(); // in lengths of the direction
};

struct PickHit {
  double distance = 0;                     // in lengths of the direction
  std::array<double, 3> point{}, normal{}; // in the world; normal: unit vector
  Vec2f texCoord;
  struct Step {
    NodeRef node;
    std::array<double, 16>
        toWorld; // of its children's coordinate system (a Shape: of its geometry), column-major
  };
  std::vector<Step>
      path; // from a root of the world to the Shape, prototype instances and Inlines included
};

struct ViewpointName {
  NodeRef node;
  std::string name, description; // DEF; both may be empty
};

} // namespace xvrml
