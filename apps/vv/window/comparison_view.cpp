#include "window/comparison_view.h"

#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "window/parts.h"

namespace vv {

namespace {

constexpr ImU32 lineColour = IM_COL32(255, 170, 40, 220), shadow = IM_COL32(0, 0, 0, 170);
constexpr float top = 30; // below the overlay

// Returns where the middle of a part of the picture is, in units of the window.
float middleOf(const FreePart& part) {
  return float(1 + part.middle()) / 2 * ImGui::GetIO().DisplaySize.x;
}

// Draws a text in the middle of the picture, or so that it ends or begins at a place.
void drawLabel(const char* text, float x, float part) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text);
  const ImVec2 at(x - part * size.x, top);
  list.AddRectFilled(ImVec2(at.x - 5, at.y - 3), ImVec2(at.x + size.x + 5, at.y + size.y + 3),
                     shadow);
  list.AddText(at, lineColour, text);
}

void drawWiper(double place) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float x = float(1 + place) / 2 * size.x;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddLine(ImVec2(x, 0), ImVec2(x, size.y), shadow, 4);
  list.AddLine(ImVec2(x, 0), ImVec2(x, size.y), lineColour, 2);
  list.AddCircleFilled(ImVec2(x, size.y / 2), 6, lineColour);
  drawLabel("A", x - 12, 1);
  drawLabel("B", x + 12, 0);
}

// A line of the legend behind a square of its colour.
void entry(ImU32 colour, const std::string& text, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float side = ImGui::GetTextLineHeight();
  ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + side, at.y + side), colour);
  ImGui::Dummy(ImVec2(side, side));
  ImGui::SameLine();
  drawParts(text, width - side - ImGui::GetStyle().ItemSpacing.x);
}

std::string changeAt(const ChangePicture& changes, double x, double y) {
  const float change = changes.at(x, y);
  return change == 0 ? "no significant change" : fmt::format("{:+.3g}", change);
}

void drawLegend(const Comparison& comparison, double x, double y, const FreePart& free) {
  const float width = float(free.right - free.left) / 2 * ImGui::GetIO().DisplaySize.x -
                      4 * ImGui::GetStyle().WindowPadding.x;
  ImGui::SetNextWindowPos(ImVec2(middleOf(free), top), ImGuiCond_Always, ImVec2(.5f, 0));
  // Narrow lines: the picture is to be seen below.
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 1));
  if (ImGui::Begin("##difference", nullptr,
                   ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoInputs)) {
    const ChangePicture* const changes = comparison.changes();
    ImGui::TextUnformatted("B - A in cd/m2");
    if (!changes) {
      ImGui::TextUnformatted("waits for a still picture");
    } else {
      entry(IM_COL32(255, 150, 20, 255),
            changes->most > 0 ? fmt::format("+ brighter, up to {:+.3g}", changes->most)
                              : "+ brighter: none",
            width);
      entry(IM_COL32(70, 140, 255, 255),
            changes->least < 0 ? fmt::format("- darker, down to {:+.3g}", changes->least)
                               : "- darker: none",
            width);
      entry(IM_COL32(110, 110, 110, 255), "no significant change  (5 %, all pixels together)",
            width);
      const size_t pixels = changes->changes.size();
      drawParts(fmt::format("{} of {} pixels changed;  {} not trusted", changes->significant,
                            pixels, pixels - changes->judged),
                width);
      if (!comparison.isComplete()) drawParts("A was kept  without all its samples", width);
      drawParts("here: " + changeAt(*changes, x, y), width);
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

} // namespace

void drawComparison(const Comparison& comparison, double x, double y, const FreePart& free) {
  switch (comparison.shown()) {
  case Comparison::Shown::present: break;
  case Comparison::Shown::a: drawLabel("A", middleOf(free), .5f); break;
  case Comparison::Shown::wiper: drawWiper(comparison.wiper()); break;
  case Comparison::Shown::difference: drawLegend(comparison, x, y, free); break;
  }
}

void drawRectangle(const Region& region, const char* text) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const ImVec2 corner(float(1 + region.left) / 2 * size.x, float(1 - region.top) / 2 * size.y);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRect(corner,
               ImVec2(float(1 + region.right) / 2 * size.x, float(1 - region.bottom) / 2 * size.y),
               lineColour, 0, 0, 1.5f);
  list.AddText(ImVec2(corner.x + 4, corner.y + 2), lineColour, text);
}

} // namespace vv
