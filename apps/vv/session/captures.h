// captures.h: Renders the true pictures of instants, for files. The world stands still until a
// capture has read it; then it goes on, and the session's pictures wait until the capture has all
// its samples. Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

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
    // It waits while somebody moves, whose pictures are drawn then, and begins anew afterwards.
    bool givesWay = false;
  };

  // The renderer must outlive this object.
  explicit Captures(SharedRenderer& shared) : shared_(shared) {}

  void want(Request request);
  // Takes the still frame that is in flight, and has this number, as the capture.
  void adopt(Request request, uint64_t number);
  // Gives up what somebody has asked for: there will be no picture.
  void giveUp(uint64_t asker);
  // A capture has not read the world yet, so the world must not change.
  bool isWaiting() const { return !waiting_.empty() && !current_; }
  // A capture is waiting or in flight, so no other frame may be started.
  bool isPending() const { return current_ || !waiting_.empty(); }
  // Stops a capture in flight that gives way when somebody moves, and begins it anew a second after
  // that. seconds: time of any clock.
  void yield(bool moves, double seconds);
  bool isPostponed() const { return postponed_.has_value(); }
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
  std::optional<Request> current_; // the capture in flight
  bool isOwn_ = false;             // its frame is nobody else's
  uint64_t number_ = 0;            // that of its frame
  double samples_ = 0;
  std::optional<Request> postponed_; // gives way
  double movedAt_ = 0;               // when somebody moved last
};

} // namespace vv
