// flow.h: The flow control of one page, as pure logic: a page gets the next picture when it has
// acknowledged the last one, and sends a limited number of messages. [one thread]
#pragma once

#include <algorithm>
#include <cstdint>

#include "server/limits.h"

namespace vv::server {

// Decides which picture a page gets next. Pictures are numbered; a newer one has a higher number. A
// page that is slow or silent misses pictures, and its next one is the newest.
class PictureFlow {
 public:
  // A newer picture exists.
  void offer(uint32_t number) { newest_ = number; }
  // Returns the number of the picture to send now, or 0: none. It counts as sent.
  uint32_t take() {
    if (sent_ != acknowledged_ || newest_ == sent_) return 0;
    return sent_ = newest_;
  }
  // The page has shown a picture. Returns false if it was not the one that it got last.
  bool acknowledge(uint32_t number) {
    if (number == 0 || number != sent_ || sent_ == acknowledged_) return false;
    acknowledged_ = number;
    return true;
  }
  // The picture that was taken last could not be sent.
  void drop() { acknowledged_ = sent_; }
  bool isWaiting() const { return sent_ != acknowledged_; }

 private:
  uint32_t newest_ = 0, sent_ = 0, acknowledged_ = 0; // 0: none yet
};

// A token bucket: so many messages per second on average, and a burst at once.
class RateLimit {
 public:
  RateLimit(double perSecond, int burst) : perSecond_(perSecond), burst_(burst) {}
  // Notes a message at a time of any clock, in seconds. Returns false if it is one too many.
  bool allow(double seconds) {
    if (begun_) level_ += std::max(0.0, seconds - last_) * perSecond_;
    level_ = std::min(level_, burst_);
    last_ = begun_ ? std::max(last_, seconds) : seconds;
    begun_ = true;
    if (level_ < 1) return false;
    level_ -= 1;
    return true;
  }

 private:
  double perSecond_, burst_, level_ = burst_, last_ = 0;
  bool begun_ = false;
};

// Limits how much one page sends.
struct MessageRate : RateLimit {
  MessageRate() : RateLimit(maxMessagesPerSecond, maxMessageBurst) {}
};

// Limits how many pages of the web a world opens.
struct OpenRate : RateLimit {
  OpenRate() : RateLimit(maxOpensPerMinute / 60.0, maxOpenBurst) {}
};

struct PictureSize {
  int width = 1, height = 1;
  bool operator==(const PictureSize&) const = default;
};

// Returns the size of pictures for a page of this size in pixels of the device: the same, or the
// largest one of about the same shape within the limits.
// most: the largest number of pixels.
PictureSize pictureSizeFor(int width, int height, double most = maxPicturePixels);

} // namespace vv::server
