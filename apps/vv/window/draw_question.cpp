// draw_question.cpp: Draws a question of the window with Dear ImGui.
#include <imgui.h>

#include "printable.h"
#include "window/questions.h"

namespace vv {

// An answer takes effect later, outside of the frame: it may close the widgets.
void Questions::draw() {
  if (asked_.empty() || isAnswered_) return;
  const Question& question = asked_.front();
  if (!ImGui::IsPopupOpen(question.title)) ImGui::OpenPopup(question.title);
  if (!ImGui::BeginPopupModal(question.title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  ++frames_;
  const ImGuiStyle& style = ImGui::GetStyle();
  const float right = ImGui::GetIO().DisplaySize.x - 4 * style.WindowPadding.x;
  ImGui::PushTextWrapPos(right);
  ImGui::TextUnformatted(printable(question.text).c_str());
  ImGui::PopTextWrapPos();
  const Question::Answer* given = nullptr;
  for (const Question::Answer& answer : question.answers) {
    // In a small window the answers take several lines.
    const float width = ImGui::CalcTextSize(answer.label).x + 2 * style.FramePadding.x;
    if (&answer != &question.answers.front()) ImGui::SameLine();
    if (ImGui::GetCursorPosX() + width > right) ImGui::NewLine();
    if (ImGui::Button(answer.label)) given = &answer;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", answer.hint);
  }
  const auto isPressed = [](ImGuiKey key) {
    return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false);
  };
  if (question.hasEnter && (isPressed(ImGuiKey_Enter) || isPressed(ImGuiKey_KeyPadEnter)))
    given = &question.answers.front();
  if (isPressed(ImGuiKey_Escape)) given = &question.answers.back();
  if (given) {
    chosen_ = given->then;
    isAnswered_ = true;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  if (isAnswered_) asked_.pop_front();
}

} // namespace vv
