// gizmo.h: The handles over the picture by which the selected node is moved, turned and scaled:
// lines in picture coordinates, and which handle is at a place. A TransformTool does the work.
// [the browser's thread]
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "edit/transform_tool.h"

namespace vv {

class Gizmo {
 public:
  using Kind = TransformTool::Kind;
  struct Handle {
    int axis = 0;                       // 0 to 2: x, y, z; it says the colour and the letter
    std::vector<EditModel::Line> lines; // an arrow has one, which begins near the pivot
    std::array<double, 2> end{};        // the place of the head of an arrow, and of the letter
    bool isOpposite = false;            // an arrow that points against its axis
    bool operator==(const Handle&) const = default;
  };

  // Shows the handles of another kind: to move, to turn, to scale, none.
  void cycle();
  std::optional<Kind> kind() const { return kind_; }
  // Places the handles at the selected node, with the same size in each picture. There are none
  // unless one node is selected that can have a place, and its parent is not flat. Arrows that
  // point at the viewer are left out. Arrows that scale are the node's own axes, the others those
  // of the world. An arrow that would end outside of the free part of the picture points the other
  // way, if it ends inside then. Returns whether something else is shown now. [while the world can
  // be used]
  bool place(WorldEditor& editor, const EditView& view, const FreePart& free = {});
  void clear() { handles_.clear(); }
  const std::vector<Handle>& handles() const { return handles_; }
  // Returns the axis of the handle at a place of the picture; -1: none is there.
  int axisAt(double x, double y) const;

 private:
  std::optional<Kind> kind_ = Kind::move;
  std::vector<Handle> handles_;
  double aspect_ = 1; // width / height of the picture
};

} // namespace vv
