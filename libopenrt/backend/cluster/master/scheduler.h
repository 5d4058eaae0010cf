// scheduler.h: decides which worker does which job next and which scene a worker prepares. It has
// no sockets, threads or clock; callers pass the time in seconds of any steady clock. The same
// calls give the same answers. Frames begin one after the other and are finished in that order;
// workers may join, be slow and be lost. One thread. The cost of a call grows with the logarithm of
// the number of workers and jobs, so that 4,096 workers of 16 threads can be served.
//
// To take a result: find() the job, decode the result, call done(), and add the result to the
// frame's work if done() returns true. Call failed() if the result cannot be decoded.
//
// Split says how a frame is divided:
// * tiles: a job has all samples of a tile.
// * samples: the samples of each tile are divided among all workers.
// * frames: each frame goes to one worker. Others help once every frame has a worker, and only if
//   more work is left than preparing the scene costs.
// * automatic: tiles, and the samples of a tile are divided where a whole tile would take longer
//   than a fair part of what is left. A frame goes to one worker if at least three frames are in
//   flight, preparing costs P, the frame takes R seconds of one worker, and N workers finish frames
//   faster by a tenth that way: (P + R) / min(N, frames in flight) < 0.9 (P + R / N).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backend/cluster/worker/worker_core.h"
#include "render/frame/frame_work.h"

namespace openrt::cluster {

using WorkerId = uint32_t;

enum class Split : uint8_t { automatic, tiles, samples, frames };

struct SchedulerOptions {
  Split split = Split::automatic;
  // A job is copied to another worker once it takes this many times what the median cost predicts.
  double patience = 2;
  // Jobs per thread of a worker: one runs, the others wait. Up to 4 over a slow link, fewer when
  // little work is left or jobs are long. Jobs shorter than `shortest` are counted in bundles.
  uint32_t inFlight = 3;
  double shortest = 0.002; // seconds a job should take at least, if there is a choice
  double longest = 0.25;   // seconds a job should take at most
  double soonest = 0.02;   // seconds before which no job counts as late
  uint32_t maxCopies = 3;  // limit on the copies of a job
  // Seconds without progress after which the local worker helps with the oldest frame.
  double stuck = 10;
  uint32_t maxFailed = 3; // failed jobs after which a worker gets no more jobs
};

// The scheduler's view of a frame's work (implemented by FrameSource).
class JobSource {
 public:
  virtual ~JobSource() = default;
  virtual FrameWork::Next next(Job& job, uint32_t largest) = 0;
  virtual void giveBack(const Job& job) = 0;
  // Returns the approximate work, pixels times samples, that has not been handed out.
  virtual double undone() const = 0;
  virtual uint32_t tiles() const = 0;               // number of tiles in the picture
  virtual uint32_t pixels(uint32_t tile) const = 0; // pixels of a tile
  // Sets the order in which all tiles are handed out.
  virtual void order(std::vector<uint32_t>) {}
  // Returns the tile that next() takes next, or a value beyond all tiles if that is open.
  virtual uint32_t upcoming() const { return ~0u; }
};

struct Handout {
  WorkerId worker = 0;
  Epoch epoch = 0;
  LeasedJob job;
  bool again = false; // speculative copy: another worker has the job, too
};

struct WorkerTally { // counters of one worker since it joined
  // Finished jobs, speculative copies among them, duplicate results, jobs taken away from it.
  uint64_t jobs = 0, again = 0, late = 0, lost = 0;
  uint64_t failed = 0;  // failed jobs and scenes it could not prepare
  bool blocked = false; // failed too often: gets no more jobs
  double busy = 0;      // busy seconds, summed over its threads
  // Smoothed round-trip seconds of the link, from jobs that found a free thread.
  double latency = 0;
  uint32_t out = 0; // outstanding jobs
};

class Scheduler {
 public:
  explicit Scheduler(const SchedulerOptions& options);
  ~Scheduler();

  // Adds a worker. here: it is in the master's process, without a link, and stays at the oldest
  // unfinished frame so that every lost job can be done. reserve: it works only if no other worker
  // can or does.
  void join(WorkerId worker, uint32_t threads, bool here, double now, bool reserve = false);
  void leave(WorkerId worker, double now); // its jobs can be handed out at once
  // Announces the frame of an epoch; epochs ascend. frame() passes the frame's work once a worker
  // has prepared the scene.
  void announce(Epoch epoch, double now);
  // Passes the work of a frame; announces the frame if necessary.
  void frame(Epoch epoch, std::shared_ptr<JobSource> work, double now);
  // Defined in frame_source.h.
  inline void frame(Epoch epoch, std::shared_ptr<FrameWork> work, double now);
  // Tells that the work may have new jobs without a call here: a result that was done() was merged
  // later.
  void changed(Epoch epoch);
  void end(Epoch epoch); // the frame is finished or cancelled; drops its leases

  // Returns which worker is to prepare which epoch's scene now; call it until it returns false. The
  // worker gets no more jobs of earlier epochs, and none of this epoch until ready(). The edits of
  // the epochs between must be sent first.
  bool move(double now, WorkerId& worker, Epoch& epoch);
  // Tells that the worker has prepared this epoch's scene. It works on no earlier epoch from now
  // on.
  void ready(WorkerId worker, Epoch epoch, double now);
  // Tells that the worker cannot render this epoch's frame; its jobs of that frame can be handed
  // out at once.
  void unable(WorkerId worker, Epoch epoch, double now);

  // Returns the next job to hand out; call it until it returns false. The oldest frame comes first;
  // the next frame's jobs follow once no worker can get more of the oldest. A late job is copied to
  // a worker with an idle thread, at most three times, and then once more to the local worker,
  // which no other machine can hold up.
  bool next(double now, Handout& out);
  // Takes a result; seconds: of one thread. Returns true if the lease is known and the job was not
  // done before: the caller then adds the result to the frame's work.
  bool done(WorkerId worker, Epoch epoch, Lease lease, double seconds, double now);
  // Tells that the result of this lease is useless. The job can be handed out at once; a worker
  // gets no more jobs after three failures.
  void failed(WorkerId worker, Epoch epoch, Lease lease, double now);
  // Returns the job of a lease, or null if the lease is unknown, done or dropped.
  const Job* find(WorkerId worker, Epoch epoch, Lease lease) const;
  // Returns the number of workers that work on this epoch's frame or can still reach it. At 0 the
  // frame only ends if another worker joins.
  uint32_t able(Epoch epoch) const;
  // Sets the seconds the master spends to hand out a job and take its result. Jobs are made long
  // enough that it has time for all of them.
  void pace(double secondsOfJob);
  // Returns when next() may have a job although nothing has happened; infinite if never.
  double wake(double now) const;
  // Returns true if the worker is neither blocked nor unable to render this frame.
  bool usable(WorkerId worker, Epoch epoch) const;
  // Returns when the frame was announced, first prepared, became the oldest or got a result,
  // whichever was last.
  double lastProgressAt(Epoch epoch) const;
  // Returns true if the frame made no progress for so long that the local worker helps.
  bool stuck(Epoch epoch) const;
  // Returns the longest time a usual job takes before it is copied; infinite as long as nothing is
  // known.
  double lateAfter(Epoch epoch) const;

  // Returns the counters of a worker; zeros if it has left.
  const WorkerTally& tally(WorkerId worker) const;
  uint64_t reissued() const, duplicates() const;
  // Returns how the frame is divided: tiles, samples or frames; automatic means tiles whose samples
  // may be divided.
  Split split(Epoch epoch) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
