// captures.h: Renders the true pictures of instants, for files. The world stands still until a
// capture has read it; then it goes on, and the session's pictures wait until the capture has all
// its samples. Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "session/shared_renderer.h"

namespace vv {

class Captures {
 public:
  // Receives the picture with the channels of the settings; null: it could not be rendered.
  using Done = std::function<void(const picture::Picture* picture)>;
  struct Request {
    uint64_t asker;           // for giveUp()
    picture::LiveFrame frame; // its viewer is set by Captures
    xvrml::MapOptions::Headlight headlight;
    picture::ViewTransform view;
    Done done;
  };

  // The renderer must outlive this object.
  explicit Captures(SharedRenderer& shared) : shared_(shared) {}

  void want(Request request);
  // Takes the still frame that is in flight, and has this number, as the capture.
  void adopt(uint64_t asker, uint64_t number, Done done);
  // Gives up what somebody has asked for: there will be no picture.
  void giveUp(uint64_t asker);
  // A capture has not read the world yet, so the world must not change.
  bool isWaiting() const { return !waiting_.empty() && !inFlight_; }
  // A capture is waiting or in flight, so no other frame may be started.
  bool isPending() const { return inFlight_ || !waiting_.empty(); }
  // Starts the next capture as soon as the renderer is free. [not while mapping]
  void advance();
  // Notes a picture that the renderer has returned. Returns true if it is nobody's but a capture's.
  bool note(const picture::LivePicture& picture, uint32_t viewer);
  // Notes that the renderer is idle and has no more pictures.
  void noteIdle();
  // Samples of the capture in flight so far, mean over the pixels.
  double samples() const { return samples_; }

 private:
  void end(const picture::Picture* picture);

  // Differs from the numbers of all viewers.
  static constexpr uint32_t ownViewer = ~uint32_t(0);

  SharedRenderer& shared_;
  std::deque<Request> waiting_;
  bool inFlight_ = false;
  // The capture in flight: who wants it, whether its frame is nobody else's, the frame's number.
  uint64_t asker_ = 0;
  bool isOwn_ = false;
  uint64_t number_ = 0;
  Done done_;
  double samples_ = 0;
};

} // namespace vv
