#include "session/captures.h"

#include <utility>

namespace vv {

void Captures::want(Request request) { waiting_.push_back(std::move(request)); }

void Captures::adopt(uint32_t viewer, Done done) {
  inFlight_ = true;
  viewer_ = viewer;
  done_ = std::move(done);
  samples_ = 0;
}

void Captures::advance() {
  if (inFlight_ || waiting_.empty()) return;
  if (!shared_.isIdle()) {
    if (!shared_.isMoving()) shared_.cancel();
    return;
  }
  Request next = std::move(waiting_.front());
  waiting_.pop_front();
  adopt(ownNumber, std::move(next.done));
  next.frame.viewer = ownNumber;
  next.frame.purpose = picture::LiveFrame::Purpose::still;
  shared_.live.change([&](picture::RenderSettings& s) { s.headlight = next.headlight; });
  shared_.start(next.frame, false);
}

bool Captures::note(const picture::LivePicture& picture) {
  if (!inFlight_ || picture.viewer != viewer_) return false;
  const bool own = viewer_ == ownNumber;
  samples_ = picture.samples;
  if (picture.ended) {
    picture::Picture copied;
    end(picture.finished && shared_.live.copy(copied) ? &copied : nullptr);
  }
  return own;
}

void Captures::noteIdle() {
  if (inFlight_) end(nullptr);
}

void Captures::end(const picture::Picture* picture) {
  inFlight_ = false;
  if (const Done done = std::exchange(done_, nullptr)) done(picture);
}

} // namespace vv
