#include "session/captures.h"

#include <utility>
#include <vector>

namespace vv {

void Captures::want(Request request) { waiting_.push_back(std::move(request)); }

void Captures::adopt(Request request, uint64_t number) {
  current_ = std::move(request);
  isOwn_ = false;
  number_ = number;
  samples_ = 0;
}

void Captures::yield(bool moves, double seconds) {
  constexpr double rest = 1; // seconds
  if (moves) {
    movedAt_ = seconds;
    if (!current_ || !current_->givesWay) return;
    if (isOwn_) shared_.cancel();
    postponed_ = std::exchange(current_, std::nullopt);
    samples_ = 0;
  } else if (postponed_ && seconds >= movedAt_ + rest) {
    waiting_.push_front(*std::exchange(postponed_, std::nullopt));
  }
}

void Captures::giveUp(uint64_t asker) {
  std::vector<Done> dropped;
  std::erase_if(waiting_, [&](Request& request) {
    if (request.asker != asker) return false;
    dropped.push_back(std::move(request.done));
    return true;
  });
  if (postponed_ && postponed_->asker == asker)
    dropped.push_back(std::exchange(postponed_, std::nullopt)->done);
  for (const Done& done : dropped) done(nullptr);
  if (!current_ || current_->asker != asker) return;
  if (isOwn_) shared_.cancel();
  end(nullptr);
}

void Captures::advance() {
  if (current_ || waiting_.empty()) return;
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
  const uint64_t number = shared_.start(next.frame, false);
  adopt(std::move(next), number);
  isOwn_ = true;
}

bool Captures::note(const picture::LivePicture& picture, uint32_t viewer) {
  if (current_ && picture.number == number_) samples_ = picture.samples;
  if (current_ && picture.number == number_ && picture.ended) {
    picture::Picture copied;
    uint64_t number = 0;
    const bool complete =
        picture.finished && shared_.live.copy(copied, &number) && number == number_;
    end(complete ? &copied : nullptr);
  }
  return viewer == ownViewer;
}

void Captures::noteIdle() {
  if (current_) end(nullptr);
}

void Captures::end(const picture::Picture* picture) {
  if (const std::optional<Request> ended = std::exchange(current_, std::nullopt))
    ended->done(picture);
}

} // namespace vv
