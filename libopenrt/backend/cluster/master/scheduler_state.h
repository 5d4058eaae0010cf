// scheduler_state.h: the scheduler's state: workers, frames, outstanding jobs and their leases.
// Only the scheduler*.cpp files include it. One thread, like Scheduler.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "backend/cluster/master/job_costs.h"
#include "backend/cluster/master/scheduler.h"

namespace openrt::cluster {

inline constexpr double never = std::numeric_limits<double>::infinity();
// Best first. Ties are broken by the worker number, so that schedules are repeatable.
using Ranked = std::set<std::pair<double, WorkerId>>;

namespace scheduling { // keeps Worker and Frame apart from classes of the same name

struct Worker {
  WorkerId id = 0;
  uint32_t threads = 1;
  bool here = false, reserve = false;
  Epoch epoch = 0; // epoch whose scene the worker has or prepares
  bool ready = false, unable = false;
  uint32_t recentLate = 0;  // recent late jobs; each one halves the worker's share
  double prepareSentAt = 0; // when the worker was told to prepare
  double lastResultAt = 0;  // when the last result arrived from this worker
  std::set<std::pair<Epoch, Lease>> leases;
  WorkerTally tally;
  // Sort keys of this worker in its group's sets; `never` if it is in none.
  double loadKey = never, idleKey = never;

  bool pinned() const { return here || reserve; }
  bool usable() const { return !tally.blocked && !unable; }
  double effectiveThreads() const { // number of threads, reduced by recent late jobs
    return std::max(1u, threads >> std::min(recentLate, 31u));
  }
};

struct OutstandingJob { // a job that one or more workers hold
  Job job;
  double units = 0;        // pixels times samples; paths for light jobs
  double seconds = 0;      // expected duration, from the earlier cost of its tile; 0 if unknown
  double deadline = never; // when it becomes late, as of the last update
  double since = 0;        // when it was last handed out
  // Jobs that run one after the other until this one is done, including those its worker already
  // had.
  double queuePosition = 1;
  double linkLatency = 0; // latency of the worker that got it last
  uint32_t copies = 0;    // number of speculative copies handed out
  std::set<Lease> holders;
};

struct LeaseRecord { // an entry of the lease table
  WorkerId worker = 0;
  uint64_t outstanding = 0; // number of the outstanding job; 0 if another worker has finished it
  double since = 0;
  // speculative: the lease is for a copy. onFreeThread: a thread was free when it was handed out.
  bool speculative = false, onFreeThread = false;
};

struct Frame {
  Epoch epoch = 0;
  Split split = Split::tiles; // tiles or frames; with tiles, wholeTiles and spread tell the rest
  bool wholeTiles = false, spread = false;
  std::shared_ptr<JobSource> work; // null until a worker has prepared the scene
  bool mayHaveJobs = false;        // there may be a job to hand out
  uint32_t tilePixels = 1;
  double samplesPerPixel = 1; // approximate samples per pixel
  double lastUnits = 0;       // size of the job handed out last
  double lastSeconds = 0;     // expected duration of that job; 0 if unknown
  // Work that has not been handed out yet, in tiles of known cost; 0 if unknown.
  double unassignedUnits = 0, unassignedSeconds = 0;
  JobCosts costs, light;
  // Seconds per pixel sample by tile, measured in this frame or the one before; 0 if unknown.
  std::vector<float> tileCosts;
  std::map<uint64_t, OutstandingJob> outstandingJobs;
  std::unordered_map<Lease, LeaseRecord> leases;
  // Outstanding jobs that may be copied to any worker, by deadline.
  std::set<std::pair<double, uint64_t>> deadlines;
  // Outstanding jobs that have used up their copies, by deadline. Only the local worker takes them.
  std::set<std::pair<double, uint64_t>> noMoreCopies;
  // When the frame was announced, was first prepared, became the oldest or got a result, whichever
  // was last.
  double lastProgressAt = 0;
  bool needsPinned = false;       // a job is late and no worker of the frame is idle
  bool stuck = false;             // no progress for too long: the local worker helps
  uint32_t updateDeadlinesAt = 1; // number of finished jobs at which all deadlines are updated

