// outbox.h: everything still to be sent to one worker. Messages go first, in order; arrays follow
// piece by piece, as fast as the worker's queue accepts them. A piece is made when it is sent. One
// thread.
#pragma once

#include <deque>
#include <functional>

#include "backend/cluster/master/parcel.h"

namespace openrt::cluster {

class Outbox {
 public:
  // Returns false if the queue is full; the frames are then unchanged.
  using Send = std::function<bool(Frames&&)>;

  void add(Frames&& frames);
  void add(OfferPtr array) { arrays_.push_back({std::move(array), 0}); }
  // Returns true if nothing is left that could be sent now. Arrays that are not packed yet stay for
  // later.
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
  struct QueuedMessage {
    Frames frames;
    size_t bytes = 0;
  };
  struct QueuedArray {
    OfferPtr array;
    uint64_t offset = 0; // offset of the next piece in the packed bytes
  };
  std::deque<QueuedMessage> messages_;
  size_t bytes_ = 0; // sum over messages_
  std::deque<QueuedArray> arrays_;
  Frames piece_; // a piece that was made when the queue turned out to be full
};

} // namespace openrt::cluster
