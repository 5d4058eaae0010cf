#include "window/parts.h"

#include <algorithm>

#include <imgui.h>

namespace vv {

void drawParts(std::string_view text, float width) {
  constexpr std::string_view gap = "  ";
  const float blank = ImGui::CalcTextSize(gap.data()).x;
  float used = 0; // the part of the line
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find(gap));
    const char *const begin = part.data(), *const end = begin + part.size();
    const float size = ImGui::CalcTextSize(begin, end).x;
    const bool hasRoom = used > 0 && used + blank + size <= width;
    if (hasRoom) ImGui::SameLine(0, blank);
    used = size + (hasRoom ? used + blank : 0);
    ImGui::TextUnformatted(begin, end);
    text.remove_prefix(part.size());
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  }
}

} // namespace vv
