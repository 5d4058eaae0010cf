// outbox.h: what is to be sent to one worker: messages in their order, and arrays piece by piece
// behind them, as fast as its queue takes them. A piece is made when it is sent. One thread's.
#pragma once

#include <deque>
#include <functional>

#include "backend/cluster/master/parcel.h"

namespace openrt::cluster {

class Outbox {
 public:
  using Send = std::function<bool(Frames&&)>; // false: not now; the frames are left as they were

  void add(Frames&& frames);
  void add(OfferPtr array) { arrays_.push_back({std::move(array), 0}); }
  // True: nothing waits that could go. Arrays that are not packed yet are left for later.
  bool flush(uint64_t session, const Send& send);
  bool empty() const { return piece_.empty() && messages_.empty() && arrays_.empty(); }
  bool overfull() const {
    return messages_.size() > limits::outboxMessages || bytes_ > limits::outboxBytes;
  }
  void clear() {
    piece_.clear();
    messages_.clear();
    arrays_.clear();
    bytes_ = 0;
  }

 private:
  struct Waiting {
    Frames frames;
    size_t bytes = 0;
  };
  struct Travelling {
    OfferPtr array;
    uint64_t offset = 0; // in what is packed
  };
  std::deque<Waiting> messages_;
  size_t bytes_ = 0; // of these
  std::deque<Travelling> arrays_;
  Frames piece_; // made, but the queue was full
};

} // namespace openrt::cluster
