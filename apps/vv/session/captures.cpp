#include "session/captures.h"

#include <utility>
#include <vector>

namespace vv {

void Captures::want(Request request) { waiting_.push_back(std::move(request)); }

void Captures::adopt(uint64_t asker, uint64_t number, Done done) {
  inFlight_ = true;
  asker_ = asker;
  isOwn_ = false;
  number_ = number;
  done_ = std::move(done);
  samples_ = 0;
}

void Captures::giveUp(uint64_t asker) {
  std::vector<Done> dropped;
  std::erase_if(waiting_, [&](Request& request) {
    if (request.asker != asker) return false;
    dropped.push_back(std::move(request.done));
    return true;
  });
  for (const Done& done : dropped) done(nullptr);
  if (!inFlight_ || asker_ != asker) return;
  if (isOwn_) shared_.cancel();
  end(nullptr);
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
  shared_.live.change([&](picture::RenderSettings& s) {
    s.headlight = next.headlight;
    s.view = next.view;
  });
  adopt(next.asker, shared_.start(next.frame, false), std::move(next.done));
  isOwn_ = true;
}

bool Captures::note(const picture::LivePicture& picture, uint32_t viewer) {
  if (inFlight_ && picture.number == number_) samples_ = picture.samples;
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
