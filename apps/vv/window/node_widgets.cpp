// node_widgets.cpp: The widgets for fields of nodes, and for the look of a Shape.
#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "printable.h"
#include "window/menu.h"
#include "window/property_widgets.h"

namespace vv {

using namespace xvrml;

namespace {

void drawAdd(EditModel& model, const NodeRef& node, const PropertyRow& row) {
  const auto* const single = std::get_if<SFNode>(&row.value);
  if (ImGui::Button(single && *single ? "Replace" : "Add")) ImGui::OpenPopup("##add");
  hint(single && *single ? "Put another node in its place" : "Add a node to this field");
  Menu menu;
  if (!menu.begin("##add")) return;
  menu.beginFilter();
  for (const NodeType* type : row.addable)
    if (menu.item(type->name, type->text))
      model.edit([node, field = row.field->name, type](WorldEditor& editor) {
        addNode(editor, node, field, *type);
      });
  for (const NodeRef& used : row.usable)
    if (menu.item("USE " + labelOf(*used), "Let this node stand here, too"))
      model.edit([node, field = row.field->name, used](WorldEditor& editor) {
        useNode(editor, node, field, used);
      });
  menu.end();
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
  if (Menu menu; menu.beginContext("##menu")) {
    if (menu.item("Make this one separate", "", places > 1))
      model.edit([place](WorldEditor& editor) { separateAt(editor, place); });
    if (menu.item("Remove")) model.edit([place](WorldEditor& editor) { removeAt(editor, place); });
    menu.end();
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

void drawThumbnail(const EditModel& model, const Node& node, Thumbnails& thumbnails) {
  const Thumbnail* const picture = model.thumbnails().of(node);
  if (!picture) return;
  if (!picture->error.empty())
    return ImGui::TextWrapped("%s", printable("no picture: " + picture->error).c_str());
  auto* const renderer = static_cast<SDL_Renderer*>(ImGui::GetIO().BackendRendererUserData);
  const auto scale = float(picture->magnification());
  if (SDL_Texture* const texture = thumbnails.textureOf(renderer, picture))
    ImGui::Image(texture, ImVec2(scale * float(picture->width), scale * float(picture->height)));
}

void drawNodes(EditModel& model, const NodeRef& node, const PropertyRow& row,
               Thumbnails& thumbnails) {
  const auto draw = [&](const NodeRef& child, size_t index, size_t count) {
    if (!child) return ImGui::TextDisabled("NULL");
    drawNode(model, {child, node, row.field->name, index},
             index < row.places.size() ? row.places[index] : 1, count);
    drawThumbnail(model, *child, thumbnails);
  };
  if (const auto* const single = std::get_if<SFNode>(&row.value)) {
    if (*single) draw(*single, 0, 1);
  } else if (const auto* const list = std::get_if<MFNode>(&row.value)) {
    for (size_t i = 0; i < list->size(); ++i) draw((*list)[i], i, list->size());
  }
  drawAdd(model, node, row);
}

bool drawLook(EditModel& model, LookLibrary& library, Thumbnails& thumbnails) {
  static bool onlyHere = true; // what the user chose last
  const PropertySheet& sheet = model.sheet();
  const ShapeLook& look = sheet.look;
  ImGui::TextUnformatted("look");
  hint("The material or the shader of this Shape");
  const float side = ImGui::GetFrameHeight();
  const float width = std::max(side, ImGui::GetContentRegionAvail().x - 2 * (side + 2));
  if (ImGui::Button("##look", ImVec2(width, 0))) {
    library.refresh();
    ImGui::OpenPopup("##looks");
  }
  drawOver(look.name.empty() ? "choose a material or a shader" : printable(look.name));
  hint(look.places > 1
           ? fmt::format("Choose another one. The appearance stands in {} places.", look.places)
           : "Choose another one");
  if (Menu menu; menu.beginContext("##lookmenu")) {
    if (menu.item("Copy as --shader", "The option that gives this shader to the Shape of this name",
                  !sheet.shaderOption.empty()))
      ImGui::SetClipboardText(sheet.shaderOption.c_str());
    menu.end();
  }
  ImGui::SameLine(0, 2);
  ImGui::BeginDisabled(!look.surface);
  if (ImGui::ArrowButton("##surface", ImGuiDir_Right)) model.select(look.surface, false);
  hint("Show its fields");
  ImGui::SameLine(0, 2);
  if (ImGui::Button("=", ImVec2(side, 0))) model.request(selectSameLook);
  hint("Select all Shapes with the same material or shader, or an equal one");
  ImGui::EndDisabled();
  Menu menu;
  if (!menu.begin("##looks")) return false;
  if (look.places > 1) {
    ImGui::Text("The appearance stands in %zu places.", look.places);
    ImGui::Checkbox("Change it only here", &onlyHere);
  }
  menu.beginFilter();
  menu.makeTall();
  auto* const renderer = static_cast<SDL_Renderer*>(ImGui::GetIO().BackendRendererUserData);
  for (const std::vector<Look>* looks : {&library.own(), &model.looks()})
    for (const Look& one : *looks)
      if (menu.item(one.name, one.text, true, thumbnails.textureOf(renderer, library.ballOf(one))))
        model.edit([one, here = onlyHere](WorldEditor& editor) { setLook(editor, one, here); });
  menu.end();
  return true;
}

} // namespace vv
