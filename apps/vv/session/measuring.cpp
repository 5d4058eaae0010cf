#include "session/measuring.h"

#include <new>
#include <utility>

namespace vv {

void Measuring::want(const picture::LiveMeasure& measure, Done done) {
  wanted_ = measure;
  done_ = std::move(done);
}

void Measuring::giveUp() {
  if (!isPending()) return;
  if (!isWaiting()) shared_.cancel();
  wanted_.reset();
  end({{}, "the measurement was given up"});
}

void Measuring::advance() {
  if (isWaiting()) {
    if (!shared_.isIdle()) {
      if (!shared_.isMoving()) shared_.cancel();
      return;
    }
    try {
      shared_.measure(*std::exchange(wanted_, std::nullopt));
    } catch (const std::bad_alloc&) { return end({{}, "not enough memory"}); }
    world_ = shared_.world();
  } else if (const std::optional<picture::LiveReadings> readings = shared_.live.takeReadings()) {
    end(*readings);
  }
}

void Measuring::end(const picture::LiveReadings& readings) {
  std::exchange(done_, nullptr)(readings);
}

} // namespace vv
