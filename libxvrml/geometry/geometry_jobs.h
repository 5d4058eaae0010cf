// geometry_jobs.h: work on large geometry nodes, done on other threads while the world goes on.
// Each job has a copy of its node (geometry/copied.h), so that no thread but the owner's touches
// the world, and the job shares nothing until it has ended. Used by the mapper and the picker. [the
// owner's thread; jobs run on threads of their own and use only their copy]
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/copied.h"

namespace xvrml {

template <class Result> class GeometryJobs {
 public:
  using Make = std::function<Result(const NodeRef& copy)>; // called on another thread
  enum class State : uint8_t {
    none,    // there is no job: whoever needs the result makes it at once
    pending, // it is being made, or waits for its turn
    ended    // take() does not wait
  };

  // Returns the state of a node's job, after it has begun one if the node is slow to build. After a
  // job that was in vain the next results are made at once, so that what changes all the time is
  // shown, too.
  State ask(Node& geometry, const Make& make) {
    if (!jobs_.contains(&geometry)) {
      if (!isSlowToBuild(geometry)) return State::none;
      if (atOnce_ > 0) {
        --atOnce_;
        return State::none;
      }
      jobs_.emplace(&geometry, Job{NodeRef(&geometry), make, {}});
      advance();
      return State::pending; // however fast the thread is
    }
    advance();
    Job& job = jobs_.at(&geometry);
    job.asked = true;
    return job.hasEnded() ? State::ended : State::pending;
  }

  // Ends a node's job and returns its result; waits for it. Nothing: there is none, and it is to be
  // made at once.
  std::optional<Result> take(const Node& geometry) {
    const auto known = jobs_.find(&geometry);
    if (known == jobs_.end()) return {};
    Job job = std::move(known->second);
    jobs_.erase(known);
    if (!job.result.valid()) return {};
    return job.result.get();
  }

  // Gives up the job of a node, if it has one: it has changed, or nobody needs it. The destructor
  // of a future waits, so those of jobs that run are kept until they have ended.
  void giveUp(const Node& geometry) {
    const auto known = jobs_.find(&geometry);
    if (known == jobs_.end()) return;
    Job job = std::move(known->second);
    jobs_.erase(known);
    if (job.isRunning()) abandoned_.push_back(std::move(job.result));
    atOnce_ = afterVainJob;
  }
  // Gives up the jobs that nobody has asked for since the last call.
  void sweep() {
    std::vector<NodeRef> unasked;
    for (auto& [node, job] : jobs_)
      if (!std::exchange(job.asked, false)) unasked.push_back(job.geometry);
    for (const NodeRef& node : unasked) giveUp(*node);
  }

  bool empty() const { return jobs_.empty(); }
  // Returns the nodes whose jobs have ended, or those of all jobs.
  std::vector<NodeRef> nodes(bool all) {
    advance();
    std::vector<NodeRef> found;
    for (const auto& [node, job] : jobs_)
      if (all || job.hasEnded()) found.push_back(job.geometry);
    return found;
  }

 private:
  static constexpr size_t most = 2; // jobs that run at a time, so that memory is bounded
  static constexpr int afterVainJob = 8;
  static bool isReady(const std::future<Result>& result) {
    return result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  struct Job {
    NodeRef geometry; // so that no other node gets its address
    Make make;
    std::future<Result> result; // invalid: it waits for its turn, or has failed
    bool failed = false;        // the node cannot be copied, or no thread is to be had
    bool asked = true;

    bool isRunning() const { return result.valid() && !isReady(result); }
    bool hasEnded() const { return failed || (result.valid() && isReady(result)); }
  };

  // Begins jobs that wait for their turn.
  void advance() {
    std::erase_if(abandoned_, [](const auto& result) { return isReady(result); });
    size_t running = abandoned_.size();
    for (const auto& [node, job] : jobs_) running += job.isRunning();
    for (auto& [node, job] : jobs_) {
      if (running >= most) return;
      if (job.failed || job.result.valid()) continue;
      begin(job);
      running += job.result.valid();
    }
  }
  static void begin(Job& job) {
    const NodeRef copy = copyOfGeometry(*job.geometry);
    job.failed = !copy;
    if (job.failed) return;
    try {
      job.result = std::async(std::launch::async, job.make, copy);
    } catch (const std::system_error&) { job.failed = true; }
  }
  std::unordered_map<const Node*, Job> jobs_;
  std::vector<std::future<Result>> abandoned_;
  int atOnce_ = 0; // slow results that are still to be made at once
};

} // namespace xvrml
