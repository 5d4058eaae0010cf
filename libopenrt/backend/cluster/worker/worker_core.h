// worker_core.h: executes jobs: applies commits in order to a local backend, prepares the scene and
// runs jobs on its threads. Used by openrt-worker behind a socket, and by the master's process
// directly.
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

// Number of a commit. A frame has the number of the commit before it.
using Epoch = uint64_t;
// Number of a job handed to a worker; never reused in a session.
using Lease = uint64_t;

struct LeasedJob {
  Lease lease = 0;
  Job job;
};

struct Prepared { // facts about a frame, known once its scene is prepared
  FrameFacts facts;
  edit::FrameSettingsT frame; // includes the transport that was chosen
  RTstats stats{};            // scene statistics
};

// Receives results. Called on the core's threads, one call at a time. Must not call the core.
class WorkerSink {
 public:
  virtual ~WorkerSink() = default;
  virtual void ready(Epoch epoch, const Prepared& prepared) = 0;
  // Preparing the scene or a job has failed: this worker cannot render the frame.
  virtual void failed(Epoch epoch, const std::string& why) = 0;
  virtual void done(Epoch epoch, const LeasedJob& job, JobResult&& result) = 0;
};

class WorkerCore {
 public:
  WorkerCore(const BackendOptions& options, WorkerSink& sink);
  ~WorkerCore(); // stops the running jobs and waits
  uint32_t threads() const;
  // [any] Sets the instruction set of the scenes that begin after earlier requests.
  void useInstructionSet(const std::string& isa);
  // [any] These return at once and take effect in order. whole: drops the scene before. prepare:
  // builds the scene and calls ready(); without it, later edits may save the work. Jobs of earlier
  // epochs are finished first.
  void scene(Epoch epoch, std::shared_ptr<const Commit> commit, bool whole, bool prepare);
  void prepare(Epoch epoch); // prepares the last scene, if it is not prepared
  void work(Epoch epoch, std::span<const LeasedJob> jobs);
  // Drops jobs of this and earlier epochs: removes waiting ones and stops running ones.
  void drop(Epoch epoch);
  // Runs a function on the local backend, after all earlier requests and while no job runs; waits
  // for it and rethrows its exceptions.
  void ask(const std::function<void(Backend&)>& question);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
