#include "backend/cluster/master/outbox.h"

namespace openrt::cluster {

void Outbox::add(Frames&& frames) {
  const size_t bytes = bytesOf(frames);
  messages_.push_back({std::move(frames), bytes});
  bytes_ += bytes;
}

bool Outbox::flush(uint64_t session, const Send& send) {
  if (!piece_.empty()) { // older than everything else that waits
    if (!send(std::move(piece_))) return false;
    piece_.clear();
  }
  while (!messages_.empty()) {
    if (!send(std::move(messages_.front().frames))) return false;
    bytes_ -= messages_.front().bytes;
    messages_.pop_front();
  }
  while (!arrays_.empty() && arrays_.front().array->ready) {
    QueuedArray& next = arrays_.front();
    const Offer& offer = *next.array;
    Frames frames =
        encode(session, pieceOf(offer.hash, offer.array->size(), offer.packed, next.offset));
    next.offset += pieceBytes;
    if (next.offset >= offer.packed.size()) arrays_.pop_front();
    if (!send(std::move(frames))) {
      piece_ = std::move(frames);
      return false;
    }
  }
  return true;
}

} // namespace openrt::cluster
