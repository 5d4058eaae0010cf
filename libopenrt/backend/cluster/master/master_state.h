// master_state.h: what the master knows of workers and frames. Only master.cpp and its parts
// include it.
#pragma once

#include <deque>
#include <exception>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "backend/cluster/master/master.h"
#include "backend/cluster/master/outbox.h"
#include "backend/cluster/master/scene_log.h"

namespace openrt::cluster {

inline constexpr WorkerId hereId = 0; // the worker in this process; others count from 1

// A worker, here or elsewhere.
struct Remote {
  Peer peer = 0;
  WorkerId id = hereId;
  std::string address, host;
  bool welcome = false; // has said what it is, and may work
  uint64_t session = 0;
  uint32_t threads = 0;
  uint32_t strikes = 0; // messages that were nonsense
  uint64_t logged = 0;  // lines that it has said
  Epoch sent = 0;       // it has the scene up to here, or will; 0: none
  Epoch furthest = 0;   // that it was sent
  Outbox outbox;
  std::map<Epoch, std::vector<OfferPtr>>
      offered;                   // arrays of scenes for which it has not said yet what it lacks
  std::map<Epoch, uint32_t> out; // jobs it has, by frame
  std::unordered_set<Lease> arriving; // of results that are being merged
  uint64_t bytesSent = 0, bytesReceived = 0, rays = 0;
  std::string name() const {
    return host.empty() ? address : address.empty() ? host : host + " (" + address + ")";
  }
};

struct FrameEntry {
  edit::FrameSettingsT settings;
  Master::FrameState state;
  std::string who;        // prepared it first
  std::set<WorkerId> all; // that have prepared it
  uint32_t arriving = 0;  // results that are being merged
  // All is merged, and everybody's share in it is known.
  bool complete() const { return state.work && arriving == 0 && state.work->over(); }
};

struct Arrival { // a job that was done, on its way into the picture
  WorkerId worker = hereId;
  Epoch epoch = 0;
  LeasedJob job;
  std::shared_ptr<FrameWork> work;
  edit::FrameSettingsT frame;
  message::Result message; // from elsewhere: packed
  JobResult result;
  std::string unreadable;     // why
  bool fits = true;           // its job
  std::exception_ptr failure; // what went wrong here
  bool first = false;         // nobody had done this job before
  void merge();               // [any]
};

struct Master::Impl {
  Impl(const MasterOptions& options, Send send, WorkerCore* here);

  // Workers (master_workers.cpp).
  void hello(Remote& remote, message::Hello&& hello, double now);
  void depart(Remote& remote, double now);
  void strike(Remote& remote, const std::string& what, double now);
  void refuse(Peer peer, const std::string& why, double now);
  void leaveWorkersOut(double now);
  void say(Remote& remote, message::Body&& body);
  void flush(Remote& remote);
  bool deliver(Remote& remote, Frames&& frames);
  void need(Remote& remote, const message::Need& need, double now);
  void joinHere(double now);
  RTworker describe(const Remote& remote, bool alive) const;
  Remote* remoteOf(WorkerId id);
  uint32_t alive() const { return uint32_t(peers.size()); }
  void log(int level, const std::string& text) const;
  void logOnce(int level, const std::string& text);

  // Frames (master_frames.cpp).
  void bring(WorkerId worker, Epoch epoch);
  void ready(WorkerId worker, const std::string& who, Epoch epoch, const FrameFacts& facts,
             uint32_t transport, const RTstats& stats, double now);
  bool agree(FrameEntry& entry, WorkerId worker, const std::string& who, const Prepared& prepared,
             double now);
  void result(Remote& remote, message::Result&& result, double now);
  void arrive(FrameEntry& entry, const std::shared_ptr<Arrival>& arrival, double now);
  void arrived(const Arrival& arrival, double now);
  void taken(Epoch epoch);
  void end(Epoch epoch);
  void fail(Epoch epoch, const std::string& why, bool missing);
  void settle();
  void handOut(double now);
  bool handSomeOut(double now);
  bool enough(double now);
  uint32_t able() const; // workers elsewhere that can make the oldest frame, as far as is known
  FrameEntry* unfinished(Epoch epoch);
  Epoch oldest() const; // unfinished; 0: none

  MasterOptions options;
  Send send;
  WorkerCore* core; // here; may be null
  Scheduler scheduler;
  SceneLog scenes;
  std::unordered_map<Peer, Remote> remotes;
  std::unordered_map<WorkerId, Peer> peers; // of those that are welcome
  Remote here;
  bool hereJoined = false;
  std::map<Epoch, FrameEntry> frames; // also finished ones that were not forgotten
  std::vector<RTworker> gone;         // workers that have left, the last few
  std::set<std::string> said;
  std::set<Peer> waiting; // whose outbox is not empty
  WorkerId nextWorker = 1;
  uint64_t nextSession;
  double busySeconds = 5e-3, busyJobs = 500,
         jobsSince = 0; // of this thread, of late; jobs since it was told
  uint64_t jobsHere = 0, jobsRemote = 0, goneSent = 0, goneReceived = 0;
  double firstCommit = std::numeric_limits<double>::infinity();
  double fewSince = std::numeric_limits<double>::infinity(); // fewer workers than required
  bool everJoined = false, saidAlone = false, reloaded = false;
  uint64_t largestResult =
      0; // bytes of a job's, of any frame so far: nothing small is unpacked to something huge
  std::string lastRefusal; // for who waits for workers in vain
};

} // namespace openrt::cluster
