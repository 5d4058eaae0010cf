// still.h: Renders pictures that programs ask for, with the renderer that also makes the frames of
// the window. The frame in flight is cancelled, and no other frame starts until the still picture
// is finished. It has the bytes that `vv -o` writes. Owned by a picture loop. [the browser's
// thread]
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "libpicture/live.h"

namespace vv {

struct Still {
  int width = 0, height = 0;
  int samples = 1;
  uint32_t channels = RT_RGBA;
};

struct StillAnswer {
  picture::Picture picture;
  std::string failure; // why there is no picture; "": there is one
};

class StillTaker {
 public:
  enum class State : uint8_t {
    none,
    requested, // waits until no other frame is in flight
    rendering, // its frame is in flight
    finished   // take() returns the answer
  };

  // The renderer must outlive it.
  explicit StillTaker(picture::LiveRenderer& renderer) : renderer_(renderer) {}

  // Asks for a picture. A request while another one is busy replaces it.
  void request(const Still& still);
  bool isBusy() const { return state_ == State::requested || state_ == State::rendering; }
  bool isRendering() const { return state_ == State::rendering; }

  // Cancels what is in flight, then starts the frame. viewOf: returns the view for a picture of
  // this width / height. Returns true when it has started the frame.
  bool advance(const std::function<picture::View(double aspect)>& viewOf);
  // Looks for the end of the frame. [rendering]
  void look();
  std::optional<StillAnswer> take();

 private:
  void end(StillAnswer answer);

  picture::LiveRenderer& renderer_;
  State state_ = State::none;
  Still still_;
  uint32_t usualChannels_ = 0; // of the frames that are shown
  StillAnswer answer_;
};

} // namespace vv
