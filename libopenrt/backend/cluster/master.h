// master.h: the master's side of the protocol (docs/protocol.md): what to say to which worker, and what their messages mean.
// Pure events: no sockets, no threads, no clock, so that a simulator can drive it as the backend does. One thread's.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "backend/cluster/scheduler.h"
#include "backend/cluster/wire.h"
#include "scene/commit.h"

namespace openrt::cluster {

struct MasterOptions {
  SchedulerOptions schedule;
  bool tolerant = false;     // workers of another instruction set are taken
  BackendOptions local;      // shaders (to name and hash what a scene needs), log
  uint32_t localThreads = 0; // of the worker here; 0: none as long as others live
};

class Master {
 public:
  using Send = std::function<bool(Peer, Frames&&)>;
  Master(const MasterOptions& options, Send send, WorkerCore* here);
  ~Master();

  // What the wire tells.
  void joined(Peer peer, const std::string& address, double now);
  void left(Peer peer, const std::string& why, double now);
  void message(Peer peer, Frames&& frames, double now);
  // What the worker in this process tells (WorkerSink), passed on to this thread.
  void readyHere(Epoch epoch, const Prepared& prepared, double now);
  void failedHere(Epoch epoch, const std::string& why, double now);
  void doneHere(Epoch epoch, const LeasedJob& job, JobResult&& result, double now);

  // What the application tells. Commits in their order; the frame of a commit is begun once a worker has prepared it.
  void commit(Epoch epoch, std::shared_ptr<const Commit> commit, bool frame, double now);
  void cancel(Epoch epoch, double now);
  // Hands out what there is; returns when to be called again at the latest.
  double advance(double now);

  struct FrameState {
    std::shared_ptr<FrameWork> work; // null: nobody has prepared it yet
    Prepared prepared;
    std::string failure; // not empty: it cannot be made
    bool over = false;
  };
  FrameState frame(Epoch epoch) const;
  void forget(Epoch epoch); // a frame that was read

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
