#include "session/still.h"

#include <utility>

namespace vv {

using RendererState = picture::LiveRenderer::State;

void StillTaker::request(const Still& still) {
  still_ = still;
  answer_ = {};
  if (state_ != State::rendering) {
    state_ = State::requested;
    return;
  }
  // The frame in flight belongs to the request before.
  renderer_.cancel();
  end({{}, "another picture was asked for"});
  state_ = State::requested;
}

bool StillTaker::advance(const std::function<picture::View(double aspect)>& viewOf) {
  if (state_ != State::requested) return false;
  if (renderer_.state() != RendererState::idle) {
    renderer_.cancel();
    return false;
  }
  picture::LivePicture rest;
  while (renderer_.look(rest)) {} // ended frames that nobody has looked at
  renderer_.change([this](picture::RenderSettings& settings) {
    usualChannels_ = std::exchange(settings.channels, still_.channels);
  });
  picture::LiveFrame frame;
  frame.view = viewOf(double(still_.width) / still_.height);
  frame.width = still_.width;
  frame.height = still_.height;
  frame.samples = still_.samples;
  state_ = State::rendering;
  renderer_.start(frame);
  return true;
}

void StillTaker::look() {
  picture::LivePicture seen;
  const bool idle = renderer_.state() == RendererState::idle;
  bool ended = false, finished = false;
  while (renderer_.look(seen)) {
    if (!seen.ended) break;
    ended = true;
    finished = seen.finished;
  }
  if (!ended && !idle) return;
  StillAnswer answer;
  answer.failure = renderer_.takeFailure();
  if (answer.failure.empty() && !finished)
    answer.failure = "the picture was cancelled";
  else if (answer.failure.empty() && !renderer_.copy(answer.picture))
    answer.failure = "there is no picture";
  end(std::move(answer));
}

void StillTaker::end(StillAnswer answer) {
  renderer_.change(
      [this](picture::RenderSettings& settings) { settings.channels = usualChannels_; });
  answer_ = std::move(answer);
  state_ = State::finished;
}

std::optional<StillAnswer> StillTaker::take() {
  if (state_ != State::finished) return {};
  state_ = State::none;
  return std::exchange(answer_, {});
}

} // namespace vv
