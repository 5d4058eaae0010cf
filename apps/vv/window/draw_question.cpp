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
  ImGui::TextUnformatted(printable(question.text).c_str());
  const Question::Answer* given = nullptr;
  for (const Question::Answer& answer : question.answers) {
    if (ImGui::Button(answer.label)) given = &answer;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", answer.hint);
    ImGui::SameLine();
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
