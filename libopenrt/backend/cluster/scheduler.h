// scheduler.h: who does which job next. Pure decisions: no sockets, no threads, no clock; time is told in seconds of any steady
// clock. Workers come, work, are slow, are lost; frames begin one after the other and are finished in that order. One thread's.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backend/cluster/worker_core.h"
#include "render/frame_work.h"

namespace openrt::cluster {

using WorkerId = uint32_t;

enum class Split : uint8_t { automatic, tiles, samples, frames };

struct SchedulerOptions {
  Split split = Split::automatic;
  double patience = 2;     // a job that waits longer than so many times the median is handed out again
  uint32_t inFlight = 3;   // jobs for each thread of a worker: one is done, the others wait
  double shortest = 0.002; // seconds that a job should take at least, if there is a choice
  double longest = 0.25;   // and at most
};

struct Handout {
  WorkerId worker = 0;
  Epoch epoch = 0;
  LeasedJob job;
  bool again = false; // somebody else has it, too
};

struct WorkerTally {                                // of one worker, since it joined
  uint64_t jobs = 0, again = 0, late = 0, lost = 0; // done; done for others; done in vain; taken away from it
  double busy = 0;                                  // seconds of all its threads
  double latency = 0;                               // seconds from handing out to the result beyond the work, smoothed
  uint32_t out = 0;                                 // jobs it has now
};

class Scheduler {
 public:
  explicit Scheduler(const SchedulerOptions& options);
  ~Scheduler();

  void join(WorkerId worker, uint32_t threads, bool here, double now);  // here: in the master's process, no link between
  void leave(WorkerId worker, double now);                              // its jobs are free at once
  void frame(Epoch epoch, std::shared_ptr<FrameWork> work, double now); // frames in order of their epochs
  void end(Epoch epoch);                                                // finished or cancelled: its leases are forgotten
  // The worker has prepared this epoch's scene, and works on no earlier one from now on.
  void ready(WorkerId worker, Epoch epoch, double now);

  // What to hand out now; call until false. Oldest frame first; the next frame's jobs once no worker can be given more of the
  // oldest. A job that is late is handed out again, to a worker that has little to do, at most three times.
  bool next(double now, Handout& out);
  // A result. True: the lease is known, and its job has not been done before: give it to the frame's work. seconds: on one
  // thread.
  bool done(WorkerId worker, Epoch epoch, Lease lease, double seconds, double now);
  // The job of a lease; null: unknown, done or forgotten.
  const Job* find(WorkerId worker, Epoch epoch, Lease lease) const;
  // When next() may have something new although nothing has happened; infinite: never.
  double wake(double now) const;
  // How long a job takes at most before it is handed out again; infinite as long as nothing is known.
  double lateAfter(Epoch epoch) const;

  const WorkerTally& tally(WorkerId worker) const;
  uint64_t reissued() const, duplicates() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
