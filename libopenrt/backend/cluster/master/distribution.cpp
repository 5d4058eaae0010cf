#include "backend/cluster/master/distribution.h"

#include <algorithm>

namespace openrt::cluster {

void Distribution::join(WorkerId worker, const std::string& address, bool near) {
  if (address.empty()) return;
  Member& member = members_[worker];
  member.address = address;
  member.near = near;
}

void Distribution::leave(WorkerId worker) {
  if (!members_.erase(worker)) return;
  for (auto& [hash, known] : arrays_) {
    const bool held = known.holders.erase(worker) > 0;
    if (held || known.underway.contains(worker)) release(hash, known, worker);
    stopWaiting(known, worker);
  }
}

void Distribution::need(WorkerId worker, const OfferPtr& offer, double now) {
  const auto member = members_.find(worker);
  if (member == members_.end() || member->second.alone() ||
      offer->array->size() < limits::keptArrayBytes) {
    direct_.push_back({worker, master, offer});
    return;
  }
  sweep();
  if (waiting_ == 0) {
    lastArrival_ = now;
    largest_ = 0;
  }
  Known& known = arrays_[offer->hash];
  known.offer = offer;
  known.waiting.emplace_back(worker, offer);
  waiting_++;
  largest_ = std::max<uint64_t>(largest_, offer->array->size());
  open_.insert(offer->hash);
}

void Distribution::has(WorkerId worker, const OfferPtr& offer) {
  if (!shares(worker)) return;
  sweep();
  Known& known = arrays_[offer->hash];
  known.offer = offer;
  known.holders.insert(worker);
  open_.insert(offer->hash);
}

void Distribution::got(WorkerId worker, const std::vector<Hash>& arrays, bool kept, double now) {
  if (!shares(worker)) return;
  for (const Hash& hash : arrays) {
    const auto found = arrays_.find(hash);
    if (found == arrays_.end()) continue;
    lastArrival_ = now;
    if (kept) found->second.holders.insert(worker);
    stopWaiting(found->second, worker);
    release(hash, found->second, worker);
  }
}

void Distribution::failed(WorkerId worker, const std::vector<Hash>& arrays) {
  const auto member = members_.find(worker);
  if (member == members_.end()) return;
  for (const Hash& hash : arrays) {
    const auto found = arrays_.find(hash);
    if (found == arrays_.end()) continue;
    Known& known = found->second;
    const auto transfer = known.underway.find(worker);
    if (transfer == known.underway.end() || transfer->second == master) continue;
    if (const auto sender = members_.find(transfer->second); sender != members_.end()) {
      sender->second.failedFor.insert(worker);
      member->second.failedWith.insert(sender->first);
      known.holders.erase(sender->first);
    }
    release(hash, known, worker);
    if (const OfferPtr offer = known.offer.lock()) {
      direct_.push_back({worker, master, offer});
      known.underway[worker] = master; // others wait for it
    }
  }
}

// Ends the transfer to a worker.
void Distribution::release(const Hash& hash, Known& known, WorkerId worker) {
  open_.insert(hash);
  const auto transfer = known.underway.find(worker);
  if (transfer == known.underway.end()) return;
  const auto sender = members_.find(transfer->second);
  known.underway.erase(transfer);
  if (sender == members_.end() || --sender->second.sending != mostSending / 2) return;
  open_.merge(crowded_);
  crowded_.clear();
}

void Distribution::stopWaiting(Known& known, WorkerId worker) {
  waiting_ -= std::erase_if(known.waiting, [worker](const auto& w) { return w.first == worker; });
}

// Returns who shall send the array to the worker: of the holders the one that sends least, or the
// master if nobody has the array or will have it. Returns nothing if it is better to wait.
std::optional<WorkerId> Distribution::senderFor(const Known& known, WorkerId worker) const {
  const size_t bytes = known.waiting.front().second->array->size(),
               first = std::clamp<size_t>(mediumArray / std::max<size_t>(bytes, 1), 1, mostFirst);
  std::optional<WorkerId> best;
  bool usable = known.underway.size() >= first;
  uint32_t least = mostSending;
  const Member& receiver = members_.at(worker);
  for (const WorkerId holder : known.holders) {
    const Member& member = members_.at(holder);
    const bool busy = std::any_of(known.underway.begin(), known.underway.end(),
                                  [holder](const auto& t) { return t.second == holder; });
    if (member.unreachable() || receiver.failedWith.contains(holder) ||
        (member.near && !receiver.near))
      continue;
    usable = true;
    if (busy || member.sending >= least) continue;
    best = holder;
    least = member.sending;
  }
  return best || usable ? best : master;
}

void Distribution::begin(const Hash& hash, Known& known, WorkerId from,
                         std::vector<Transfer>& begun) {
  const auto [to, offer] = std::move(known.waiting.front());
  known.waiting.pop_front();
  waiting_--;
  known.underway[to] = from;
  if (from != master) members_.at(from).sending++;
  begun.push_back({to, from, offer});
  open_.insert(hash);
}

std::vector<Distribution::Transfer> Distribution::transfers(double now) {
  std::vector<Transfer> begun = std::exchange(direct_, {});
  // Nothing arrives: whoever hangs, the others shall not wait for it.
  if (waiting_ > 0 && now - lastArrival_ > patience + double(largest_) / leastSpeed)
    for (auto& [hash, known] : arrays_)
      while (!known.waiting.empty()) begin(hash, known, master, begun);
  for (const Hash& hash : std::exchange(open_, {})) {
    const auto found = arrays_.find(hash);
    if (found == arrays_.end()) continue;
    Known& known = found->second;
    while (!known.waiting.empty()) {
      const std::optional<WorkerId> from = senderFor(known, known.waiting.front().first);
      if (!from) break;
      begin(hash, known, *from, begun);
    }
    if (!known.waiting.empty()) crowded_.insert(hash);
  }
  open_.clear(); // begin() has marked what was just looked at
  return begun;
}

// Forgets arrays that no scene has any more, when there are many.
void Distribution::sweep() {
  if (arrays_.size() < sweepAt_) return;
  std::erase_if(arrays_, [this](const auto& entry) {
    const auto& [hash, known] = entry;
    const bool over = known.waiting.empty() && known.underway.empty() && known.offer.expired();
    if (over) crowded_.erase(hash);
    return over;
  });
  sweepAt_ = 2 * arrays_.size() + 1024;
}

} // namespace openrt::cluster
