#include "window/gizmo_view.h"

#include <cmath>

#include <imgui.h>

namespace vv {

namespace {

constexpr ImU32 colours[] = {IM_COL32(235, 75, 75, 255), IM_COL32(90, 210, 90, 255),
                             IM_COL32(95, 150, 255, 255)};
constexpr ImU32 hotColour = IM_COL32(255, 235, 90, 255), shadow = IM_COL32(0, 0, 0, 150);
constexpr const char *letters[] = {"x", "y", "z"}, *opposite[] = {"-x", "-y", "-z"};

ImVec2 placeOf(double x, double y) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  return {float(1 + x) / 2 * size.x, float(1 - y) / 2 * size.y};
}

void drawHead(ImDrawList& list, const Gizmo::Handle& handle, TransformTool::Kind kind,
              ImU32 colour) {
  const ImVec2 from = placeOf(handle.lines.front().x0, handle.lines.front().y0),
               to = placeOf(handle.end[0], handle.end[1]);
  if (kind == TransformTool::Kind::scale) {
    list.AddRectFilled(ImVec2(to.x - 5, to.y - 5), ImVec2(to.x + 5, to.y + 5), colour);
    return;
  }
  const float x = to.x - from.x, y = to.y - from.y, length = std::hypot(x, y);
  if (!(length > 0)) return;
  const ImVec2 along(x / length * 12, y / length * 12), across(-along.y * .4f, along.x * .4f);
  // Dear ImGui smooths the edges of triangles that go clockwise on the screen.
  list.AddTriangleFilled(to, ImVec2(to.x - along.x + across.x, to.y - along.y + across.y),
                         ImVec2(to.x - along.x - across.x, to.y - along.y - across.y), colour);
}

} // namespace

void drawGizmo(const Gizmo& gizmo, int hot) {
  if (!gizmo.kind()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const Gizmo::Handle& handle : gizmo.handles()) {
    const ImU32 colour = handle.axis == hot ? hotColour : colours[handle.axis];
    const float width = handle.axis == hot ? 3.5f : 2.f;
    for (const EditModel::Line& line : handle.lines)
      list.AddLine(placeOf(line.x0, line.y0), placeOf(line.x1, line.y1), shadow, width + 2);
    for (const EditModel::Line& line : handle.lines)
      list.AddLine(placeOf(line.x0, line.y0), placeOf(line.x1, line.y1), colour, width);
    if (*gizmo.kind() != TransformTool::Kind::turn) drawHead(list, handle, *gizmo.kind(), colour);
    const ImVec2 at = placeOf(handle.end[0], handle.end[1]);
    const char* const letter = (handle.isOpposite ? opposite : letters)[handle.axis];
    list.AddText(ImVec2(at.x + 8, at.y - 17), shadow, letter);
    list.AddText(ImVec2(at.x + 7, at.y - 18), colour, letter);
  }
}

} // namespace vv
