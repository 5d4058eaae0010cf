// gui.h: Draws panels of widgets over the picture of the window, with Dear ImGui, and gives them
// the user's events. Owned by a Screen. [main thread]
#pragma once

#include <functional>
#include <memory>

struct SDL_Renderer;
struct SDL_Window;
union SDL_Event;

namespace vv {

class Gui {
 public:
  // panels: calls the widgets of one frame. It is called for each event, so that none is lost when
  // several come at once, and before the panels are drawn. scale: pixels per unit of the desktop.
  Gui(SDL_Window* window, SDL_Renderer* renderer, double scale, std::function<void()> panels);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // Gives an event to the panels. Returns whether it was for them, so that nobody else gets it.
  bool take(const SDL_Event& event);
  // Draws the panels.
  void draw();
  // Tells whether the panels have changed since they were drawn. touch(): they show something else,
  // whose size they know in the next frame.
  bool hasChanged() const;
  void touch();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vv
