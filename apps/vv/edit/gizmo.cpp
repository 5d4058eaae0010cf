#include "edit/gizmo.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "xvrml/nodes.h"

namespace vv {

using namespace xvrml;
using Imath::V3d;

namespace {

// In halves of the picture's height: how far the pointer may be from a handle, what is left free
// around the pivot, for clicks on what is there, and the length of an arrow below which it is left
// out.
constexpr double reach = 0.03, gap = 0.045, shortest = 0.09;
constexpr int ringLines = 48;

// Returns whether a node has a place that can be changed: by itself, or by a Transform around it.
bool canBePlaced(Browser& browser, Node& node) {
  if (nodeCast<nodes::Transform>(&node)) return true;
  if (!node.type().is("child")) return false;
  NodePlacement placement;
  return node.type().is("light") || (browser.locate(node, placement) && !placement.bounds.empty);
}

std::optional<std::array<double, 2>> project(const EditView& view, const V3d& point) {
  std::array<double, 2> at{};
  if (!projectPoint(view.camera, view.aspect, &point.x, at[0], at[1])) return {};
  return at;
}

std::optional<Gizmo::Handle> arrow(const EditView& view, const FreePart& free, const V3d& pivot,
                                   const V3d& way, int axis) {
  const auto start = project(view, pivot);
  auto to = project(view, pivot + way);
  const auto opposite = project(view, pivot - way);
  const auto isFree = [&free](const auto& place) { return place && free.contains((*place)[0]); };
  const bool isOpposite = !isFree(to) && isFree(opposite);
  if (isOpposite) to = opposite;
  if (!start || !to) return {};
  const double length = std::hypot(((*to)[0] - (*start)[0]) * view.aspect, (*to)[1] - (*start)[1]);
  if (length < shortest) return {};
  const auto between = [&](size_t k) {
    return (*start)[k] + ((*to)[k] - (*start)[k]) * gap / length;
  };
  return Gizmo::Handle{axis, {{between(0), between(1), (*to)[0], (*to)[1]}}, *to, isOpposite};
}

std::optional<Gizmo::Handle> ring(const EditView& view, const V3d& pivot, double radius, int axis) {
  V3d across(0), along(0);
  across[(axis + 1) % 3] = radius;
  along[(axis + 2) % 3] = radius;
  Gizmo::Handle handle{axis, {}, {}, false};
  // The letters stand apart: at the top, at the right, and between.
  const double up = axis == 1 ? 0 : 1, right = axis == 0 ? 0 : 1;
  double farthest = 0;
  auto before = project(view, pivot + across);
  for (int i = 1; i <= ringLines; ++i) {
    const double angle = 2 * std::numbers::pi * i / ringLines;
    const auto at = project(view, pivot + across * std::cos(angle) + along * std::sin(angle));
    if (before && at) {
      handle.lines.push_back({(*before)[0], (*before)[1], (*at)[0], (*at)[1]});
      const double distance = right * (*at)[0] * view.aspect + up * (*at)[1];
      if (handle.lines.size() == 1 || distance > farthest) {
        farthest = distance;
        handle.end = *at;
      }
    }
    before = at;
  }
  if (handle.lines.empty()) return {};
  return handle;
}

double distanceTo(const EditModel::Line& line, double aspect, double x, double y) {
  const double lineX = (line.x1 - line.x0) * aspect, lineY = line.y1 - line.y0,
               toX = (x - line.x0) * aspect, toY = y - line.y0;
  const double square = lineX * lineX + lineY * lineY;
  const double part = square > 0 ? std::clamp((toX * lineX + toY * lineY) / square, 0.0, 1.0) : 0.0;
  return std::hypot(toX - part * lineX, toY - part * lineY);
}

} // namespace

void Gizmo::cycle() {
  if (!kind_)
    kind_ = Kind::move;
  else if (*kind_ == Kind::scale)
    kind_.reset();
  else
    kind_ = Kind(int(*kind_) + 1);
  handles_.clear(); // until they are placed
}

bool Gizmo::place(WorldEditor& editor, const EditView& view, const FreePart& free) {
  std::vector<Handle> handles;
  aspect_ = view.aspect;
  Node* const node = editor.selection().size() == 1 ? editor.selected() : nullptr;
  if (kind_ && node && canBePlaced(editor.browser(), *node)) {
    const std::optional<TransformFrame> frame = frameOf(editor.browser(), *node);
    const double determinant = frame ? frame->toWorld.determinant() : 0;
    if (std::isfinite(determinant) && determinant != 0 && project(view, frame->pivot)) {
      const double size = handleSize * halfHeightAt(view, frame->pivot);
      for (int axis = 0; axis < 3; ++axis)
        if (auto handle = *kind_ == Kind::turn
                              ? ring(view, frame->pivot, size, axis)
                              : arrow(view, free, frame->pivot,
                                      frame->axis(axis, *kind_ == Kind::scale) * size, axis))
          handles.push_back(*std::move(handle));
    }
  }
  return std::exchange(handles_, handles) != handles;
}

int Gizmo::axisAt(double x, double y) const {
  int found = -1;
  double nearest = reach;
  for (const Handle& handle : handles_)
    for (const EditModel::Line& line : handle.lines)
      if (const double distance = distanceTo(line, aspect_, x, y); distance <= nearest) {
        nearest = distance;
        found = handle.axis;
      }
  return found;
}

} // namespace vv
