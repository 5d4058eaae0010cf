// worker_core.h: a machine that does jobs: applies commits in their order to a local backend,
// prepares the scene, runs jobs on its threads. In openrt-worker behind a socket, in the master's
// own process without.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "backend/backend.h"
#include "render/frame/frame_work.h"
#include "render/frame/job.h"

namespace openrt::cluster {

using Epoch = uint64_t; // number of a commit; a frame has that of the commit before it
using Lease =
    uint64_t; // number of a job that was handed to a worker; never used again in a session

struct LeasedJob {
  Lease lease = 0;
  Job job;
};

struct Prepared { // what a worker knows of a frame once its scene is prepared
  FrameFacts facts;
  edit::FrameSettingsT frame; // with the transport that was chosen
  RTstats stats{};            // of the scene
};

// Called from the core's threads, one call at a time. Must not call the core.
class WorkerSink {
 public:
  virtual ~WorkerSink() = default;
  virtual void ready(Epoch epoch, const Prepared& prepared) = 0;
  virtual void
  failed(Epoch epoch,
         const std::string& why) = 0; // of preparing, or of a job: the frame cannot be made here
  virtual void done(Epoch epoch, const LeasedJob& job, JobResult&& result) = 0;
};

class WorkerCore {
 public:
  WorkerCore(const BackendOptions& options, WorkerSink& sink);
  ~WorkerCore(); // gives up what it does, and waits
  uint32_t threads() const;
  // These return at once. [any], in the order of their effects.
  // whole: forget the scene that was before. prepare: build it, and say ready(); else later edits
  // may save the work. Jobs of earlier epochs are finished first.
  void scene(Epoch epoch, std::shared_ptr<const Commit> commit, bool whole, bool prepare);
  void prepare(Epoch epoch); // the last scene, if it was not
  void work(Epoch epoch, std::span<const LeasedJob> jobs);
  void
  drop(Epoch epoch); // jobs of this and earlier epochs: not begun ones never, others are given up
  // Runs a function on the local backend after all that was asked before, while no job runs; waits
  // for it. Rethrows.
  void ask(const std::function<void(Backend&)>& question);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
