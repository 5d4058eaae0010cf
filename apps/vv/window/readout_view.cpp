#include "window/readout_view.h"

#include <string>

#include <imgui.h>

#include "options/values.h"
#include "printable.h"
#include "window/parts.h"

namespace vv {

void drawReadout(const PointerReading& pointer, bool isReadable) {
  const std::string text = pointerText(pointer, isReadable);
  if (text.empty()) return;
  constexpr float gap = 14; // to the pointer, which stays free
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  // Towards the middle of the picture.
  const float right = pointer.x < 0 ? 1.f : -1.f, down = pointer.y > 0 ? 1.f : -1.f;
  const ImVec2 at(float(1 + pointer.x) / 2 * size.x + right * gap,
                  float(1 - pointer.y) / 2 * size.y + down * gap);
  ImGui::SetNextWindowPos(at, ImGuiCond_Always,
                          ImVec2(right > 0 ? 0.f : 1.f, down > 0 ? 0.f : 1.f));
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 1));
  if (ImGui::Begin("##readout", nullptr,
                   ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoInputs)) {
    for (std::string_view rest : split(text, '\n'))
      drawParts(printable(std::string(rest)), size.x / 3);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

} // namespace vv
