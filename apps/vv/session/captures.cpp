#include "session/captures.h"

#include <utility>

namespace vv {

void Captures::want(Request request) { waiting_.push_back(std::move(request)); }

void Captures::adopt(uint64_t number, Done done) {
  inFlight_ = true;
  number_ = number;
  done_ = std::move(done);
}

void Captures::advance() {
  if (inFlight_ || waiting_.empty()) return;
  if (!shared_.isIdle()) {
    if (!shared_.isMoving()) shared_.cancel();
    return;
  }
  Request next = std::move(waiting_.front());
  waiting_.pop_front();
  next.frame.viewer = ownViewer;
  next.frame.purpose = picture::LiveFrame::Purpose::still;
  shared_.live.change([&](picture::RenderSettings& s) { s.headlight = next.headlight; });
  adopt(shared_.start(next.frame, false), std::move(next.done));
}

bool Captures::note(const picture::LivePicture& picture, uint32_t viewer) {
  if (inFlight_ && picture.number == number_ && picture.ended) {
    picture::Picture copied;
    uint64_t number = 0;
    const bool complete =
        picture.finished && shared_.live.copy(copied, &number) && number == number_;
    end(complete ? &copied : nullptr);
  }
  return viewer == ownViewer;
}

void Captures::noteIdle() {
  if (inFlight_) end(nullptr);
}

void Captures::end(const picture::Picture* picture) {
  inFlight_ = false;
  if (const Done done = std::exchange(done_, nullptr)) done(picture);
}

} // namespace vv
