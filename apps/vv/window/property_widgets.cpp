// property_widgets.cpp: The widgets for the fields of a node, by the types of their values.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "printable.h"
#include "srgb.h"
#include "window/menu.h"
#include "window/property_widgets.h"
#include "xvrml/numbers.h"

namespace vv {

using namespace xvrml;

namespace {

constexpr double degrees = 180 / std::numbers::pi;

template <class Number> constexpr ImGuiDataType dataType =
    std::is_same_v<Number, float>    ? ImGuiDataType_Float
    : std::is_same_v<Number, double> ? ImGuiDataType_Double
                                     : ImGuiDataType_S32;

// Returns how much a number changes with each pixel of a drag.
template <class Number> float speedOf(Number number) {
  if constexpr (std::is_integral_v<Number>) return 0.1f;
  const double size = std::abs(double(number));
  return float(size > 0 && std::isfinite(size) ? size * 0.01 : 0.01);
}

// Returns how a number is shown. A drag rounds to this, so that files get short numbers.
template <class Number> const char* formOf(Number number) {
  if constexpr (std::is_integral_v<Number>) return "%d";
  return std::abs(double(number)) >= 1e4 ? "%.7g" : "%.4g";
}

// Returns whether a change of the last item counts: at once while it is dragged, and when it is
// finished while it is typed.
bool counts(bool changes) {
  return (changes && !ImGui::GetIO().WantTextInput) || ImGui::IsItemDeactivatedAfterEdit();
}

// How far a drag goes: the range of a field. A number that is typed may be refused.
template <class Number> struct DragLimits {
  explicit DragLimits(const FieldRange& range) {
    if (!range.bounded() || !std::isnan(range.also)) return;
    constexpr double greatest = double(std::numeric_limits<Number>::max()) / 2;
    least = bound(std::max(range.minimum, -greatest), range.minimumOpen, greatest);
    most = bound(std::min(range.maximum, greatest), range.maximumOpen, -greatest);
  }
  // An open end is no value of the field.
  static Number bound(double end, bool isOpen, double inwards) {
    const auto number = Number(end);
    if (!isOpen) return number;
    if constexpr (std::is_integral_v<Number>)
      return inwards > 0 ? number + 1 : number - 1;
    else
      return std::nextafter(number, Number(inwards));
  }
  Number least = 0, most = 0; // equal: there are none
};

// The functions edit() draw the widget of a value, and return whether the user has changed it.

// Each number of a vector has a drag of its own, with its own speed.
template <class Number> bool dragNumbers(Number* numbers, int count, const FieldRange& range = {}) {
  constexpr float gap = 2;
  const float width =
      std::max(1.f, (ImGui::CalcItemWidth() - gap * float(count - 1)) / float(count));
  const DragLimits<Number> limits(range);
  bool changes = false;
  for (int i = 0; i < count; ++i) {
    if (i > 0) ImGui::SameLine(0, gap);
    ImGui::PushID(i);
    ImGui::SetNextItemWidth(width);
    changes |=
        counts(ImGui::DragScalar("##value", dataType<Number>, numbers + i, speedOf(numbers[i]),
                                 &limits.least, &limits.most, formOf(numbers[i])));
    ImGui::PopID();
  }
  return changes;
}

bool edit(bool& value, const FieldRange&) { return ImGui::Checkbox("##value", &value); }

// A text counts when the user has finished it.
bool edit(std::string& value, const FieldRange&) {
  ImGui::InputText("##value", &value);
  return ImGui::IsItemDeactivatedAfterEdit();
}

// Numbers of a colour may be above 1 where its field does not say otherwise.
ImGuiColorEditFlags colourFlags(const FieldRange& range) {
  return ImGuiColorEditFlags_Float | (range.maximum > 1 ? ImGuiColorEditFlags_HDR : 0);
}

bool edit(Color& value, const FieldRange& range) {
  return counts(ImGui::ColorEdit3("##value", &value.r, colourFlags(range)));
}

bool edit(ColorRGBA& value, const FieldRange& range) {
  return counts(ImGui::ColorEdit4("##value", &value.r, colourFlags(range)));
}

// Linear colours: the numbers are those of the file. The swatch shows them as they look, and opens
// a picker, which rounds to four digits.
bool editLinear(float* value, int count, const FieldRange& range) {
  const ImGuiColorEditFlags numbers =
      colourFlags(range) | ImGuiColorEditFlags_NoPicker | ImGuiColorEditFlags_NoSmallPreview;
  ImGui::SetNextItemWidth(-ImGui::GetFrameHeight() - 2);
  bool changes = counts(count == 4 ? ImGui::ColorEdit4("##value", value, numbers)
                                   : ImGui::ColorEdit3("##value", value, numbers));
  float codes[4] = {0, 0, 0, 1};
  for (int i = 0; i < 3; ++i) codes[i] = encodeSrgb(std::max(0.f, value[i]));
  ImGui::SameLine(0, 2);
  if (ImGui::ColorButton("##swatch", ImVec4(codes[0], codes[1], codes[2], 1)))
    ImGui::OpenPopup("##picker");
  if (!ImGui::BeginPopup("##picker")) return changes;
  closeOnEscape();
  if (counts(ImGui::ColorPicker3("##picked", codes, ImGuiColorEditFlags_Float))) {
    for (int i = 0; i < 3; ++i)
      value[i] = float(std::round(double(decodeSrgb(codes[i])) * 1e4) / 1e4);
    changes = true;
  }
  ImGui::EndPopup();
  return changes;
}

// An axis, and the angle in degrees.
bool edit(Rotation& value, const FieldRange&) {
  const bool changes = dragNumbers(&value.x, 3);
  auto angle = float(double(value.angle) * degrees);
  ImGui::SetNextItemWidth(-1);
  const bool turned = ImGui::DragFloat("##angle", &angle, 0.5f, 0, 0, "%.4g degrees");
  if (turned) value.angle = float(double(angle) / degrees);
  return counts(turned) || changes;
}

// Numbers, alone or a few of them.
template <Numeric T>
requires(numberCount<T> <= 4 && !std::is_same_v<T, Color> && !std::is_same_v<T, ColorRGBA> &&
         !std::is_same_v<T, Rotation>) bool edit(T& value, const FieldRange& range) {
  return dragNumbers(numbersOf(value), numberCount<T>, range);
}

template <class T>
concept Editable = requires(T& value, const FieldRange& range) {
  edit(value, range);
};

// A text, or one of the words that the field may hold.
bool editText(std::string& value, const PropertyRow& row) {
  if (row.choices.empty()) return edit(value, row.range);
  ImGui::SetNextItemWidth(std::max(1.f, ImGui::CalcItemWidth() - ImGui::GetFrameHeight() - 2));
  bool changes = edit(value, row.range);
  ImGui::SameLine(0, 2);
  if (ImGui::ArrowButton("##choices", ImGuiDir_Down)) ImGui::OpenPopup("##words");
  if (Menu menu; menu.begin("##words")) {
    for (const std::string& one : row.choices)
      if (menu.item(one)) {
        value = one;
        changes = true;
      }
    menu.end();
  }
  return changes;
}

template <class T> bool editList(std::vector<T>& list, const PropertyRow& row) {
  bool changes = false;
  for (size_t i = 0; i < list.size(); ++i) {
    ImGui::PushID(int(i));
    ImGui::SetNextItemWidth(-ImGui::GetFrameHeight() - 6);
    if constexpr (std::is_same_v<T, bool>) {
      bool value = list[i];
      changes |= edit(value, row.range);
      list[i] = value;
    } else if constexpr (std::is_same_v<T, std::string>) {
      changes |= editText(list[i], row);
    } else {
      changes |= edit(list[i], row.range);
    }
    ImGui::SameLine();
    const bool removed = ImGui::Button("x", ImVec2(ImGui::GetFrameHeight(), 0));
    ImGui::PopID();
    if (!removed) continue;
    list.erase(list.begin() + std::ptrdiff_t(i));
    return true;
  }
  if (list.size() < PropertySheet::mostElements && ImGui::Button("+")) {
    T added = list.empty() ? T() : T(list.back());
    if constexpr (std::is_same_v<T, std::string>)
      if (list.empty() && !row.choices.empty()) added = row.choices.front();
    list.push_back(std::move(added));
    return true;
  }
  return changes;
}

// Returns whether the user has changed the value.
bool drawValue(PropertyRow& row) {
  return std::visit(
      [&](auto& value) {
        using T = std::remove_cvref_t<decltype(value)>;
        ImGui::SetNextItemWidth(-1);
        if constexpr (isList<T>) {
          if constexpr (Editable<ElementOf<T>> && !std::is_same_v<T, MFImage>)
            return editList(value, row);
        } else if constexpr (std::is_same_v<T, std::string>) {
          return editText(value, row);
        } else if constexpr (Editable<T>) {
          if constexpr (std::is_same_v<T, Color> || std::is_same_v<T, ColorRGBA>)
            if (row.isLinear) return editLinear(&value.r, numberCount<T>, row.range);
          return edit(value, row.range);
        }
        ImGui::TextDisabled("%s", std::string(fieldTypeName(row.field->type)).c_str());
        return false;
      },
      row.value);
}

// Draws the name: grey for a default, and bold for what has been edited since the file was read.
void drawName(const PropertyRow& row) {
  const ImU32 colour = ImGui::GetColorU32(row.isDefault ? ImGuiCol_TextDisabled : ImGuiCol_Text);
  const std::string name = printable(row.field->name);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(name.c_str());
  ImGui::PopStyleColor();
  if (row.edits > 0)
    ImGui::GetWindowDrawList()->AddText(ImVec2(at.x + 0.7f, at.y), colour, name.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", printable(row.help).c_str());
}

// Says what the value is that is not shown.
void drawLong(const PropertyRow& row) {
  const std::string type(fieldTypeName(row.field->type));
  ImGui::SameLine();
  if (row.isInOptions)
    ImGui::TextDisabled("(options)");
  else if (isMultiple(row.field->type))
    ImGui::TextDisabled("%s of %zu", type.c_str(), row.size);
  else
    ImGui::TextDisabled("%s, too long to be shown", type.c_str());
}

} // namespace

void drawProperty(EditModel& model, const NodeRef& node, PropertyRow& row, Thumbnails& thumbnails) {
  const FieldInfo& field = *row.field;
  const bool holdsNodes = field.type == FieldType::SFNode || field.type == FieldType::MFNode;
  ImGui::PushID(field.name.data(), field.name.data() + field.name.size());
  drawName(row);
  if (Menu menu; !holdsNodes && row.isDeclared && menu.beginContext("##menu")) {
    if (menu.item("Reset to the default", "", !row.isDefault))
      model.drag(node, field, row.defaultValue);
    menu.end();
  }
  if (row.isLong) drawLong(row);
  if (holdsNodes) {
    drawNodes(model, node, row, thumbnails);
  } else if (!row.isLong && drawValue(row)) {
    model.drag(node, field, row.value);
  }
  ImGui::PopID();
}

} // namespace vv
