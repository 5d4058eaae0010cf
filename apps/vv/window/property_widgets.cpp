// property_widgets.cpp: The widgets for the fields of a node, by the types of their values.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "printable.h"
#include "window/editor_panels.h"
#include "xvrml/numbers.h"
#include "xvrml/value_text.h"

namespace vv {

using namespace xvrml;

namespace {

constexpr double degrees = 180 / std::numbers::pi;

template <class Number> constexpr ImGuiDataType dataType =
    std::is_same_v<Number, float>    ? ImGuiDataType_Float
    : std::is_same_v<Number, double> ? ImGuiDataType_Double
                                     : ImGuiDataType_S32;

// Returns how much a number changes with each pixel of a drag.
template <class Number> float speedOf(const Number* numbers, int count) {
  if constexpr (std::is_integral_v<Number>) return 0.1f;
  double most = 0;
  for (int i = 0; i < count; ++i) most = std::max(most, std::abs(double(numbers[i])));
  return float(most > 0 && std::isfinite(most) ? most * 0.01 : 0.01);
}

// Returns how numbers are shown. A drag rounds to this, so that files get short numbers.
template <class Number> const char* formOf(const Number* numbers, int count) {
  if constexpr (std::is_integral_v<Number>) return "%d";
  const bool large = std::any_of(numbers, numbers + count,
                                 [](Number one) { return std::abs(double(one)) >= 1e4; });
  return large ? "%.7g" : "%.4g";
}

// Returns whether a change of the last item counts: at once while it is dragged, and when it is
// finished while it is typed.
bool counts(bool changes) {
  return (changes && !ImGui::GetIO().WantTextInput) || ImGui::IsItemDeactivatedAfterEdit();
}

// The functions edit() draw the widget of a value, and return whether the user has changed it.

template <class Number> bool dragNumbers(Number* numbers, int count) {
  return counts(ImGui::DragScalarN("##value", dataType<Number>, numbers, count,
                                   speedOf(numbers, count), nullptr, nullptr,
                                   formOf(numbers, count)));
}

bool edit(bool& value) { return ImGui::Checkbox("##value", &value); }

// A text counts when the user has finished it.
bool edit(std::string& value) {
  ImGui::InputText("##value", &value);
  return ImGui::IsItemDeactivatedAfterEdit();
}

bool edit(Color& value) {
  return counts(ImGui::ColorEdit3("##value", &value.r, ImGuiColorEditFlags_Float));
}

bool edit(ColorRGBA& value) {
  return counts(ImGui::ColorEdit4("##value", &value.r, ImGuiColorEditFlags_Float));
}

bool edit(Rotation& value) {
  bool changes = counts(ImGui::DragFloat3("##axis", &value.x, 0.01f, 0, 0, "%.4g"));
  auto angle = float(double(value.angle) * degrees);
  ImGui::SetNextItemWidth(-1);
  const bool turned = ImGui::DragFloat("##angle", &angle, 0.5f, 0, 0, "%.4g degrees");
  if (turned) value.angle = float(double(angle) / degrees);
  return counts(turned) || changes;
}

// Numbers, alone or a few of them.
template <Numeric T>
requires(numberCount<T> <= 4 && !std::is_same_v<T, Color> && !std::is_same_v<T, ColorRGBA> &&
         !std::is_same_v<T, Rotation>) bool edit(T& value) {
  return dragNumbers(numbersOf(value), numberCount<T>);
}

template <class T>
concept Editable = requires(T& value) {
  edit(value);
};

void drawLink(EditModel& model, const NodeRef& node, int number) {
  if (!node) return ImGui::TextDisabled("NULL");
  ImGui::PushID(number);
  if (ImGui::Button("##link", ImVec2(-1, 0))) model.select(node, false);
  const ImVec2 corner = ImGui::GetItemRectMin(), inner = ImGui::GetStyle().FramePadding;
  const std::string label = labelOf(*node);
  ImGui::GetWindowDrawList()->AddText(ImVec2(corner.x + inner.x, corner.y + inner.y),
                                      ImGui::GetColorU32(ImGuiCol_Text), label.c_str());
  ImGui::PopID();
}

template <class T> bool editList(std::vector<T>& list) {
  bool changes = false;
  for (size_t i = 0; i < list.size(); ++i) {
    ImGui::PushID(int(i));
    ImGui::SetNextItemWidth(-ImGui::GetFrameHeight() - 6);
    if constexpr (std::is_same_v<T, bool>) {
      bool value = list[i];
      changes |= edit(value);
      list[i] = value;
    } else {
      changes |= edit(list[i]);
    }
    ImGui::SameLine();
    const bool removed = ImGui::Button("x", ImVec2(ImGui::GetFrameHeight(), 0));
    ImGui::PopID();
    if (!removed) continue;
    list.erase(list.begin() + std::ptrdiff_t(i));
    return true;
  }
  if (list.size() < PropertySheet::mostElements && ImGui::Button("+")) {
    list.push_back(list.empty() ? T() : T(list.back()));
    return true;
  }
  return changes;
}

// Returns whether the user has changed the value.
bool drawValue(EditModel& model, PropertyRow& row) {
  return std::visit(
      [&](auto& value) {
        using T = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<T, NodeRef>) {
          drawLink(model, value, 0);
        } else if constexpr (std::is_same_v<T, MFNode>) {
          for (size_t i = 0; i < value.size(); ++i) drawLink(model, value[i], int(i));
        } else if constexpr (isList<T>) {
          if constexpr (Editable<ElementOf<T>> && !std::is_same_v<T, Image>) return editList(value);
        } else if constexpr (Editable<T>) {
          ImGui::SetNextItemWidth(-1);
          return edit(value);
        }
        return false;
      },
      row.value);
}

void showTooltip(const FieldInfo& field) {
  if (!ImGui::IsItemHovered()) return;
  std::string text =
      fmt::format("{} {} {}", accessName(field.access), fieldTypeName(field.type), field.name);
  if (!field.text.empty()) text += "\n" + field.text;
  if (field.range.bounded()) text += "\nrange " + xvrml::describe(field.range);
  ImGui::SetTooltip("%s", printable(text).c_str());
}

} // namespace

void drawProperty(EditModel& model, const NodeRef& node, PropertyRow& row) {
  const FieldInfo& field = *row.field;
  ImGui::PushID(&field);
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(
                                           row.isDefault ? ImGuiCol_TextDisabled : ImGuiCol_Text));
  ImGui::TextUnformatted(printable(field.name).c_str());
  ImGui::PopStyleColor();
  showTooltip(field);
  if (ImGui::BeginPopupContextItem("##menu")) {
    if (ImGui::Selectable("Reset to the default") && !row.isDefault)
      model.drag(node, field, field.defaultValue);
    ImGui::EndPopup();
  }
  if (row.isLong) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s of %zu", std::string(fieldTypeName(field.type)).c_str(), row.size);
    return ImGui::PopID();
  }
  if (drawValue(model, row)) model.drag(node, field, row.value);
  ImGui::PopID();
}

} // namespace vv
