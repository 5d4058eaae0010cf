// problems_panel.cpp: draws the list of the messages about the world, between the other panels of
// the editor.
#include <algorithm>

#include <imgui.h>

#include "printable.h"
#include "window/editor_panels.h"

namespace vv {

namespace {

ImVec4 colourOf(xvrml::Severity severity) {
  switch (severity) {
  case xvrml::Severity::error: return ImVec4(1.f, .5f, .45f, 1.f);
  case xvrml::Severity::warning: return ImVec4(1.f, .85f, .4f, 1.f);
  default: return ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled);
  }
}

void drawRow(EditModel& model, size_t number) {
  ProblemList& problems = model.problems();
  const ProblemRow& row = problems.rows()[number];
  ImGui::PushID(int(number));
  if (ImGui::Selectable("##row", problems.shown() == &row)) {
    problems.show(number);
    if (row.node) model.select(row.node, false);
  }
  ImGui::SameLine(0, 0);
  ImGui::PushStyleColor(ImGuiCol_Text, colourOf(row.severity));
  const std::string text = printable(problemText(row));
  ImGui::TextUnformatted(text.substr(0, text.find('\n')).c_str());
  ImGui::PopStyleColor();
  ImGui::PopID();
}

// Shows a message in full: its place, the node, the text and the line of the file.
void drawInFull(const ProblemRow& row) {
  std::string head = row.place.empty() ? "the whole file" : row.place;
  if (!row.label.empty()) head += ":  " + row.label;
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", printable(head).c_str());
  ImGui::TextUnformatted(printable(row.message).c_str());
  if (!row.sourceLine.empty()) ImGui::TextDisabled("%s", printable(row.sourceLine).c_str());
  ImGui::PopTextWrapPos();
}

} // namespace

void drawProblems(EditModel& model, const FreePart& free) {
  ProblemList& problems = model.problems();
  if (!problems.isOpen()) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  constexpr float margin = 6, least = 150; // the user may move it and make it larger
  const float width = float(free.right - free.left) / 2 * size.x - 2 * margin;
  ImGui::SetNextWindowPos(ImVec2(float(1 + free.left) / 2 * size.x + margin, 0.08f * size.y),
                          ImGuiCond_Appearing);
  ImGui::SetNextWindowSize(ImVec2(std::max(width, least), 0.45f * size.y), ImGuiCond_Appearing);
  bool isOpen = true;
  if (ImGui::Begin("Problems", &isOpen, ImGuiWindowFlags_NoCollapse)) {
    const float below = 5 * ImGui::GetTextLineHeightWithSpacing();
    if (ImGui::BeginChild("##messages", ImVec2(0, problems.shown() ? -below : 0))) {
      ImGuiListClipper clipper;
      clipper.Begin(int(problems.rows().size()), ImGui::GetTextLineHeightWithSpacing());
      while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) drawRow(model, size_t(i));
      if (problems.dropped() > 0)
        ImGui::TextDisabled("and %llu more", static_cast<unsigned long long>(problems.dropped()));
    }
    ImGui::EndChild();
    if (const ProblemRow* row = problems.shown()) {
      ImGui::Separator();
      if (ImGui::BeginChild("##shown")) drawInFull(*row);
      ImGui::EndChild();
    }
  }
  ImGui::End();
  if (!isOpen) problems.setOpen(false);
}

} // namespace vv
