// screen.h: the window itself: an SDL window with a picture, panels of text over it, a cursor, and
// the events of its user. [main thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "window/input/input.h"
#include "window/panel.h"

namespace vv {

class Screen {
 public:
  // width, height: pixels. Throws Failure (exit code 1) where there is no display.
  Screen(const std::string& title, int width, int height);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // Waits for events at most so long, and appends what has come.
  void wait(double seconds, std::vector<InputEvent>& events);
  int width() const; // pixels
  int height() const;
  double scale() const; // pixels for a unit of the desktop: above 1 on a fine screen
  bool visible() const; // something of it can be seen

  // rgb: bytes, first row at the top; it fills the window.
  void setPicture(int width, int height, const std::vector<uint8_t>& rgb);
  enum Place : uint8_t { top, bottom, middle, places };
  void setPanel(Place place, const Panel& panel);
  void present(); // if anything has changed
  void setHand(bool hand);
  void setTitle(const std::string& title);
  void toggleFullScreen();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vv
