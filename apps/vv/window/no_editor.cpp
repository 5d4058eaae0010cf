// no_editor.cpp: Replaces the panels of the editor in a build without Dear ImGui.
#include "window/comparison_view.h"
#include "window/editing.h"
#include "window/gizmo_view.h"
#include "window/gui.h"
#include "window/readout_view.h"
#include "window/window.h"

namespace vv {

struct Gui::Impl {};
Gui::Gui(SDL_Window*, SDL_Renderer*, double, std::function<void()>) {}
Gui::~Gui() = default;
bool Gui::take(const SDL_Event&) { return false; }
void Gui::draw() {}
bool Gui::hasChanged() const { return false; }
void Gui::touch() {}

void EditorPanels::draw() {}
void Questions::draw() {}

void drawGizmo(const Gizmo&, int) {}
void drawComparison(const Comparison&, double, double, const FreePart&) {}
void drawRectangle(const Region&, const char*) {}
void drawReadout(const PointerReading&, bool, const FreePart&) {}

std::string editorLibrary() { return ""; }

} // namespace vv
