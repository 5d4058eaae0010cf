// navigation.h: viewer navigation. WALK, FLY and EXAMINE are functions of position, input and time.
// The Navigator applies them: it finds floors and walls in the world and sends the events of
// Collision nodes. [the browser's thread]
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <set>

#include "behaviour/viewer/pick.h"
#include "xvrml/viewer.h"

namespace xvrml {

class Interaction;

// Lengths in the world's units.
struct Avatar {
  // From avatarSize: distance to walls, eye height above the ground, highest step that can be
  // climbed.
  double distance = 0.25, height = 1.6, step = 0.75;
  double speed = 1;      // speed in units per second
  double gravity = 9.81; // acceleration in units per second squared
  Vector up{0, 1, 0};
};

struct Motion {
  Matrix view;      // camera to world, rigid
  double fall = 0;  // downward speed of WALK
  Vector center{0}; // centre of rotation of EXAMINE
  bool hasCenter = false;
};

// Finds the nearest thing along a ray that the viewer cannot pass. t: its distance in units of the
// direction; normal: its unit normal. touch: whether a hit counts as a collision.
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

  // Moves the viewer within the current cascade. Collision nodes send their events.
  void move(const NavigationInput& input, double seconds);
  void key(Key key, bool pressed);
  void ticked(); // moves the viewer for the keys held down
  // Returns the first known entry of NavigationInfo.type, or the last chosen type if the list
  // contains it or ANY.
  Navigation type() const;
  bool choose(Navigation type); // returns false if the bound NavigationInfo does not allow it
  // Returns the same for another choice than the viewer's; none: nothing was chosen.
  Navigation typeFor(std::optional<Navigation> chosen) const;
  // Returns the avatar at a Viewpoint (null: none), in world units. up: used without a Viewpoint.
  Avatar avatarAt(const Node* viewpoint, const Vector& up) const;
  // Moves something as the viewer moves. touches: Collision nodes send their events.
  enum class Touches : uint8_t { sent, ignored };
  Motion moved(const Motion& from, Navigation type, const Avatar& avatar,
               const NavigationInput& input, double seconds, Touches touches);
  // Sets the up direction used while no Viewpoint is bound.
  void setUp(const Vector& up) { up_ = up; }
  const Vector& up() const { return up_; }
  // Called when the viewer has been placed by other means.
  void resetMotion() {
    motion_.fall = 0;
    motion_.hasCenter = false;
    touched_.clear();
    tellTouches();
  }
  void forget(const Node& node); // called when a node is destroyed

 private:
  Vector centerOf(const Matrix& view);
  void tellTouches();
  bool findObstacle(const PickRay& ray, const Matrix& view, bool touch, double& t, Vector& normal);

  Interaction& interaction_;
  Motion motion_;
  // Collision nodes whose children the viewer has hit during this move, and those that say so.
  std::vector<Node*> touched_, active_;
  std::optional<Navigation> chosen_;
  std::set<Key> held_;
  double lastTick_ = std::numeric_limits<double>::quiet_NaN();
  Vector up_{0, 1, 0};
};

} // namespace xvrml
