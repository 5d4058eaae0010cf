// scheduler_state.h: what the scheduler knows: workers, frames, the jobs that are out and who has
// them. Only its own files include this. One thread's, as Scheduler.
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
using Ranked = std::set<std::pair<double, WorkerId>>; // best first; equal ones by their number, so
                                                      // that all is repeatable

namespace scheduling { // not to be taken for the sessions of the same names

struct Worker {
  WorkerId id = 0;
  uint32_t threads = 1;
  bool here = false, reserve = false;
  Epoch epoch = 0; // whose scene it has or prepares
  bool ready = false, unable = false;
  uint32_t slips = 0; // jobs that were late of late: it gets less
  double asked = 0;   // when it was told to prepare
  double heard = 0;   // of it, with a result
  std::set<std::pair<Epoch, Lease>> leases;
  WorkerTally tally;
  double roomKey = never, idleKey = never; // where it stands in its group; never: it does not

  bool tied() const { return here || reserve; }
  bool usable() const { return !tally.blocked && !unable; }
  double hands() const { // threads, fewer of one that lets jobs wait
    return std::max(1u, threads >> std::min(slips, 31u));
  }
};

struct Flight { // a job that is out
  Job job;
  double units = 0;        // pixels times samples; paths
  double seconds = 0;      // it should take, by what its place cost before; 0: unknown
  double deadline = never; // late then, by what was known when it was last looked at
  double since = 0;        // handed out, last time
  double turns =
      1; // jobs one after the other until this one is done, with those that its worker had before
  double link = 0;    // of its last worker
  uint32_t again = 0; // times it was handed out again
  std::set<Lease> holders;
};

struct Held { // a lease
  WorkerId worker = 0;
  uint64_t flight = 0; // 0: its job is done, by somebody else
  double since = 0;
  bool again = false, direct = false; // a copy; it found a free thread
};

struct Frame {
  Epoch epoch = 0;
  Split split = Split::tiles; // tiles: by cost if that is what was asked for
  bool wholeTiles = false, spread = false;
  std::shared_ptr<JobSource> work; // null: nobody has prepared it yet
  bool maybe = false;              // there may be something to hand out
  uint32_t tilePixels = 1;
  double perPixel = 1;    // samples, about
  double lastUnits = 0;   // of the job that was handed out last
  double lastSeconds = 0; // it should take; 0: unknown
  double aheadUnits = 0,
         aheadSeconds = 0; // of what nobody has yet, by what places cost before; 0: unknown
  JobCosts costs, light;
  std::vector<float>
      places; // by tile: seconds of a pixel's sample, here or in the frame before; 0: unknown
  std::map<uint64_t, Flight> flights;
  std::unordered_map<Lease, Held> leases;
  std::set<std::pair<double, uint64_t>>
      deadlines; // of flights that may be handed out again, to anybody
  std::set<std::pair<double, uint64_t>>
      spent; // of those that were so often enough: only the worker here takes them
  double progressed =
      0;               // when it was announced, was first prepared, became the oldest, got a result
  bool rescue = false; // something is late, and nobody at it is idle
  bool stuck = false;  // it has not progressed for too long: the worker here helps
  uint32_t rekeyAt = 1; // jobs done with which all deadlines are found anew

  double place(uint32_t tile) const { return tile < places.size() ? double(places[tile]) : 0; }
  // Seconds of one thread for what nobody has yet, about.
  double left() const {
    return work->undone() *
           (aheadUnits >= 1 && aheadSeconds > 0 ? aheadSeconds / aheadUnits : costs.mean());
  }
  bool exhausted() const {
    return work && work->undone() < 0.5;
  } // nobody is to do more of it, as yet
  // When the first job that is out is late; never: none can be.
  double firstLate() const {
    return std::min(deadlines.empty() ? never : deadlines.begin()->first,
                    spent.empty() ? never : spent.begin()->first);
  }
  JobCosts& costsOf(const Job& job) { return job.kind == Job::Kind::light ? light : costs; }
};

struct Group { // workers that have an epoch's scene, or prepare it
  std::set<WorkerId> members;
  std::set<WorkerId> movable; // ready ones but those here and in reserve
  std::set<WorkerId> able;    // these, without those that cannot make this frame
  std::set<WorkerId> tied;    // those here and in reserve
  uint32_t threads = 0;       // of members that are no reserve and not blocked
  uint32_t usable = 0;        // these members
  Ranked room;                // by jobs for each thread: those that may be given more
  Ranked idle;                // with an idle thread
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
  uint64_t lastFlight = 0, reissued = 0, duplicates = 0;
  JobCosts costs, light;     // of the frame that ended last
  std::vector<float> places; // of the frame that ended last
  double frameSeconds = 0;   // it took on one thread
  double pace = 1e-5;        // seconds that whoever asks takes for a job
  double prepare = 0;        // seconds that preparing a scene takes, smoothed; 0: unknown
  uint32_t usable = 0, threads = 0,
           rescuers = 0; // workers that are no reserve, and their threads; those here and in
                         // reserve; none that are blocked
  uint32_t reserves = 0;
  bool moves = false;    // there may be something to move
  Epoch watched = 0;     // the oldest frame, when it was looked at last
  bool helpless = false; // a frame was stuck, and no result has come from elsewhere since

  Frame* frame(Epoch epoch);
  Worker* worker(WorkerId id);

  // scheduler.cpp
  void leave(Worker& w);
  void end(Frame& f);
  void unschedule(Frame& f, uint64_t id, const Flight& flight); // it is not late any more
  void forget(Frame& f, Lease lease, bool lost);                // takes a lease away
  void forgetAll(Worker& w, Epoch until);                       // of epochs before `until`
  void strike(Worker& w);                                       // it has failed
  bool done(Frame& f, Lease lease, double seconds, double now);

  // scheduler_moves.cpp
  void weigh(const Worker& w, int sign);
  void enter(Worker& w, Epoch epoch, bool ready);
  void depart(Worker& w);
  void sort(Worker& w); // into its group's sets
  Split splitOf() const;
  bool worthHelping(const Frame& f) const;
  Epoch target(Epoch epoch);
  Epoch targetOfTied(const Worker& w);
  void sortTied(Epoch epoch);
  bool waits(const Frame& f, const Group& g,
             const Worker& w) const; // a reserve, as long as others get on
  double stuckAt() const; // when the worker here is to help with the oldest frame; never: it does,
                          // or there is none
  void watch(double now); // whether the oldest frame progresses
  bool move(double now, WorkerId& worker, Epoch& epoch);

  // scheduler_handout.cpp
  void plan(Frame& f);                    // what costs most first: what is left then fills the gaps
  double secondsOf(const Frame& f) const; // that a usual job takes; 0: unknown
  double bundle(const Frame& f) const;    // jobs that count together
  double threadsFor(Epoch epoch) const;
  double level(const Frame& f) const; // jobs that a thread may have
  uint32_t largest(const Frame& f, const Worker& w) const;
  Worker* roomiest(const Frame& f, Group& g);
  void hand(Frame& f, Worker& w, uint64_t id, bool again, double now, Handout& out);
  double span(Frame& f, const Flight& flight);
  void rekey(Frame& f, uint64_t id, Flight& flight);
  bool reissue(Frame& f, Group& g, double now, Handout& out);
  bool reissueHere(Frame& f, Group& g, double now, Handout& out);
  bool next(double now, Handout& out);
};

} // namespace openrt::cluster
