// viewer.h: where the viewer is. The view hangs below the bound Viewpoint, moved by an offset of
// its own (clause 6.53): what moves the Viewpoint or the nodes above it carries the viewer along.
// [the browser's thread]
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

  // Camera to world: rotation and translation only; looks along -z, +y up.
  Matrix view() const;
  CameraSettings camera(double aspect) const;
  // The coordinate system the bound Viewpoint stands in, scale included: what NavigationInfo's
  // lengths are in, and whose y axis is up (6.29, 6.53).
  Matrix surroundings() const;
  // Moves the viewer to a place in the world, as navigation does; a transition ends.
  void moveTo(const Matrix& view);
  // Back to where the bound Viewpoint is.
  void reset();
  void restart(); // a world that has no Viewpoint bound begins
  void begin() {
    begun_ = true;
  } // the file's first Viewpoint, if there is one, is bound: somebody looks from now on
  // The bound Viewpoint becomes another; null: the standard's default. Called before the events of
  // the binding.
  void bind(Node* from, Node* to);
  void unbind(Node& from, Node* to);
  void forget(const Node& viewpoint); // it has left the stack
  // Seconds that a jump takes to be shown; 0: none.
  void setTransition(double seconds);

  bool inTransition() const { return moving_.running; }
  void ticked();
  void settled(); // the cascade is over; something has moved
  bool takeJump() {
    return std::exchange(jumped_, false);
  } // since the last call the viewer has jumped
  // Metres per second in the coordinate system of the bound Viewpoint, between the last two ticks
  // (4.12.10.3).
  double speed() const { return speed_; }

 private:
  Matrix placeOf(const Node* viewpoint) const; // the Viewpoint's own coordinate system
  Matrix leavingPlace(const Node* viewpoint) const;
  Node* bound() const;
  Matrix target() const;                                // the view without a transition
  Matrix shown(const Matrix& target) const;             // with it
  void keep(const Matrix& view, const Node* viewpoint); // the offset that leads to view
  void jump(const Matrix& from);

  Engine& engine_;
  const Binding& binding_;
  Matrix
      lastPlace_; // of the bound Viewpoint when it was last seen in the scene: it may be taken out
  Matrix offset_; // Viewpoint to viewer
  std::unordered_map<const Node*, Matrix>
      saved_; // of Viewpoints in the stack below its top; null: the default's
  double transition_ = 0;
  struct {
    bool running = false;
    double start = 0;
    Matrix from;
  } moving_;
  bool jumped_ = false, begun_ = false;
  double speed_ = 0, lastTick_ = 0;
  Vector lastOffset_{0, 0, 0};
  bool hasLast_ = false;
};

} // namespace xvrml
