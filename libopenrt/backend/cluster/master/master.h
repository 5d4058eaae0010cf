// master.h: the master's side of the protocol (docs/protocol.md): handles the messages of workers
// and decides what to send to each. It has no sockets, threads or clock, so that a simulator can
// drive it as the backend does. One thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backend/cluster/master/scheduler.h"
#include "backend/cluster/messages/messages.h"
#include "backend/cluster/net/wire.h"
#include "scene/commit.h"

namespace openrt::cluster {

struct MasterOptions {
  SchedulerOptions schedule;
  bool tolerant = false;     // accepts workers that lack the instruction set
  BackendOptions local;      // log, and shaders to name and hash what a scene needs
  uint32_t localThreads = 0; // threads of the local worker; 0: none while other workers live
  uint32_t require = 0;      // number of workers without which no job is handed out
  double patience = 10;      // seconds with fewer workers before frames fail
  // Seconds for which a local worker without threads of its own waits for the first remote worker.
  double grace = 1;
  // First session number. A random value keeps the sessions of two masters apart.
  uint64_t session = 1;
  message::Hello self; // workers are compared with it (greeting.h)
  std::function<void(Peer, const std::string& why)> close; // refuses a worker
  // Executors: they run `heavy` on any thread and `then`, later, on the master's thread. If empty,
  // both run at once. background: long tasks, one after the other. results: unpacking and merging
  // of results, as many at once as there are threads for it.
  using Then = std::function<void(double now)>;
  using Executor = std::function<void(std::function<void()> heavy, Then then)>;
  Executor background, results;
};

class Master {
 public:
  // Returns false if the peer's queue is full (the frames are then unchanged) or the peer has left.
  using Send = std::function<bool(Peer, Frames&&)>;
  Master(const MasterOptions& options, Send send, WorkerCore* here);
  ~Master();

  // Events of the wire.
  void joined(Peer peer, const std::string& address, double now);
  void left(Peer peer, const std::string& why, double now);
  void message(Peer peer, Frames&& frames, double now);
  // Events of the local worker (WorkerSink), forwarded to this thread.
  void localReady(Epoch epoch, const Prepared& prepared, double now);
  void localFailed(Epoch epoch, const std::string& why, double now);
  void localDone(Epoch epoch, const LeasedJob& job, JobResult&& result, double now);

  // Calls of the application. Commits come in order with ascending epochs. The frame of a commit
  // starts once a worker has prepared it.
  // kept: whether the sums of the frame are kept, and with what it begins.
  void commit(Epoch epoch, std::shared_ptr<const Commit> commit, bool frame, double now,
              const KeepSums& kept = {});
  void cancel(Epoch epoch, double now); // cancels this frame and all before
  // Hands out jobs and sends messages. Returns the latest time for the next call.
  double advance(double now);
  // Tells how many seconds this thread was busy since the last call. The cost of a job decides how
  // large jobs are.
  void busy(double seconds);
  // Gives the local worker the scene of the last commit, to answer queries. Returns false if
  // earlier frames are not finished or there is no local worker.
  bool sendSceneToLocal();

  struct FrameState {
    std::shared_ptr<FrameWork> work; // null until a worker has prepared it
    Prepared prepared;
    std::string failure;    // reason why the frame cannot be rendered; empty if it can
    bool missing = false;   // the reason is missing workers
    bool sumsWrong = false; // the reason is that it cannot continue from its sums
    bool over = false;      // finished, failed or cancelled
  };
  FrameState frame(Epoch epoch) const;
  void forget(Epoch epoch); // drops a frame that was read

  struct Totals {
    RTclusterStats cluster{};
    uint32_t threads = 0; // threads of all connected workers
  };
  Totals totals() const;
  // Returns the local worker first, then the remote ones in the order in which they joined.
  std::vector<RTworker> workers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
