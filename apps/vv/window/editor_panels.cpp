#include "window/editor_panels.h"

#include <algorithm>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "edit/import.h"
#include "edit/kept_probes.h"
#include "printable.h"
#include "window/comparison_view.h"
#include "window/parts.h"
#include "window/property_widgets.h"

namespace vv {

using namespace xvrml;

namespace {

// The keys are the picture's until a panel is clicked or gets them.
constexpr ImGuiWindowFlags panelFlags = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoTitleBar |
                                        ImGuiWindowFlags_NoFocusOnAppearing;
constexpr ImU32 frameColour = IM_COL32(255, 170, 40, 220);

// A button that can be pressed only if `active`.
bool button(const char* label, bool active, const std::string& hint) {
  ImGui::BeginDisabled(!active);
  const bool pressed = ImGui::Button(label);
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    ImGui::SetTooltip("%s", hint.c_str());
  ImGui::SameLine();
  return pressed;
}

enum class Edge : uint8_t { left, right };

// Places a panel at an edge of the window, in the whole height: with the width that the user has
// chosen, or with this part of the window's width. The user may make it wider or narrower.
void placePanel(Edge edge, float chosen, float part) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float least = std::min(120.f, size.x / 2),
              width = chosen > 0 ? std::clamp(chosen, least, size.x / 2)
                                 : std::clamp(part * size.x, least, 300.f);
  ImGui::SetNextWindowSize(ImVec2(width, size.y), ImGuiCond_Appearing);
  ImGui::SetNextWindowSizeConstraints(ImVec2(least, size.y), ImVec2(size.x / 2, size.y));
  const float x = edge == Edge::left ? 0.f : 1.f;
  ImGui::SetNextWindowPos(ImVec2(x * size.x, 0), ImGuiCond_Always, ImVec2(x, 0));
}

// A button of a row of buttons that goes on in the next line where the panel is too narrow.
bool toolButton(const char* label, bool active, const std::string& hint) {
  const float width = ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (ImGui::GetCursorPosX() > ImGui::GetCursorStartPos().x &&
      ImGui::GetContentRegionAvail().x < width)
    ImGui::NewLine();
  return button(label, active, hint);
}

// Returns the nodes that are offered only when a text filters the menu: all other types that can
// stand in a group, or be the geometry of a Shape.
const std::vector<NewNode>& otherNodes() {
  static const std::vector<NewNode> others = [] {
    std::vector<NewNode> nodes;
    const auto isShort = [](const std::string& name) {
      return std::any_of(newNodes().begin(), newNodes().end(),
                         [&](const NewNode& one) { return one.name == name; });
    };
    for (const NodeType* type : nodeTypes())
      if (!isShort(type->name) && (type->is("child") || type->is("geometry")))
        nodes.push_back({type->name.c_str(), type->is("geometry")});
    return nodes;
  }();
  return others;
}

} // namespace

void EditorPanels::draw() {
  thumbnails_.bound();
  drawFrames();
  const auto width = double(ImGui::GetIO().DisplaySize.x);
  if (isHidden_) {
    free_ = {};
    isChoosingLook_ = false;
  } else {
    drawOutline();
    drawSheet();
    free_ = {2 * double(outlineWidth_) / width - 1, 1 - 2 * double(sheetWidth_) / width};
  }
  drawProbes();
  drawProblems(model_, free_);
  hasPointer_ = ImGui::GetIO().WantCaptureMouse;
  model_.setActive(ImGui::IsAnyItemActive());
}

void EditorPanels::passKeyboard() {
  ImGuiIO& io = ImGui::GetIO();
  // The mouse or Escape may have given the keys back to the picture.
  if (!(io.ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard)) keyboard_ = Keyboard::picture;
  keyboard_ = keyboard_ == Keyboard::picture   ? Keyboard::outline
              : keyboard_ == Keyboard::outline ? Keyboard::sheet
                                               : Keyboard::picture;
  passesKeyboard_ = keyboard_ != Keyboard::picture;
  if (passesKeyboard_) {
    isHidden_ = false;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  } else {
    io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    ImGui::SetWindowFocus(nullptr);
  }
}

// Tells, once, whether a panel gets the keyboard.
bool EditorPanels::takesKeyboard(Keyboard panel) {
  return keyboard_ == panel && std::exchange(passesKeyboard_, false);
}

void EditorPanels::drawFrames() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const EditModel::Line& line : model_.frames())
    list.AddLine(ImVec2(float(1 + line.x0) / 2 * size.x, float(1 - line.y0) / 2 * size.y),
                 ImVec2(float(1 + line.x1) / 2 * size.x, float(1 - line.y1) / 2 * size.y),
                 frameColour, 1.5f);
}

