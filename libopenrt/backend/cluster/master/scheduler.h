// scheduler.h: who does which job next, and which scene a worker prepares. Pure decisions: no
// sockets, no threads, no clock; time is told in seconds of any steady clock. Workers come, work,
// are slow, are lost; frames begin one after the other and are finished in that order. The same
// calls, the same answers. One thread's. What each call costs grows with the logarithm of the
// number of workers and jobs, so that 4,096 workers of 16 threads can be served.
//
// Of a job that comes back: find() it, decode what came, then done(); give it to the frame's work
// if that says so. What cannot be decoded has failed().
//
// How a frame is shared out (Split). tiles: a job has all samples of a tile. samples: a tile's
// samples are shared by all workers. frames: a frame is one worker's; others help once no frame is
// without a worker, and only if more is left than preparing the scene costs. automatic: tiles,
// whose samples are divided where a whole tile would take longer than a fair part of what is left;
// a frame goes to one worker if three frames or more are in flight, preparing costs P, the frame R
// seconds of one worker, and frames of their own come out of N workers faster by a tenth: (P + R) /
// min(N, frames in flight) < 0.9 (P + R / N).
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
  double patience = 2; // a job that waits longer than so many times what the median lets expect is
                       // handed out again
  uint32_t inFlight = 3; // jobs for each thread of a worker: one is done, the others wait; up to 4
                         // where the link is slow, fewer when little is left or jobs are long. Jobs
                         // shorter than `shortest` count together
  double shortest = 0.002; // seconds that a job should take at least, if there is a choice
  double longest = 0.25;   // and at most
  double soonest = 0.02;   // no job is late before
  uint32_t mostAgain = 3;  // a job is handed out again so often
  double stuck = 10; // seconds after which the worker here helps with the oldest frame, if it has
                     // not progressed
  uint32_t mostFailed = 3; // a worker gets nothing more after so many failed jobs
};

// What the scheduler asks of a frame's work.
class JobSource {
 public:
  virtual ~JobSource() = default;
  virtual FrameWork::Next next(Job& job, uint32_t largest) = 0;
  virtual void giveBack(const Job& job) = 0;
  virtual double undone() const = 0;  // pixels times samples that nobody has yet, about
  virtual uint32_t tiles() const = 0; // of the picture
  virtual uint32_t pixels(uint32_t tile) const = 0; // of a tile
  virtual void order(std::vector<uint32_t>) {}      // all tiles, in which they are to be given out
  virtual uint32_t upcoming() const {
    return ~0u;
  } // the tile that next() comes to; none such: it is open
};

struct Handout {
  WorkerId worker = 0;
  Epoch epoch = 0;
  LeasedJob job;
  bool again = false; // somebody else has it, too
};

struct WorkerTally { // of one worker, since it joined
  uint64_t jobs = 0, again = 0, late = 0,
           lost = 0;    // done; done for others; done in vain; taken away from it
  uint64_t failed = 0;  // jobs, and scenes it could not prepare
  bool blocked = false; // has failed too often: gets nothing more
  double busy = 0;      // seconds of all its threads
  double latency =
      0; // seconds of the link, there and back, smoothed: of jobs that found a free thread
  uint32_t out = 0; // jobs it has now
};

class Scheduler {
 public:
  explicit Scheduler(const SchedulerOptions& options);
  ~Scheduler();

  // here: in the master's process, no link between; it stays at the oldest unfinished frame, so
  // that whatever is lost can be done. reserve: only if nobody else can, or does.
  void join(WorkerId worker, uint32_t threads, bool here, double now, bool reserve = false);
  void leave(WorkerId worker, double now); // its jobs are free at once
  // A frame of this epoch is wanted; in order of their epochs. Its work is told by frame() once a
  // worker has prepared the scene.
  void announce(Epoch epoch, double now);
  void frame(Epoch epoch, std::shared_ptr<JobSource> work,
             double now); // announces it, if it was not
  inline void frame(Epoch epoch, std::shared_ptr<FrameWork> work, double now); // frame_source.h
  void changed(Epoch epoch); // its work may have new jobs, though nothing was told here: what was
                             // done() was taken later
  void end(Epoch epoch);     // finished or cancelled: its leases are forgotten

  // Which worker is to prepare which epoch's scene now; call until false. It gets no more jobs of
  // earlier epochs, and none of this one until it is ready(). Edits of epochs between go before.
  bool move(double now, WorkerId& worker, Epoch& epoch);
  // The worker has prepared this epoch's scene, and works on no earlier one from now on.
  void ready(WorkerId worker, Epoch epoch, double now);
  // It cannot make this epoch's frame: its jobs of it are free at once.
  void unable(WorkerId worker, Epoch epoch, double now);

  // What to hand out now; call until false. Oldest frame first; the next frame's jobs once no
  // worker can be given more of the oldest. A job that is late is handed out again, to a worker
  // with an idle thread, at most three times; then once more to the worker here, which no other
  // machine can hold up.
  bool next(double now, Handout& out);
  // A result. True: the lease is known, and its job has not been done before: give it to the
  // frame's work. seconds: on one thread.
  bool done(WorkerId worker, Epoch epoch, Lease lease, double seconds, double now);
  // What came for this lease is of no use: the job is free at once, and the worker gets nothing
  // more after three.
  void failed(WorkerId worker, Epoch epoch, Lease lease, double now);
  // The job of a lease; null: unknown, done or forgotten.
  const Job* find(WorkerId worker, Epoch epoch, Lease lease) const;
  // Workers that work on this epoch's frame, or can come to: 0 and nobody joins: it never ends.
  uint32_t able(Epoch epoch) const;
  // What handing a job out and taking its result costs whoever asks, in seconds: jobs are made so
  // long that there is time for all.
  void pace(double secondsOfJob);
  // When next() may have something new although nothing has happened; infinite: never.
  double wake(double now) const;
  bool usable(WorkerId worker, Epoch epoch) const; // neither blocked nor unable to make this frame
  double progressed(Epoch epoch) const; // when it was announced, first prepared, became the oldest
                                        // or got a result, last of these
  bool stuck(Epoch epoch) const; // it has not progressed for so long that the worker here helps
  // How long a usual job takes at most before it is handed out again; infinite as long as nothing
  // is known.
  double lateAfter(Epoch epoch) const;

  const WorkerTally& tally(WorkerId worker) const; // of one that has left: zeros
  uint64_t reissued() const, duplicates() const;
  Split split(Epoch epoch)
      const; // tiles, samples or frames: as it is shared out; automatic: tiles of divided samples

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster
