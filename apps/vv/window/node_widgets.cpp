// node_widgets.cpp: The widgets for fields of nodes, and for the look of a Shape.
#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "printable.h"
#include "window/property_widgets.h"

namespace vv {

using namespace xvrml;

namespace {

// Draws a text over the last item. Texts of a file are no labels: behind "##" nothing would be
// shown.
void drawOver(const std::string& text) {
  const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
  const ImVec2 inner = ImGui::GetStyle().FramePadding;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(least, most, true);
  list.AddText(ImVec2(least.x + inner.x, least.y + inner.y), ImGui::GetColorU32(ImGuiCol_Text),
               text.c_str());
  list.PopClipRect();
}

void hint(const std::string& text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", printable(text).c_str());
}

// A popup with a list that a text filters. A click chooses a row, and Enter the first one; then
// end() closes the popup.
struct FilteredList {
  // The popup has been opened by ImGui::OpenPopup. Returns whether it is there.
  static bool begin(const char* name) { return ImGui::BeginPopup(name); }
  void beginRows() {
    closeOnEscape();
    static std::string text; // one popup is open at a time
    if (ImGui::IsWindowAppearing()) {
      text.clear();
      ImGui::SetKeyboardFocusHere();
    }
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextItemWidth(std::min(240.f, size.x / 2));
    takesFirst =
        ImGui::InputTextWithHint("##filter", "Search", &text, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::BeginChild("##rows", ImVec2(std::min(240.f, size.x / 2), std::min(260.f, size.y / 2)));
    filter = &text;
  }
  // Draws a row if it passes the filter. Returns whether it was chosen.
  bool row(int number, const std::string& label, const std::string& text) {
    const auto same = [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) ==
             std::tolower(static_cast<unsigned char>(b));
    };
    if (std::search(label.begin(), label.end(), filter->begin(), filter->end(), same) ==
        label.end())
      return false;
    ImGui::PushID(number);
    const bool pressed = ImGui::Selectable("##row") || std::exchange(takesFirst, false);
    if (!text.empty()) hint(text);
    drawOver(printable(label));
    ImGui::PopID();
    chosen |= pressed;
    return pressed;
  }
  void end() const {
    ImGui::EndChild();
    if (chosen) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }

