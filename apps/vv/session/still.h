// still.h: Renders pictures that programs ask for, with the renderer that also makes the frames of
// the window. A picture has the bytes that `vv -o` writes. Owned by a picture loop. [the browser's
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
  picture::Crop crop; // the part that is made; see RenderSettings
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

  // Asks for a picture. [not while one is busy]
  void request(const Still& still);
  bool isBusy() const { return state_ == State::requested || state_ == State::rendering; }
  bool isRendering() const { return state_ == State::rendering; }

  // Starts the frame. viewOf: returns the view for a picture of this width / height. [requested;
  // the renderer is idle]
  void start(const std::function<picture::View(double aspect)>& viewOf);
  // Looks for the end of the frame. [rendering]
  void look();
  std::optional<StillAnswer> take();

 private:
  picture::LiveRenderer& renderer_;
  State state_ = State::none;
  Still still_;
  uint64_t number_ = 0;        // the number of its frame
  bool isWhole_ = false;       // its frame has ended with all samples
  uint32_t usualChannels_ = 0; // channels of the frames that are shown
  StillAnswer answer_;
};

} // namespace vv
