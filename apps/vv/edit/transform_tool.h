// transform_tool.h: Moves, turns or scales the selected node with the pointer, along an axis or
// freely, or by a number that is typed. All of it is one step. [the browser's thread, while the
// world can be used]
#pragma once

#include <string>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>

#include "edit/edit_model.h"

namespace vv {

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
  // Returns what is done, for the user: "Move along x: 0.35".
  std::string text() const;

 private:
  Imath::V3d axisInWorld() const;
  double chosen(double byPointer, double step);
  void move(WorldEditor& editor, double x, double y);
  void turn(WorldEditor& editor, double x, double y);
  void scale(WorldEditor& editor, double x, double y);

  const Kind kind_;
  EditView view_;
  double startX_, startY_, pivotX_ = 0, pivotY_ = 0; // places in the picture
  xvrml::MFNode selected_;                           // before it began
  xvrml::NodeRef node_;
  Imath::M44d toWorld_; // from the coordinates of the node's parent
  Imath::V3d pivot_;    // the node's centre in the world
  Imath::V3d translation_, scale_;
  Imath::Quatd rotation_;
  int axis_ = -1;
  bool isLocal_ = false, snap_ = false;
  std::string typed_;
  double amount_ = 0; // what text() shows
};

} // namespace vv
