// worker.h: the worker's side of the protocol (docs/protocol.md): handles the master's messages and
// sends answers. It serves one master at a time. When the master is lost, the arrays are kept for
// the next one. It has no sockets, threads or clock. One thread.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/net/libraries.h"
#include "backend/cluster/worker/array_cache.h"
#include "backend/cluster/worker/counts.h"

namespace openrt {
class CommitValidator;
}

namespace openrt::cluster {

// Executes jobs: a WorkerCore, or a substitute in tests. See WorkerCore for the functions.
class JobExecutor {
 public:
  virtual ~JobExecutor() = default;
  virtual void useInstructionSet(const std::string& isa) = 0;
  virtual void scene(Epoch epoch, std::shared_ptr<const Commit> commit, bool whole,
                     bool prepare) = 0;
  virtual void prepare(Epoch epoch) = 0;
  virtual void work(Epoch epoch, std::span<const LeasedJob> jobs) = 0;
  virtual void drop(Epoch epoch) = 0;
};

struct WorkerOptions {
  message::Hello self; // Hello of this process (greeting.h)
  const ShaderRegistry* shaders = nullptr;
  size_t cacheBytes = size_t(1) << 30;
  ArrayFolder* folder = nullptr; // keeps arrays on a disk, too; may be null
  // Receives messages for the user; may be empty.
  std::function<void(int level, const std::string& text)> log;
};

// Lets a Worker send, close connections, report bad messages and set the heartbeat.
struct WorkerLink {
  std::function<void(Peer, Frames&&)> send;
  std::function<void(Peer, const std::string& why)> close;
  std::function<void(Peer, const std::string& why)> bad;      // reports an invalid message
  std::function<void(double heartbeat, double silence)> pace; // 0 restores the value before Welcome
  // Asks the worker at this address for arrays; fetched() follows for each. May be empty.
  std::function<void(const std::string& address, std::vector<message::ArrayName>)> fetch{};
};

class Worker {
 public:
  // counts: what it does is counted there.
  Worker(const WorkerOptions& options, WorkerLink link, JobExecutor& executor,
         WorkerCounts& counts);
  ~Worker();

  // Events of the wire.
  void joined(Peer peer, const std::string& address, double now);
  void left(Peer peer, const std::string& why, double now);
  void message(Peer peer, Frames&& frames, double now);
  void advance(double now); // call about once a second
  // Events of the executor, with its epochs.
  void ready(Epoch epoch, const Prepared& prepared);
  void failed(Epoch epoch, const std::string& why);
  void done(Epoch epoch, const LeasedJob& job, JobResult&& result);
  void log(int level, const std::string& text); // sends a log line to the master
  // An array from another worker; null if it could not be had.
  void fetched(const Hash& hash, ArrayPtr array);

  bool serving() const { return session_ != 0; }
  uint64_t masters() const { return counts_.masters; } // number of masters served so far
  const ArrayCache& cache() const { return cache_; }

 private:
  struct PendingScene { // a scene, or an order to prepare, that waits for arrays
    message::Scene scene;
    std::map<Hash, ArrayPtr> arrays; // arrays that have arrived
    std::set<Hash> missing;
    bool prepareOnly = false;
  };
  void sendMessage(message::Body&& body);
  // Session: number in the message's header.
  void welcome(const message::Welcome& m, uint64_t session);
  void scene(message::Scene&& m);
  void piece(const message::Piece& m);
  void source(const message::Source& m);
  ArrayPtr cached(const message::ArrayName& name);
  ArrayPtr fromFolder(const message::ArrayName& name);
  void arrived(const Hash& hash, const ArrayPtr& array);
  void sayGot(std::vector<Hash> arrays, bool failed, bool kept);
  bool isKept(const Hash& hash, const Array& array) const;
  void prepare(const message::Prepare& m);
  void jobs(const message::Jobs& m);
  void drop(const message::Drop& m);
  void bad(const std::string& why);
  void applyPendingScenes();
  void apply(PendingScene& pending);
  void refuse(Epoch epoch, const std::string& why);
  void endSession();
  void giveUp(const std::string& why); // ends the session with this master
  void answered(Epoch epoch);          // the executor has reported on this epoch
  void report(int level, const std::string& text) const;

  WorkerOptions options_;
  WorkerLink link_;
  JobExecutor& executor_;
  ArrayCache cache_;
  LibraryCheck libraries_;
  std::unique_ptr<CommitValidator> validator_;
  Peer peer_ = 0;
  std::string address_, lastReport_;
  double helloSentAt_ = 0; // when Hello was sent
  uint64_t session_ = 0;
  // The executor's epochs continue after those of the former master, so that late results of the
  // former session can be recognised.
  Epoch base_ = 0, newest_ = 0;
  // Reason why no scene can be made until a whole scene arrives.
  std::string broken_;
  std::deque<PendingScene> pendingScenes_;
  std::map<Hash, ArrayStream> streams_; // arrays that are needed
  size_t begun_ = 0;                    // streams that have begun
  // Arrays that came otherwise than from the master, which may be sending them nevertheless.
  std::set<Hash> fetched_;
  // Scenes on which the executor has not reported, with the bytes of their edits.
  std::deque<std::pair<Epoch, size_t>> unanswered_;
  size_t unansweredBytes_ = 0;
  // Settings of prepared frames, by the executor's epoch.
  std::map<Epoch, edit::FrameSettingsT> frames_;
  std::map<Epoch, std::set<Lease>> leases_; // leases of outstanding jobs
  uint64_t logged_ = 0;
  WorkerCounts& counts_;
};

} // namespace openrt::cluster
