// distribution.h: decides who sends an array to a worker that needs it: the master, or a worker
// that has it. The master sends a large array to one worker; those that have got it send it on,
// each to one other at a time, so that the number of workers that have it doubles with each round.
// It has no sockets, threads or clock. One thread.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "backend/cluster/master/parcel.h"
#include "backend/cluster/master/scheduler.h"

namespace openrt::cluster {

class Distribution {
 public:
  static constexpr WorkerId master = 0; // as a sender

  // address: at which other workers can ask this one; empty: it neither asks others nor sends.
  // near: the address is on the master's machine, so only workers there can use it.
  void join(WorkerId worker, const std::string& address, bool near);
  void leave(WorkerId worker);
  bool shares(WorkerId worker) const { return members_.contains(worker); }
  const std::string& addressOf(WorkerId worker) const { return members_.at(worker).address; }

  void need(WorkerId worker, const OfferPtr& offer, double now);
  // The worker has said that it need not be sent the array.
  void has(WorkerId worker, const OfferPtr& offer);
  // The worker has the arrays now, from whomever. kept: it can send them on.
  void got(WorkerId worker, const std::vector<Hash>& arrays, bool kept, double now);
  // The worker could not get the arrays from the worker that it was to ask.
  void failed(WorkerId worker, const std::vector<Hash>& arrays);

  struct Transfer {
    WorkerId to = 0, from = master;
    OfferPtr offer;
  };
  // Returns the transfers that are to begin now; call it after each of the above, and when time
  // has passed.
  std::vector<Transfer> transfers(double now);

 private:
  struct Member {
    std::string address;
    bool near = false;
    uint32_t sending = 0;          // arrays that it sends now
    std::set<WorkerId> failedWith; // workers from which it could not get arrays
    std::set<WorkerId> failedFor;  // workers that could not get arrays from it
    bool unreachable() const { return failedFor.size() >= mostFailures; }
    bool alone() const { return failedWith.size() >= mostFailures; }
  };
  struct Known { // an array
    std::weak_ptr<Offer> offer;
    std::set<WorkerId> holders;
    std::map<WorkerId, WorkerId> underway; // receivers and their senders
    std::deque<std::pair<WorkerId, OfferPtr>> waiting;
  };
  static constexpr size_t mostFailures = 2;
  // A worker sends so many arrays at once. Arrays that had to wait for this are looked at again
  // when half of them are done.
  static constexpr uint32_t mostSending = 64;
  // Smaller arrays than this are sent to up to so many workers at first, so that a few workers get
  // the small changes of a live view without delay.
  static constexpr size_t mediumArray = size_t(1) << 18, mostFirst = 4;
  static constexpr double patience = 5;         // seconds without any arrival, and
  static constexpr double leastSpeed = 4 << 20; // bytes a second of the largest array

  std::optional<WorkerId> senderFor(const Known& known, WorkerId worker) const;
  void begin(const Hash& hash, Known& known, WorkerId from, std::vector<Transfer>& begun);
  void release(const Hash& hash, Known& known, WorkerId worker);
  void stopWaiting(Known& known, WorkerId worker);
  void sweep();

  std::map<WorkerId, Member> members_;
  std::map<Hash, Known> arrays_;
  std::set<Hash> open_, crowded_; // arrays to look at now; those whose holders send enough
  std::vector<Transfer> direct_;  // the master alone is left for them
  size_t waiting_ = 0, sweepAt_ = 1024;
  uint64_t largest_ = 0; // bytes, among the arrays that somebody has waited for since none did
  double lastArrival_ = 0;
};

} // namespace openrt::cluster
