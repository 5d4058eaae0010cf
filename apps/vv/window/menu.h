// menu.h: The menus of the editor's panels: popups whose items are chosen by a click, or with the
// arrow keys and Enter. Escape closes them. [main thread, within a frame of Gui]
#pragma once

#include <string>

struct SDL_Texture;

namespace vv {

// Draws a text of a file over the last item. It is no label: behind "##" nothing would be shown.
// indent: from the left edge of the item.
void drawOver(const std::string& text, float indent = 0);
// Shows what the last item is for while the pointer is on it; "": nothing.
void hint(const std::string& text);
// Closes the popup that is being drawn if Escape was pressed.
void closeOnEscape();

// A menu that is drawn in this frame. One is open at a time.
class Menu {
 public:
  // The popup has been opened by ImGui::OpenPopup. Returns whether it is open; end() must follow
  // then.
  bool begin(const char* name) { return beginItems(isOpen(name)); }
  // A click with the right button on the last item opens it.
  bool beginContext(const char* name) { return beginItems(isOpenAt(name)); }
  // Draws a field whose text filters the items that follow, which scroll. Enter takes the first of
  // them if none is marked.
  void beginFilter();
  // Returns whether something has been typed into the field.
  static bool isFiltered();
  // Draws an item if it passes the filter. Returns whether it was chosen. picture: stands before
  // the text, square; null: none.
  bool item(const std::string& label, const std::string& help = "", bool isActive = true,
            SDL_Texture* picture = nullptr);
  // Gives items without a picture the height of those that have one.
  void makeTall() { isTall_ = true; }
  void end() const;

 private:
  static bool isOpen(const char* name);
  static bool isOpenAt(const char* name);
  bool beginItems(bool isOpen);

  bool hasFilter_ = false, isTall_ = false, isChosen_ = false;
  bool isEntered_ = false; // Enter was pressed
  bool hasMoved_ = false;  // another item is marked now
  int drawn_ = 0;          // items that have been drawn
  int active_ = 0;         // those of them that can be chosen
};

} // namespace vv
