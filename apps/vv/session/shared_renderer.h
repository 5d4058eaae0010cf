// shared_renderer.h: The renderer of a session. Its users, the picture loops of the viewers and the
// captures, take turns: one frame is in flight at a time, two with a cluster. Owned by a session.
// [the browser's thread]
#pragma once

#include <cstdint>

#include "libpicture/live.h"

namespace vv {

class SharedRenderer {
 public:
  // The browser must outlive the renderer.
  SharedRenderer(xvrml::Browser& browser, const picture::RenderSettings& settings)
      : live(browser, settings), browser_(browser) {}

  picture::LiveRenderer live;

  // Starts a frame as LiveRenderer::start does. moving: the next frame need not wait for its end
  // where the renderer permits that; otherwise it is cancelled when its time is over. Returns the
  // state of the world that the frame shows, for isOutdated().
  uint64_t start(const picture::LiveFrame& frame, bool moving) {
    if (browser_.hasChanges()) ++world_;
    moving_ = moving;
    viewer_ = frame.viewer;
    live.start(frame);
    return world_;
  }
  // Tells whether the world has changed since start() returned this number.
  bool isOutdated(uint64_t world) const { return world != world_ || browser_.hasChanges(); }
  // Cancels the frames in flight.
  void cancel() {
    ++cancellations_;
    live.cancel();
  }
  // The number of cancellations so far: tells whether a frame that was started before was reached.
  uint64_t cancellations() const { return cancellations_; }
  // Tells about the frame that was started last: whose it is, and whether it is a moving one.
  uint32_t viewer() const { return viewer_; }
  bool isMoving() const { return moving_; }
  bool isIdle() const { return live.state() == picture::LiveRenderer::State::idle; }
  // The world is being read, so that nothing else may use it.
  bool isMapping() const { return live.state() == picture::LiveRenderer::State::mapping; }

 private:
  xvrml::Browser& browser_;
  uint64_t world_ = 0; // grows with each frame that shows changes of the world
  uint64_t cancellations_ = 0;
  uint32_t viewer_ = 0;
  bool moving_ = false;
};

} // namespace vv