void EditorPanels::drawTools() {
  const bool writable = model_.readOnly().empty(), any = model_.sheet().node && writable;
  if (toolButton("Undo", !model_.undoName().empty(), "Undo " + model_.undoName() + " (Ctrl+Z)"))
    model_.edit([](WorldEditor& editor) { editor.undo(); });
  if (toolButton("Redo", !model_.redoName().empty(), "Redo " + model_.redoName() + " (Ctrl+Y)"))
    model_.edit([](WorldEditor& editor) { editor.redo(); });
  if (toolButton("Save", model_.hasUnsaved(), "Save the file in place (Ctrl+S)")) save_();
  const bool adds = std::exchange(opensAdd_, false) && writable;
  if (toolButton("Add", writable,
                 "Add a node to the selected group, or behind the selected node (Shift+A)") ||
      adds)
    ImGui::OpenPopup("##new");
  if (toolButton("Copy", any, "Duplicate what is selected (Shift+D)"))
    model_.edit(duplicateSelected);
  if (toolButton("Group", any, "Put a Transform around what is selected (Ctrl+G)"))
    model_.edit(wrapSelected);
  if (toolButton("Remove", any, "Remove what is selected (X, Delete)")) model_.edit(removeSelected);
  if (toolButton("View", true, "Hide nodes for now, and show them again"))
    ImGui::OpenPopup("##view");
  ImGui::NewLine();
  drawReports();
  drawAddMenu();
  drawFileQuestion();
  if (Menu menu; menu.begin("##view")) {
    drawViewItems(menu);
    if (menu.item("Show sensors as probes"))
      model_.request([&probes = probes_](WorldEditor& editor) { showSensors(editor, probes); });
    menu.end();
  }
}

void EditorPanels::drawAddMenu() {
  Menu menu;
  if (!menu.begin("##new")) return;
  menu.beginFilter();
  const auto item = [&](const NewNode& one) {
    if (menu.item(one.name)) model_.edit([one](WorldEditor& editor) { add(editor, one); });
  };
  for (const NewNode& one : newNodes()) item(one);
  if (menu.item("Viewpoint from here"))
    model_.edit([view = view_](WorldEditor& editor) { addViewpoint(editor, view); });
  opensFile_ |= menu.item("Inline from a file ...", "Put another world, or a mesh, into this one");
  if (Menu::isFiltered())
    for (const NewNode& one : otherNodes()) item(one);
  menu.end();
}

void EditorPanels::drawFileQuestion() {
  if (std::exchange(opensFile_, false)) ImGui::OpenPopup("##file");
  if (!ImGui::BeginPopup("##file")) return;
  closeOnEscape();
  ImGui::TextUnformatted("File of a world or a mesh; a relative path counts from this world's");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(std::min(340.f, ImGui::GetIO().DisplaySize.x / 2));
  bool isGiven = ImGui::InputTextWithHint("##path", "or drop it on the window", &path_,
                                          ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  isGiven |= ImGui::Button("Import");
  if (isGiven && !path_.empty()) {
    model_.edit([path = path_](WorldEditor& editor) { importFile(editor, path); });
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void EditorPanels::drawReports() {
  ProblemList& problems = model_.problems();
  // The identifier behind ### stays when the number changes.
  const std::string label = "Problems (" + std::to_string(problems.count()) + ")###problems";
  if (toolButton(label.c_str(), problems.count() > 0 || problems.isOpen(),
                 "Messages about the world"))
    problems.setOpen(!problems.isOpen());
  wantsReport_ |= toolButton("Report", true, "Write a page and a table beside the file");
  ImGui::NewLine();
}

void EditorPanels::drawOutline() {
  placePanel(Edge::left, widths_.outline, 0.26f);
  if (ImGui::Begin("##outline", nullptr, panelFlags)) {
    watchWidth(outlineWidth_, widths_.outline);
    drawTools();
    if (!model_.readOnly().empty())
      ImGui::TextWrapped("%s", model_.readOnly().c_str());
    else if (!model_.unwritable().empty())
      ImGui::TextWrapped("%s", model_.unwritable().c_str());
    if (model_.hiddenCount() > 0)
      ImGui::TextWrapped("%zu nodes are hidden: View, Show all", model_.hiddenCount());
    ImGui::SetNextItemWidth(-1);
    if (takesKeyboard(Keyboard::outline)) {
      ImGui::SetWindowFocus();
      ImGui::SetKeyboardFocusHere();
    }
    if (ImGui::InputTextWithHint("##search", "Search names, types and fields", &search_))
      model_.search(search_);
    if (ImGui::BeginChild("##rows", ImVec2(0, 0), false, ImGuiWindowFlags_NavFlattened)) {
      const std::vector<OutlineRow>& rows = model_.rows();
      if (const int row = model_.takeScroll(); row >= 0)
        ImGui::SetScrollY(std::max(0.f, float(row - 3) * ImGui::GetTextLineHeightWithSpacing()));
      ImGuiListClipper clipper;
      clipper.Begin(int(rows.size()), ImGui::GetTextLineHeightWithSpacing());
      while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) drawRow(rows[size_t(i)], i);
      drawRowMenu();
    }
    ImGui::EndChild();
  }
  ImGui::End();
}

void EditorPanels::drawRow(const OutlineRow& row, int number) {
  ImGui::PushID(number);
  const float indent = float(row.depth) * 12;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + indent);
  const char* const sign = !row.canOpen || row.isUse ? "  " : row.isOpen ? "-" : "+";
  if (ImGui::Selectable(sign, false, 0, ImVec2(12, 0)) && row.canOpen && !row.isUse)
    model_.setOpen(row.node, !row.isOpen);
  ImGui::SameLine();
  if (row.isUse)
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  // Names are those of a hostile file: behind "##" nothing would be shown.
  if (ImGui::Selectable("##row", model_.isSelected(*row.node)))
    model_.select(row.node, ImGui::GetIO().KeyShift || ImGui::GetIO().KeyCtrl);
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
    // The rows may change while the menu is open.
    menuRow_ = row;
    opensMenu_ = true;
    if (!model_.isSelected(*row.node)) model_.select(row.node, false);
  }
  ImGui::SameLine(0, 0);
  ImGui::TextUnformatted(((row.isUse ? "USE " : "") + row.label()).c_str());
  if (row.isUse) ImGui::PopStyleColor();
  ImGui::PopID();
}

