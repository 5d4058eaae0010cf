#include "window/readout_view.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <imgui.h>

#include "options/values.h"
#include "printable.h"
#include "window/parts.h"

namespace vv {

namespace {

// Makes what stands behind a comma a part of its own.
std::string inParts(std::string_view line) {
  std::string text;
  for (size_t i = 0; i < line.size(); ++i) {
    text += line[i];
    if (line[i] == ' ' && i > 0 && line[i - 1] == ',') text += ' ';
  }
  return text;
}

} // namespace

void drawReadout(const PointerReading& pointer, bool isReadable, const FreePart& free) {
  const std::string text = pointerText(pointer, isReadable);
  if (text.empty()) return;
  constexpr float gap = 14; // to the pointer, which stays free
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto column = [&size](double x) { return float(1 + x) / 2 * size.x; };
  // Where there is more room between the panels. Above or below the pointer it may also reach to
  // the other side.
  const bool isRight = pointer.x<free.middle(), isBelow = pointer.y> 0;
  const float left = column(free.left), right = column(free.right),
              most = std::min(right - left, size.x / 3), at = column(pointer.x),
              x = isRight ? std::max(left, std::min(at + gap, right - most))
                          : std::min(right, std::max(at - gap, left + most)),
              y = float(1 - pointer.y) / 2 * size.y + (isBelow ? gap : -gap),
              width = most - 2 * ImGui::GetStyle().WindowPadding.x;
  ImGui::SetNextWindowPos(ImVec2(x, y), ImGuiCond_Always,
                          ImVec2(isRight ? 0.f : 1.f, isBelow ? 0.f : 1.f));
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 1));
  if (ImGui::Begin("##readout", nullptr,
                   ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoInputs)) {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::max(width, 1.f)); // names may be long
    for (std::string_view rest : split(text, '\n')) drawParts(printable(inParts(rest)), width);
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

} // namespace vv
