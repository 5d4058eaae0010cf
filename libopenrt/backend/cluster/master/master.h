// master.h: the master's side of the protocol (docs/protocol.md): what to say to which worker, and
// what their messages mean. Pure events: no sockets, no threads, no clock, so that a simulator can
// drive it as the backend does. One thread's.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backend/cluster/master/scheduler.h"
#include "backend/cluster/net/messages.h"
#include "backend/cluster/net/wire.h"
#include "scene/commit.h"

namespace openrt::cluster {

struct MasterOptions {
  SchedulerOptions schedule;
  bool tolerant = false;     // workers of another instruction set are taken
  BackendOptions local;      // shaders (to name and hash what a scene needs), log
  uint32_t localThreads = 0; // of the worker here; 0: none as long as others live
  uint32_t require = 0;      // workers without which nothing is handed out
  double patience = 10;      // seconds for which fewer are borne
  double grace =
      1; // seconds that a worker here without threads of its own waits for the first other one
  uint64_t session = 1; // sessions of workers are numbered from here; a random number keeps those
                        // of two masters apart
  message::Hello self;  // what workers are compared with (greeting.h)
  std::function<void(Peer, const std::string& why)> close; // a worker is refused
  // Run the first function on any thread and the second, later, on the master's. None: both at
  // once. background: what takes long, one after the other; results: unpacking and merging what
  // workers have made, as many at once as there are threads for it.
  using Then = std::function<void(double now)>;
  using Elsewhere = std::function<void(std::function<void()> heavy, Then then)>;
  Elsewhere background, results;
};

class Master {
 public:
  // False: the peer's queue is full; the frames are left as they were. Or it has left.
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

  // What the application tells. Commits in their order, epochs ascend; the frame of a commit is
  // begun once a worker has prepared it.
  void commit(Epoch epoch, std::shared_ptr<const Commit> commit, bool frame, double now);
  void cancel(Epoch epoch, double now); // this frame and those before
  // Hands out what there is; returns when to be called again at the latest.
  double advance(double now);
  // So many seconds this thread has been busy since the last call: what a job costs decides how
  // large jobs are.
  void busy(double seconds);
  // The worker here gets the scene of the last commit, to be asked about it. False: frames before
  // it are not finished yet, or there is no worker here.
  bool bringHere();

  struct FrameState {
    std::shared_ptr<FrameWork> work; // null: nobody has prepared it yet
    Prepared prepared;
    std::string failure;  // not empty: it cannot be made
    bool missing = false; // and that is because workers are missing
    bool over = false;    // finished, failed or cancelled
  };
  FrameState frame(Epoch epoch) const;
  void forget(Epoch epoch); // a frame that was read

  struct Totals {
    uint32_t workers = 0; // that are there now, without the one here
    uint64_t jobsRemote = 0, jobsHere = 0, reissued = 0, duplicates = 0, bytesSent = 0,
             bytesReceived = 0;
    uint32_t threads = 0; // of all that are there
  };
  Totals totals() const;
  std::vector<RTworker>
  workers() const; // the one here first, then in the order in which they joined

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