  double tileCost(uint32_t tile) const {
    return tile < tileCosts.size() ? double(tileCosts[tile]) : 0;
  }
  // Returns the approximate seconds of one thread for the work not handed out yet.
  double remainingSeconds() const {
    return work->undone() * (unassignedUnits >= 1 && unassignedSeconds > 0
                                 ? unassignedSeconds / unassignedUnits
                                 : costs.mean());
  }
  // Returns true if no job is left to hand out at present.
  bool exhausted() const { return work && work->undone() < 0.5; }
  // Returns when the first outstanding job becomes late, or `never` if none can.
  double firstLate() const {
    return std::min(deadlines.empty() ? never : deadlines.begin()->first,
                    noMoreCopies.empty() ? never : noMoreCopies.begin()->first);
  }
  JobCosts& costsOf(const Job& job) { return job.kind == Job::Kind::light ? light : costs; }
};

struct Group { // workers that have or prepare the scene of one epoch
  std::set<WorkerId> members;
  std::set<WorkerId> movable; // ready members, except pinned ones
  std::set<WorkerId> able;    // movable members that can render this frame
  std::set<WorkerId> pinned;  // local and reserve workers
  uint32_t threads = 0;       // threads of members that are neither reserve nor blocked
  Ranked byLoad;              // members that may get more jobs, by jobs per thread
  Ranked idle;                // members with an idle thread
};

} // namespace scheduling
using namespace scheduling;

struct Scheduler::Impl {
  explicit Impl(const SchedulerOptions& o) : options(o) {}
  SchedulerOptions options;
  std::map<WorkerId, Worker> workers;
  std::map<Epoch, Frame> frames;
  std::map<Epoch, Group> groups;
  Lease lastLease = 0;
  uint64_t lastOutstanding = 0, reissued = 0, duplicates = 0;
  JobCosts costs, light;        // costs of the frame that ended last
  std::vector<float> tileCosts; // tile costs of the frame that ended last
  double frameSeconds = 0;      // seconds of one thread that this frame took
  double pace = 1e-5;           // seconds that the master spends on one job
  double prepare = 0;           // smoothed seconds to prepare a scene; 0 if unknown
  // None of these count blocked workers. usable and threads: workers that are no reserve, and their
  // threads. pinnedWorkers: local and reserve workers.
  uint32_t usable = 0, threads = 0, pinnedWorkers = 0;
  uint32_t reserves = 0;
  bool mayMove = false;         // a worker may have to move to another epoch
  Epoch checkedEpoch = 0;       // the oldest frame at the last check
  bool noRemoteResults = false; // a frame was stuck, and no remote result has come since

  Frame* frame(Epoch epoch);
  Worker* worker(WorkerId id);

  // scheduler.cpp
  void leave(Worker& w);
  void end(Frame& f);
  void eraseDeadline(Frame& f, uint64_t id,
                     const OutstandingJob& outstanding); // removes its deadline
  void forget(Frame& f, Lease lease, bool lost);         // removes a lease
  void forgetAll(Worker& w, Epoch until);                // removes leases of epochs before `until`
  void recordFailure(Worker& w);                         // counts a failure
  bool done(Frame& f, Lease lease, double seconds, double now);

  // scheduler_moves.cpp
  void updateTotals(const Worker& w, int sign);
  void joinGroup(Worker& w, Epoch epoch, bool ready);
  void leaveGroup(Worker& w);
  void rank(Worker& w); // ranks the worker in its group's sets
  Split splitOf() const;
  bool worthHelping(const Frame& f) const;
  Epoch nextEpoch(Epoch epoch);
  Epoch nextEpochOfPinned(const Worker& w);
  void rankPinned(Epoch epoch);
  // Returns true for a reserve worker as long as others make progress.
  bool mustWait(const Frame& f, const Group& g, const Worker& w) const;
  // Returns when the local worker starts to help with the oldest frame; `never` if it helps already
  // or there is no such frame.
  double stuckAt() const;
  void checkProgress(double now); // checks whether the oldest frame makes progress
  bool move(double now, WorkerId& worker, Epoch& epoch);

  // scheduler_handout.cpp

  // Orders the tiles by cost, most expensive first: cheap ones fill the gaps at the end.
  void orderTiles(Frame& f);
  // Returns the usual duration of a job; 0 if unknown.
  double usualJobSeconds(const Frame& f) const;
  // Returns the number of short jobs that count as one.
  double jobsPerBundle(const Frame& f) const;
  double threadsFor(Epoch epoch) const;
  // Returns how many jobs a thread may have.
  double queueDepth(const Frame& f) const;
  uint32_t maxSamplesOf(const Frame& f, const Worker& w) const;
  Worker* leastLoaded(const Frame& f, Group& g);
  void issue(Frame& f, Worker& w, uint64_t id, bool speculative, double now, Handout& out);
  double lateLimit(Frame& f, const OutstandingJob& outstanding);
  void updateDeadline(Frame& f, uint64_t id, OutstandingJob& outstanding);
  bool reissue(Frame& f, Group& g, double now, Handout& out);
  bool reissueLocally(Frame& f, Group& g, double now, Handout& out);
  bool next(double now, Handout& out);
};

} // namespace openrt::cluster