  const std::string* filter = nullptr;
  bool takesFirst = false, chosen = false;
};

void drawAdd(EditModel& model, const NodeRef& node, const PropertyRow& row) {
  const auto* const single = std::get_if<SFNode>(&row.value);
  if (ImGui::Button(single && *single ? "Replace" : "Add")) ImGui::OpenPopup("##add");
  hint(single && *single ? "Put another node in its place" : "Add a node to this field");
  FilteredList list;
  if (!list.begin("##add")) return;
  list.beginRows();
  int number = 0;
  for (const NodeType* type : row.addable)
    if (list.row(number++, type->name, type->text))
      model.edit([node, field = row.field->name, type](WorldEditor& editor) {
        addNode(editor, node, field, *type);
      });
  for (const NodeRef& used : row.usable)
    if (list.row(number++, "USE " + labelOf(*used), "Let this node stand here, too"))
      model.edit([node, field = row.field->name, used](WorldEditor& editor) {
        useNode(editor, node, field, used);
      });
  list.end();
}

// Draws a node of a field: a click selects it, and buttons move, separate and remove it.
void drawNode(EditModel& model, const PlacedNode& place, size_t places, size_t count) {
  ImGui::PushID(int(place.index));
  const float side = ImGui::GetFrameHeight(), gap = 2;
  const bool moves = count > 1;
  const float buttons = (moves ? 3 : 1) * (side + gap);
  const float width = std::max(side, ImGui::GetContentRegionAvail().x - buttons);
  if (ImGui::Button("##link", ImVec2(width, 0))) model.select(place.node, false);
  const std::string label = labelOf(*place.node);
  drawOver(places > 1 ? fmt::format("({}) {}", places, label) : label);
  hint(places > 1 ? fmt::format("{}\nIt stands in {} places: an edit changes all of them.\nA right "
                                "click makes this one separate.",
                                label, places)
                  : label);
  if (ImGui::BeginPopupContextItem("##menu")) {
    closeOnEscape();
    if (ImGui::MenuItem("Make this one separate", nullptr, false, places > 1))
      model.edit([place](WorldEditor& editor) { separateAt(editor, place); });
    if (ImGui::MenuItem("Remove"))
      model.edit([place](WorldEditor& editor) { removeAt(editor, place); });
    ImGui::EndPopup();
  }
  const auto move = [&](const char* name, ImGuiDir direction, bool active, int by) {
    ImGui::SameLine(0, gap);
    ImGui::BeginDisabled(!active);
    if (ImGui::ArrowButton(name, direction))
      model.edit([place, by](WorldEditor& editor) { moveBy(editor, place, by); });
    ImGui::EndDisabled();
  };
  if (moves) {
    move("##up", ImGuiDir_Up, place.index > 0, -1);
    move("##down", ImGuiDir_Down, place.index + 1 < count, 1);
  }
  ImGui::SameLine(0, gap);
  if (ImGui::Button("x", ImVec2(side, 0)))
    model.edit([place](WorldEditor& editor) { removeAt(editor, place); });
  hint("Remove it from this field");
  ImGui::PopID();
}

} // namespace

void drawNodes(EditModel& model, const NodeRef& node, const PropertyRow& row) {
  const auto draw = [&](const NodeRef& child, size_t index, size_t count) {
    if (!child) return ImGui::TextDisabled("NULL");
    drawNode(model, {child, node, row.field->name, index},
             index < row.places.size() ? row.places[index] : 1, count);
  };
  if (const auto* const single = std::get_if<SFNode>(&row.value)) {
    if (*single) draw(*single, 0, 1);
  } else if (const auto* const list = std::get_if<MFNode>(&row.value)) {
    for (size_t i = 0; i < list->size(); ++i) draw((*list)[i], i, list->size());
  }
  drawAdd(model, node, row);
}

void drawLook(EditModel& model, const PropertySheet& sheet) {
  static bool onlyHere = true; // what the user chose last
  const ShapeLook& look = sheet.look;
  ImGui::TextUnformatted("look");
  hint("The material or the shader of this Shape");
  const float side = ImGui::GetFrameHeight();
  const float width = std::max(side, ImGui::GetContentRegionAvail().x - 2 * (side + 2));
  if (ImGui::Button("##look", ImVec2(width, 0))) ImGui::OpenPopup("##looks");
  drawOver(look.name.empty() ? "choose a material or a shader" : printable(look.name));
  hint(look.places > 1
           ? fmt::format("Choose another one. The appearance stands in {} places.", look.places)
           : "Choose another one");
  ImGui::SameLine(0, 2);
  ImGui::BeginDisabled(!look.surface);
  if (ImGui::ArrowButton("##surface", ImGuiDir_Right)) model.select(look.surface, false);
  hint("Show its fields");
  ImGui::SameLine(0, 2);
  if (ImGui::Button("=", ImVec2(side, 0))) model.request(selectSameLook);
  hint("Select all Shapes with the same material or shader, or an equal one");
  ImGui::EndDisabled();
  FilteredList list;
  if (!list.begin("##looks")) return;
  if (look.places > 1) {
    ImGui::Text("The appearance stands in %zu places.", look.places);
    ImGui::Checkbox("Change it only here", &onlyHere);
  }
  list.beginRows();
  int number = 0;
  for (const Look& one : model.looks())
    if (list.row(number++, one.name, one.text))
      model.edit([one, here = onlyHere](WorldEditor& editor) { setLook(editor, one, here); });
  list.end();
}

} // namespace vv
