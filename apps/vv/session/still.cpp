#include "session/still.h"

#include <utility>

namespace vv {

namespace {

// Still frames of programs must not fade in over what the user of the window sees.
constexpr uint32_t programs = 0x5711;

} // namespace

void StillTaker::request(const Still& still) {
  still_ = still;
  answer_ = {};
  state_ = State::requested;
}

void StillTaker::start(const std::function<picture::View(double aspect)>& viewOf) {
  picture::LivePicture rest;
  while (renderer_.look(rest)) {} // ended frames that nobody has looked at
  static_cast<void>(renderer_.takeFailure());
  renderer_.change([this](picture::RenderSettings& settings) {
    usualChannels_ = std::exchange(settings.channels, still_.channels);
    settings.crop = still_.crop;
  });
  picture::LiveFrame frame;
  frame.view = viewOf(double(still_.width) / still_.height);
  frame.width = still_.width;
  frame.height = still_.height;
  frame.samples = still_.samples;
  frame.viewer = programs;
  state_ = State::rendering;
  isWhole_ = false;
  number_ = renderer_.start(frame);
}

void StillTaker::look() {
  picture::LivePicture seen;
  if (renderer_.look(seen) && seen.ended && seen.number == number_) isWhole_ = seen.finished;
  if (renderer_.state() != picture::LiveRenderer::State::idle) return;
  if (renderer_.look(seen) && seen.number == number_) isWhole_ = seen.finished;
  answer_.failure = renderer_.takeFailure();
  uint64_t copied = 0;
  if (answer_.failure.empty() && !isWhole_)
    answer_.failure = "the picture was cancelled";
  else if (answer_.failure.empty() &&
           (!renderer_.copy(answer_.picture, &copied) || copied != number_))
    answer_.failure = "there is no picture";
  renderer_.change([this](picture::RenderSettings& settings) {
    settings.channels = usualChannels_;
    settings.crop = {}; // frames that are shown are whole
  });
  state_ = State::finished;
}

std::optional<StillAnswer> StillTaker::take() {
  if (state_ != State::finished) return {};
  state_ = State::none;
  return std::exchange(answer_, {});
}

} // namespace vv
