#include "window/menu.h"

#include <algorithm>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "lower_case.h"
#include "printable.h"

namespace vv {

namespace {

constexpr float tall = 44; // height of an item with a picture

// The menu that is open, between frames.
struct Open {
  std::string text; // in the field of the filter
  int marked = -1;  // the item that the arrow keys have come to, of those that can be chosen
  int active = 0;   // how many these were in the last frame
};
Open open;

bool isPressed(ImGuiKey key, bool repeats = false) {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), repeats);
}

// Compares without the case of letters.
bool contains(const std::string& text, const std::string& part) {
  return std::search(text.begin(), text.end(), part.begin(), part.end(),
                     [](char a, char b) { return lowerCase(a) == lowerCase(b); }) != text.end();
}

} // namespace

void drawOver(const std::string& text, float indent) {
  const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
  const ImVec2 inner = ImGui::GetStyle().FramePadding;
  const float space = most.y - least.y - ImGui::GetTextLineHeight();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(least, most, true);
  list.AddText(ImVec2(least.x + inner.x + indent, least.y + std::max(0.f, space / 2)),
               ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  list.PopClipRect();
}

void hint(const std::string& text) {
  if (!text.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", printable(text).c_str());
}

void closeOnEscape() {
  if (isPressed(ImGuiKey_Escape)) ImGui::CloseCurrentPopup();
}

bool Menu::isOpen(const char* name) { return ImGui::BeginPopup(name); }
bool Menu::isOpenAt(const char* name) { return ImGui::BeginPopupContextItem(name); }
bool Menu::isFiltered() { return !open.text.empty(); }

bool Menu::beginItems(bool isOpen) {
  if (!isOpen) return false;
  closeOnEscape();
  if (ImGui::IsWindowAppearing()) open = {};
  const int before = open.marked;
  if (isPressed(ImGuiKey_DownArrow, true) && open.marked + 1 < open.active) ++open.marked;
  if (isPressed(ImGuiKey_UpArrow, true) && open.marked > 0) --open.marked;
  hasMoved_ = open.marked != before;
  isEntered_ = isPressed(ImGuiKey_Enter) || isPressed(ImGuiKey_KeyPadEnter);
  return true;
}

void Menu::beginFilter() {
  hasFilter_ = true;
  if (ImGui::IsWindowAppearing()) {
    ImGui::SetKeyboardFocusHere();
    open.marked = 0;
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::min(260.f, size.x / 2);
  ImGui::SetNextItemWidth(width);
  if (ImGui::InputTextWithHint("##filter", "Search", &open.text)) open.marked = 0;
  ImGui::BeginChild("##rows", ImVec2(width, std::min(280.f, size.y / 2)));
}

bool Menu::item(const std::string& label, const std::string& help, bool isActive,
                SDL_Texture* picture) {
  if (hasFilter_ && !contains(label, open.text)) return false;
  const bool isMarked = isActive && active_ == open.marked;
  active_ += isActive ? 1 : 0;
  const float side = isTall_ ? tall : 0;
  const std::string text = printable(label);
  ImGui::PushID(drawn_++);
  ImGui::BeginDisabled(!isActive);
  // In a popup without a filter the widest item gives the width.
  const float width = hasFilter_ ? 0 : ImGui::CalcTextSize(text.c_str()).x + 8;
  bool isChosen = ImGui::Selectable(
      "##item", isMarked, 0, ImVec2(std::max(width, ImGui::GetContentRegionAvail().x), side));
  isChosen |= isMarked && isEntered_;
  hint(help);
  if (isMarked && hasMoved_) ImGui::SetScrollHereY();
  drawOver(text, side);
  if (picture) {
    const ImVec2 at = ImGui::GetItemRectMin();
    ImGui::GetWindowDrawList()->AddImage(picture, at, ImVec2(at.x + side, at.y + side));
  }
  ImGui::EndDisabled();
  ImGui::PopID();
  isChosen_ |= isChosen;
  return isChosen;
}

void Menu::end() const {
  open.active = active_;
  if (hasFilter_) ImGui::EndChild();
  if (isChosen_) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

} // namespace vv
