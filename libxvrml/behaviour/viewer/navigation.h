// navigation.h: how the viewer moves: WALK, FLY and EXAMINE as functions of where he is, what he
// wants and for how long; and the part that asks the world for floors and walls and tells Collision
// nodes. [the browser's thread]
#pragma once

#include <functional>
#include <limits>
#include <set>

#include "behaviour/viewer/pick.h"
#include "xvrml/viewer.h"

namespace xvrml {

class Interaction;

// Lengths in the world's units.
struct Avatar {
  double distance = 0.25, height = 1.6,
         step = 0.75;    // avatarSize: to walls, of the eye above ground, that can be climbed
  double speed = 1;      // a second
  double gravity = 9.81; // a second squared
  Vector up{0, 1, 0};
};

struct Motion {
  Matrix view;      // camera to world, rigid
  double fall = 0;  // speed downwards, of WALK
  Vector center{0}; // that EXAMINE goes round
};

// The nearest thing along a ray that the viewer cannot pass: how far, in lengths of the direction,
// and its unit normal. What was met counts as touched if `touch`.
using Obstacle = std::function<bool(const PickRay& ray, bool touch, double& t, Vector& normal)>;

Motion walk(const Motion& from, const NavigationInput& input, double seconds, const Avatar& avatar,
            const Obstacle& obstacle);
Motion fly(const Motion& from, const NavigationInput& input, double seconds, const Avatar& avatar,
           const Obstacle& obstacle);
Motion examine(const Motion& from, const NavigationInput& input, double seconds,
               const Avatar& avatar);

class Navigator {
 public:
  explicit Navigator(Interaction& interaction) : interaction_(interaction) {}

  // Moves the viewer within the present cascade; Collision nodes send.
  void move(const NavigationInput& input, double seconds);
  void key(Key key, bool pressed);
  void ticked(); // keys that are held move the viewer
  // The first of NavigationInfo.type that is known; what was chosen last if the list has ANY or it.
  Navigation type() const;
  bool choose(Navigation type); // false if the bound NavigationInfo does not allow it
  // The direction that is up while no Viewpoint is bound.
  void setUp(const Vector& up) { up_ = up; }
  void rest() {
    motion_.fall = 0;
    hasCenter_ = false;
  } // the viewer has been put somewhere else

 private:
  Avatar avatar() const;
  Vector centerOf(const Matrix& view);
  bool meet(const PickRay& ray, bool touch, double& t, Vector& normal);

  Interaction& interaction_;
  Motion motion_;
  bool hasCenter_ = false;
  Navigation chosen_ = Navigation::none;
  bool hasChosen_ = false;
  std::set<Key> held_;
  double lastTick_ = std::numeric_limits<double>::quiet_NaN();
  Vector up_{0, 1, 0};
};

} // namespace xvrml
