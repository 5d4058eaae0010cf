// viewer.h: the viewer's position. The view is attached to the bound Viewpoint with an offset of
// its own (clause 6.53). So the Viewpoint and the nodes above it carry the viewer along. [the
// browser's thread]
#pragma once

#include <unordered_map>

#include "event/engine.h"
#include "geometry/matrix.h"
#include "xvrml/camera.h"

namespace xvrml {

class Binding;

class Viewer {
 public:
  Viewer(Engine& engine, const Binding& binding) : engine_(engine), binding_(binding) {}

  // Returns the camera-to-world matrix: rotation and translation only; it looks along -z with +y
  // up.
  Matrix view() const;
  CameraSettings camera(double aspect) const;
  // Returns the coordinate system around the bound Viewpoint, scale included. NavigationInfo's
  // lengths are in its units, and its y axis is up (6.29, 6.53).
  Matrix surroundings() const { return surroundingsOf(bound()); }
  // Returns the coordinate system around a Viewpoint, and its own. null: the default Viewpoint.
  static Matrix surroundingsOf(const Node* viewpoint);
  static Matrix placeOf(const Node* viewpoint);
  // Moves the viewer to a position in the world, as navigation does. A transition ends.
  void moveTo(const Matrix& view);
  // Moves the viewer back until the whole world is seen, in the direction of the bound viewpoint
  // (its field viewAll).
  void showAll();
  // Returns the viewer to the bound Viewpoint.
  void reset();
  void restart(); // resets the view for a new world that has no Viewpoint bound
  // Called when the first Viewpoint, if any, is bound: from now on the view is visible.
  void begin() { begun_ = true; }
  // Switches to another bound Viewpoint (null: the standard's default). Called before the events of
  // the binding are sent.
  void bind(Node* from, Node* to);
  void unbind(Node& from, Node* to);
  void left(const Node& viewpoint);   // the Viewpoint has left the stack
  void forget(const Node& viewpoint); // the Viewpoint is gone
  // Sets how many seconds a jump is animated; 0: none.
  void setTransition(double seconds);

  bool inTransition() const { return moving_.running; }
  void ticked();
  void settled(); // the cascade has ended and something has moved
  // Returns whether the viewer has jumped since the last call.
  bool takeJump() { return std::exchange(jumped_, false); }
  // Returns the speed between the last two ticks in metres per second, in the coordinate system of
  // the bound Viewpoint (4.12.10.3).
  double speed() const { return speed_; }

 private:
  Matrix leavingPlace(const Node* viewpoint) const;
  Node* bound() const;
  Matrix target() const;                                // the view without a transition
  Matrix shown(const Matrix& target) const;             // the view with the transition applied
  void keep(const Matrix& view, const Node* viewpoint); // sets the offset that leads to `view`
  bool seeAll(const Node* viewpoint); // sets the offset from which viewAll sees everything
  void jump(const Matrix& from);
  double transitionSeconds() const; // how long a jump from now on takes
  void completeTransition();

  Engine& engine_;
  const Binding& binding_;
  // The place of the bound Viewpoint when it was last in the scene; it may be removed from there.
  Matrix lastPlace_;
  Matrix offset_; // matrix from the Viewpoint to the viewer
  // Offsets of the Viewpoints below the top of the stack, and of those with retainUserOffsets;
  // null: of the default Viewpoint.
  std::unordered_map<const Node*, Matrix> saved_;
  double transition_ = 0;
  struct {
    bool running = false;
    double start = 0, seconds = 0;
    Matrix from;
  } moving_;
  // Radius of the world that a viewpoint in parallel projection shows for viewAll; 0: it shows what
  // it says.
  double shownRadius_ = 0;
  bool jumped_ = false, begun_ = false;
  double speed_ = 0, lastTick_ = 0;
  Vector lastOffset_{0, 0, 0};
  bool hasLast_ = false;
};

} // namespace xvrml
