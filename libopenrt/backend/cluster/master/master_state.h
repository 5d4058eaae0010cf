// master_state.h: the master's state: workers and frames. Only the master*.cpp files include it.
// One thread, except IncomingResult::merge.
#pragma once

#include <deque>
#include <exception>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "backend/cluster/master/distribution.h"
#include "backend/cluster/master/master.h"
#include "backend/cluster/master/outbox.h"
#include "backend/cluster/master/scene_log.h"

namespace openrt::cluster {

inline constexpr WorkerId localId = 0; // the worker in this process; remote workers count from 1

// A worker, local or remote.
struct Remote {
  Peer peer = 0;
  WorkerId id = localId;
  std::string address, host;
  bool welcome = false; // Hello was accepted; it may work
  uint64_t session = 0;
  uint32_t strikes = 0; // invalid messages
  uint64_t logged = 0;  // log lines it has sent
  Epoch sent = 0;       // epoch of the scene it has or is being sent; 0: none
  Epoch furthest = 0;   // newest epoch it was ever sent
  Outbox outbox;
  // Arrays of scenes for which the worker has not said yet which ones it lacks.
  std::map<Epoch, std::vector<OfferPtr>> offered;
  std::map<Epoch, uint32_t> out;     // outstanding jobs by frame
  std::unordered_set<Lease> merging; // leases whose results are being merged
  // Holds what the master counts or is told of the worker. describe() adds the name and the numbers
  // of the scheduler.
  RTworker facts{};
  std::string name() const {
    return host.empty() ? address : address.empty() ? host : host + " (" + address + ")";
  }
};

struct FrameEntry {
  edit::FrameSettingsT settings;
  KeepSums kept;
  Master::FrameState state;
  std::string preparedBy;             // the worker that prepared it first
  std::set<WorkerId> preparedWorkers; // workers that have prepared it
  uint32_t merging = 0;               // results that are being merged
  // Returns true if all results are merged and the part of every worker is counted.
  bool complete() const { return state.work && merging == 0 && state.work->over(); }
};

struct IncomingResult { // a result on its way into the film
  WorkerId worker = localId;
  Epoch epoch = 0;
  LeasedJob job;
  std::shared_ptr<FrameWork> work;
  edit::FrameSettingsT frame;
  message::Result message; // packed, from a remote worker
  JobResult result;
  std::string unreadable;     // reason why unpacking failed
  bool fits = true;           // the result matches its job
  std::exception_ptr failure; // exception of merge()
  bool first = false;         // first result of this job
  void merge();               // [any] unpacks, decodes and merges the result
};

struct Master::Impl {
  Impl(const MasterOptions& options, Send send, WorkerCore* here);

  // Workers (master_workers.cpp).
  void hello(Remote& remote, message::Hello&& hello, double now);
  void depart(Remote& remote, double now);
  void strike(Remote& remote, const std::string& what, double now);
  void refuse(Peer peer, const std::string& why, double now);
  void refuseAllWorkers(double now);
  void queueMessage(Remote& remote, message::Body&& body);
  void flush(Remote& remote);
  bool deliver(Remote& remote, Frames&& frames);
  void need(Remote& remote, const message::Need& need, double now);
  void got(Remote& remote, const message::Got& got, double now);
  void sendArrays(double now);
  void sendArray(Remote& remote, const OfferPtr& offer, double now);
  void joinLocal(double now);
  RTworker describe(const Remote& remote, bool alive) const;
  Remote* remoteOf(WorkerId id);
  uint32_t alive() const { return uint32_t(peers.size()); }
  void log(int level, const std::string& text) const;
  void logOnce(int level, const std::string& text);

  // Frames (master_frames.cpp).
  void sendScene(WorkerId worker, Epoch epoch);
  void ready(WorkerId worker, const std::string& who, Epoch epoch, const FrameFacts& facts,
             uint32_t transport, const RTstats& stats, double now);
  bool agree(FrameEntry& entry, WorkerId worker, const std::string& who, const Prepared& prepared,
             double now);
  void result(Remote& remote, message::Result&& result, double now);
  void startMerge(FrameEntry& entry, const std::shared_ptr<IncomingResult>& incoming, double now);
  void finishMerge(const IncomingResult& incoming, double now);
  void endIfComplete(Epoch epoch);
  void end(Epoch epoch);
  void fail(Epoch epoch, const std::string& why, bool missing);
  void settle();
  void handOut(double now);
  bool handSomeOut(double now);
  bool hasEnoughWorkers(double now);
  // Returns how many remote workers can render the oldest frame, as far as is known.
  uint32_t able() const;
  FrameEntry* unfinished(Epoch epoch);
  Epoch oldest() const; // oldest unfinished epoch; 0: none

  MasterOptions options;
  Send send;
  WorkerCore* core; // the local worker; may be null
  Scheduler scheduler;
  SceneLog scenes;
  Distribution distribution;
  std::unordered_map<Peer, Remote> remotes;
  std::unordered_map<WorkerId, Peer> peers; // accepted workers
  Remote here;
  bool hereJoined = false;
  std::map<Epoch, FrameEntry> frames; // includes finished frames until forget()
  std::vector<RTworker> gone;         // the last workers that have left
  std::set<std::string> loggedTexts;
  std::set<Peer> waiting; // peers whose outbox is not empty
  WorkerId nextWorker = 1;
  uint64_t nextSession;
  // Smoothed busy seconds and jobs of this thread, and the jobs since the last busy().
  double busySeconds = 5e-3, busyJobs = 500, jobsSince = 0;
  uint64_t jobsHere = 0, jobsRemote = 0, goneSent = 0, goneReceived = 0;
  double firstCommit = std::numeric_limits<double>::infinity();
  // Since when there are fewer workers than required.
  double fewSince = std::numeric_limits<double>::infinity();
  bool everJoined = false, loggedAlone = false, reloaded = false;
  // Largest size in bytes of a job's result in any frame so far. It limits unpacking, so that no
  // small message becomes a huge one.
  uint64_t largestResult = 0;
  std::string lastRefusal; // reported when a user waits for workers in vain
};

} // namespace openrt::cluster