// Draws the items of a menu that change what is seen and selected, and not the file.
void EditorPanels::drawViewItems(Menu& menu) {
  if (menu.item("Hide")) model_.hideSelected();
  if (menu.item("Show only this")) model_.isolateSelected();
  if (menu.item("Show all", "", model_.hiddenCount() > 0)) model_.showAll();
  if (menu.item("Select all with this look")) model_.request(selectSameLook);
}

// Keeps the width of the present panel when the user has dragged its edge. A smaller window makes
// panels narrower, too; that is no choice.
void EditorPanels::watchWidth(float& drawn, float& chosen) {
  const float before = std::exchange(drawn, ImGui::GetWindowWidth());
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (std::exchange(isResized_, false)) writePanelWidths(panelStateFile(), widths_);
  } else if (before != 0 && before != drawn) {
    chosen = drawn;
    isResized_ = true;
  }
}

void EditorPanels::drawRowMenu() {
  if (std::exchange(opensMenu_, false)) ImGui::OpenPopup("##row");
  Menu menu;
  if (!menu.begin("##row")) return;
  drawViewItems(menu);
  ImGui::Separator();
  const auto item = [&](const char* label, void (*edit)(WorldEditor&, const PlacedNode&)) {
    if (menu.item(label, "", model_.readOnly().empty()))
      model_.edit([edit, place = menuRow_.place](WorldEditor& editor) { edit(editor, place); });
  };
  item("Move up", [](WorldEditor& editor, const PlacedNode& place) { moveBy(editor, place, -1); });
  item("Move down", [](WorldEditor& editor, const PlacedNode& place) { moveBy(editor, place, 1); });
  item("Make this one separate", separateAt);
  item("Remove from here", removeAt);
  menu.end();
}

void EditorPanels::drawSheet() {
  placePanel(Edge::right, widths_.sheet, 0.3f);
  isChoosingLook_ = false;
  if (ImGui::Begin("##sheet", nullptr, panelFlags)) {
    watchWidth(sheetWidth_, widths_.sheet);
    if (takesKeyboard(Keyboard::sheet)) ImGui::SetWindowFocus();
    PropertySheet& sheet = model_.sheet();
    if (!sheet.node) {
      asksForName_ = false;
      ImGui::TextWrapped("Click on something in the picture or in the outline to select it. "
                         "V or U measures the light where the pointer is. F1 lists all keys.");
    } else {
      ImGui::PushID(sheet.node.get());
      drawTitle();
      if (!sheet.note.empty()) ImGui::TextWrapped("%s", printable(sheet.note).c_str());
      drawThumbnail(model_, *sheet.node, thumbnails_);
      ImGui::Separator();
      ImGui::BeginDisabled(!model_.readOnly().empty());
      if (sheet.hasLook) isChoosingLook_ = drawLook(model_, library_, thumbnails_);
      for (PropertyRow& row : sheet.rows) drawProperty(model_, sheet.node, row, thumbnails_);
      ImGui::EndDisabled();
      ImGui::PopID();
    }
  }
  ImGui::End();
}

