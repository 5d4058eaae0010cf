// window.h: the window of rtut: shows pictures, and tells what the user does.
#pragma once

#include <memory>
#include <string>

struct SDL_KeyboardEvent;
struct SDL_TextInputEvent;

namespace rtut {

struct Event {
  enum Kind { none, close, resize, expose, key, special, button, wheel, motion } kind = none;
  int code = 0;  // the character, RTUT_KEY_*, or the button; for the wheel 3 (away) or 4
  int state = 0; // RTUT_DOWN or RTUT_UP; for motion: whether a button is held
  int x = 0, y = 0;
};

class Window {
 public:
  // Throws std::runtime_error if there is no display.
  Window(const std::string& title, int x, int y, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void size(int& width, int& height) const;
  void resize(int width, int height);
  void fullScreen();
  void setTitle(const std::string& title);
  // Shows a picture: rgb, rows from the top down.
  void show(const unsigned char* rgb, int width, int height);
  // Returns the next event. Waits for one, but no longer than so many milliseconds.
  Event next(int milliseconds);
  int modifiers() const;
  // A key that is held is one event, instead of several.
  void ignoreRepeats(bool ignore);

 private:
  struct Parts;
  Event keyDown(const SDL_KeyboardEvent& event);
  Event keyUp(const SDL_KeyboardEvent& event);
  Event text(const SDL_TextInputEvent& event);
  std::unique_ptr<Parts> parts_;
};

} // namespace rtut
