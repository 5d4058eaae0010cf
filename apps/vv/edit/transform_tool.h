// transform_tool.h: Moves, turns or scales the selected node with the pointer, along an axis or
// freely, or by a number that is typed. All of it is one step. [the browser's thread, while the
// world can be used]
#pragma once

#include <optional>
#include <string>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>

#include "edit/edit_model.h"

namespace vv {

// Where a node is moved, turned and scaled. A node that is no Transform gets one around it, which
// has the values of a new one.
struct TransformFrame {
  Imath::M44d toWorld; // from the coordinates of the node's parent
  Imath::V3d pivot;    // the node's centre in the world
  Imath::V3d translation{0}, scale{1};
  Imath::Quatd rotation;
  // Returns an axis, 0 to 2, of the world or of the node, as a unit vector in the world. Without
  // an axis of its own, because its parent is flat, a node has that of the world.
  Imath::V3d axis(int axis, bool isOwn) const;
};
// Returns a rotation as files have it, with an angle from 0 to pi.
xvrml::Rotation rotationOf(const Imath::Quatd& turn);
// Returns the frame of a node; nothing if it is not in the scene.
std::optional<TransformFrame> frameOf(xvrml::Browser& browser, xvrml::Node& node);

// The length of a handle, and the radius of a ring, in halves of the picture's height.
inline constexpr double handleSize = 0.3;
// Returns half the height of the picture, in lengths of the world, at the distance of a point.
double halfHeightAt(const EditView& view, const Imath::V3d& point);

class TransformTool {
 public:
  enum class Kind : uint8_t { move, turn, scale };

  // Begins with the pointer at a place of the picture, from -1 to 1. If the selected node is no
  // Transform, one is put around it and selected. Throws xvrml::EditError.
  TransformTool(WorldEditor& editor, Kind kind, const EditView& view, double x, double y);

  // Restricts it to an axis, 0 to 2: one of the world, or if it is chosen again, one of the node's
  // own; then it is free again.
  void chooseAxis(int axis);
  // Tells whether a key is a digit, a point, a minus sign, or "Backspace", also of the keypad.
  static bool isNumberKey(const std::string& key);
  // Types such a key. Returns false for other keys.
  bool type(const std::string& key);
  // Rounds to steps: 5 degrees, a tenth of the size, or a power of ten of the distance.
  void setSnap(bool snap) { snap_ = snap; }
  // Sets the fields for a place of the pointer. Throws xvrml::EditError.
  void point(WorldEditor& editor, double x, double y);
  // Ends the step, or takes it back and selects what was selected before. Nothing follows then.
  void accept(WorldEditor& editor) { editor.editor().end(); }
  void cancel(WorldEditor& editor);
  Kind kind() const { return kind_; }
  int axis() const { return axis_; } // -1: none
  // Returns what is done, for the user: "Move along x: 0.35".
  std::string text() const;

 private:
  Imath::V3d axisInWorld() const { return frame_.axis(axis_, isLocal_); }
  double angleTo(double x, double y, const Imath::V3d& axis) const;
  double chosen(double byPointer, double step);
  void move(WorldEditor& editor, double x, double y);
  void turn(WorldEditor& editor, double x, double y);
  void scale(WorldEditor& editor, double x, double y);

  const Kind kind_;
  EditView view_;
  double startX_, startY_, pivotX_ = 0, pivotY_ = 0; // places in the picture
  xvrml::MFNode selected_;                           // before it began
  xvrml::NodeRef node_;
  TransformFrame frame_; // when it began
  int axis_ = -1;
  bool isLocal_ = false, snap_ = false;
  std::string typed_;
  double amount_ = 0; // what text() shows
};

} // namespace vv