// Draws the title of the sheet, and the question for another name of its node.
void EditorPanels::drawTitle() {
  const PropertySheet& sheet = model_.sheet();
  const bool isWritable = model_.readOnly().empty();
  ImGui::TextUnformatted(sheet.title.c_str());
  if (isWritable) hint("A click, or F2, gives it another name");
  if (const bool asks = std::exchange(asksForName_, false) || ImGui::IsItemClicked();
      asks && isWritable) {
    name_ = sheet.node->defName;
    ImGui::OpenPopup("##name");
  }
  if (!ImGui::BeginPopup("##name")) return;
  closeOnEscape();
  ImGui::TextUnformatted("Name (DEF)");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  bool isGiven =
      ImGui::InputText("##defname", &name_,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  ImGui::SameLine();
  isGiven |= ImGui::Button("Rename");
  if (isGiven && !name_.empty()) {
    model_.edit([node = sheet.node, name = name_](WorldEditor& editor) {
      editor.editor().rename(*node, name);
    });
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void EditorPanels::drawProbes() {
  if (probes_.all().empty()) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const Probe& probe : probes_.all()) {
    if (probe.area && probe.area->view == view_)
      drawRectangle(probe.area->region, std::to_string(probe.number).c_str());
    if (probe.area) continue;
    double x = 0, y = 0;
    if (!projectPoint(view_.camera, view_.aspect, probe.point.data(), x, y)) continue;
    const ImVec2 at(float(1 + x) / 2 * size.x, float(1 - y) / 2 * size.y);
    list.AddCircle(at, 4, frameColour, 12, 1.5f);
    list.AddText(ImVec2(at.x + 6, at.y - 8), frameColour, std::to_string(probe.number).c_str());
  }
  // Between the panels.
  constexpr float margin = 6;
  const float left = float(1 + free_.left) / 2 * size.x + margin,
              width = float(free_.right - free_.left) / 2 * size.x - 2 * margin;
  ImGui::SetNextWindowPos(ImVec2(left, size.y - 30), ImGuiCond_Always, ImVec2(0, 1));
  if (ImGui::Begin("Probes", nullptr,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    const float inside = width - 2 * ImGui::GetStyle().WindowPadding.x;
    const std::vector<std::optional<Difference>> changes = probes_.differences();
    for (size_t i = 0; i < changes.size(); ++i) {
      const std::string text = probeText(probes_.all()[i], changes[i]);
      const bool certain = changes[i] && changes[i]->isSignificant;
      ImGui::BeginGroup();
      ImGui::PushStyleColor(
          ImGuiCol_Text,
          ImGui::GetStyleColorVec4(!changes[i] || certain ? ImGuiCol_Text : ImGuiCol_TextDisabled));
      drawParts(text, inside);
      ImGui::PopStyleColor();
      ImGui::EndGroup();
      drawProbeMenu(probes_.all()[i]);
    }
    if (button("Keep as A", true, "Compare what follows with the light of now (B)"))
      probes_.askToKeep();
    if (button("Copy", true, "Copy all as a table (CSV)"))
      ImGui::SetClipboardText(probes_.csv().c_str());
    if (button("Clear", true, "Remove all probes")) probes_.clear();
    ImGui::NewLine();
  }
  ImGui::End();
}

// Draws the field for the name of a probe at the top of its menu.
void EditorPanels::drawProbeName(const Probe& probe) {
  if (ImGui::IsWindowAppearing()) {
    name_ = probe.name;
    ImGui::SetKeyboardFocusHere();
  }
  if (ImGui::InputTextWithHint("##probename", "Name of the probe", &name_,
                               ImGuiInputTextFlags_EnterReturnsTrue |
                                   ImGuiInputTextFlags_AutoSelectAll)) {
    probes_.rename(probe.number, name_);
    ImGui::CloseCurrentPopup();
  }
}

// Draws the menu of a probe, whose line is the last item.
void EditorPanels::drawProbeMenu(const Probe& probe) {
  const char* const menuHint = canBeKept(probe)
                                   ? "A right click names it, or keeps it in the world, as a sensor"
                                   : "A right click names it";
  hint(probe.seen + (probe.seen.empty() ? "" : "\n") + menuHint);
  ImGui::PushID(probe.number);
  if (Menu menu; menu.beginContext("##probe")) {
    drawProbeName(probe);
    if (menu.item("Keep in the world", "Add an ORTSensor that reads the same",
                  canBeKept(probe) && model_.readOnly().empty()))
      model_.edit([probe, view = view_](WorldEditor& editor) { keepInWorld(editor, probe, view); });
    menu.end();
  }
  ImGui::PopID();
}

} // namespace vv
