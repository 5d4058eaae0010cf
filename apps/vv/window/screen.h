// screen.h: Wraps an SDL window: a picture, panels of text over it, a cursor, and the user's
// events. [main thread]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "edit/edit_model.h"
#include "session/input/input.h"
#include "window/panel.h"

namespace vv {

class Screen {
 public:
  // width, height: pixels. Throws Failure (exit code 1) if there is no display.
  Screen(const std::string& title, int width, int height);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // Waits for events for at most `seconds` and appends those that have arrived. After each of them
  // isEnough() tells whether those behind it stay for the next call.
  void wait(double seconds, std::vector<InputEvent>& events, const std::function<bool()>& isEnough);
  void rest(double seconds); // waits, and leaves all events for later
  int width() const;         // pixels
  int height() const;
  double scale() const; // pixels per unit of the desktop; above 1 on a high-resolution screen
  bool visible() const; // true if any part of the window is visible

  // rgb: bytes, first row at the top; the picture fills the window.
  void setPicture(int width, int height, const std::vector<uint8_t>& rgb);
  // Shows another picture, which would fill the window, over the left part of the picture. width
  // 0: none.
  void setCover(int width, int height, const std::vector<uint8_t>& rgb);
  void setCoverPart(double part);                              // from 0 to 1, of the width
  enum Place : uint8_t { right, top, bottom, middle, places }; // each covers those before it
  void setPanel(Place place, const Panel& panel);
  // Shows panels of widgets over the picture, below the texts at the bottom and in the middle. They
  // get the events that are for them first. null: hides them. See Gui.
  void setGui(std::function<void()> panels);
  // The part of the picture that widgets leave free: the panels at the right and the top stand
  // there.
  void setFree(const FreePart& part);
  int freeWidth() const; // pixels
  void redraw();         // lets present() draw, because the widgets show something else
  void present();        // draws if anything has changed
  void setHand(bool hand);
  void setTitle(const std::string& title);
  void toggleFullScreen();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vv
