// shared_renderer.h: The renderer of a session. Its users, the picture loops of the viewers and the
// captures, take turns: one frame is in flight at a time, two with a cluster. Owned by a session.
// [the browser's thread]
#pragma once

#include <cstdint>
#include <deque>

#include "libpicture/live.h"

namespace vv {

class SharedRenderer {
 public:
  // The browser must outlive the renderer.
  SharedRenderer(xvrml::Browser& browser, const picture::RenderSettings& settings)
      : live(browser, settings), view(settings.view), browser_(browser) {}

  picture::LiveRenderer live;
  picture::ViewTransform view; // how the world is shown; users add to its exposure

  // Starts a frame as LiveRenderer::start does, and returns its number. moving: the next frame
  // waits for its end, or not even that where the renderer permits it; other frames are cancelled
  // when their time is over.
  uint64_t start(const picture::LiveFrame& frame, bool moving) {
    if (browser_.hasChanges()) ++world_;
    moving_ = moving;
    viewer_ = frame.viewer;
    const uint64_t number = live.start(frame);
    started_.push_back({number, frame.viewer});
    if (started_.size() > remembered) started_.pop_front();
    return number;
  }
  // Reads sensors as LiveRenderer::measure does. [idle]
  void measure(const picture::LiveMeasure& measure) {
    if (browser_.hasChanges()) ++world_;
    live.measure(measure);
  }
  // Returns the viewer of a frame that was started lately.
  uint32_t viewerOf(uint64_t number) const {
    for (const Started& one : started_)
      if (one.number == number) return one.viewer;
    return nobody;
  }
  // Makes the frames of a viewer who has left nobody's, because another may get the number.
  void forget(uint32_t viewer) {
    for (Started& one : started_)
      if (one.viewer == viewer) one.viewer = nobody;
    if (viewer_ == viewer) viewer_ = nobody;
    live.forget(viewer);
  }
  // Frees the pictures of all viewers while nobody looks. The smallest frame takes the place of the
  // last one, with its sums. [idle]
  void release() {
    live.release();
    picture::LiveFrame smallest;
    smallest.width = smallest.height = 1;
    smallest.viewer = nobody;
    smallest.purpose = picture::LiveFrame::Purpose::rawPreview;
    start(smallest, false);
  }
  // Returns the state of the world that the last frame shows, for isOutdated().
  uint64_t world() const { return world_; }
  // Tells whether the world has changed since it had this state.
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
  struct Started {
    uint64_t number;
    uint32_t viewer;
  };
  static constexpr uint32_t nobody = ~uint32_t(0) - 1; // no viewer has this number
  static constexpr size_t remembered = 8; // more frames than can be in flight or unseen

  xvrml::Browser& browser_;
  std::deque<Started> started_;
  uint64_t world_ = 0; // grows with each frame that shows changes of the world
  uint64_t cancellations_ = 0;
  uint32_t viewer_ = 0;
  bool moving_ = false;
};

} // namespace vv
