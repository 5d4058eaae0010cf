// worker.h: the worker's side of the protocol (docs/protocol.md): what the master's messages mean,
// and what to say. One master at a time; when it is lost the arrays are kept for the next one. Pure
// events: no sockets, no threads, no clock. One thread's.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "backend/cluster/net/libraries.h"
#include "backend/cluster/net/messages.h"
#include "backend/cluster/worker/array_cache.h"

namespace openrt {
class CommitValidator;
}

namespace openrt::cluster {

// What does the jobs: a WorkerCore, or what a test puts in its place. As there.
class Machine {
 public:
  virtual ~Machine() = default;
  virtual void scene(Epoch epoch, std::shared_ptr<const Commit> commit, bool whole,
                     bool prepare) = 0;
  virtual void prepare(Epoch epoch) = 0;
  virtual void work(Epoch epoch, std::span<const LeasedJob> jobs) = 0;
  virtual void drop(Epoch epoch) = 0;
};

struct WorkerOptions {
  message::Hello self; // who we are (greeting.h)
  const ShaderRegistry* shaders = nullptr;
  size_t cacheBytes = size_t(1) << 30;
  std::function<void(int level, const std::string& text)> log; // may be empty
};

// What the Wire does for it.
struct WorkerLink {
  std::function<void(Peer, Frames&&)> send;
  std::function<void(Peer, const std::string& why)> close;
  std::function<void(Peer, const std::string& why)> bad;      // a message that is none
  std::function<void(double heartbeat, double silence)> pace; // 0: as before any Welcome
};

class Worker {
 public:
  Worker(const WorkerOptions& options, WorkerLink link, Machine& machine);
  ~Worker();

  // What the wire tells.
  void joined(Peer peer, const std::string& address, double now);
  void left(Peer peer, const std::string& why, double now);
  void message(Peer peer, Frames&& frames, double now);
  void advance(double now); // every second or so
  // What the machine tells; its epochs.
  void ready(Epoch epoch, const Prepared& prepared);
  void failed(Epoch epoch, const std::string& why);
  void done(Epoch epoch, const LeasedJob& job, JobResult&& result);
  void log(int level, const std::string& text); // to the master

  bool serving() const { return session_ != 0; }
  uint64_t masters() const { return masters_; } // that have come so far
  const ArrayCache& cache() const { return cache_; }

 private:
  struct Coming { // scenes and what depends on them, in their order
    message::Scene scene;
    std::map<Hash, ArrayPtr> arrays; // those that are here
    std::set<Hash> missing;
    bool prepareOnly = false;
  };
  void say(message::Body&& body);
  void welcome(const message::Welcome& m);
  void scene(message::Scene&& m);
  void piece(const message::Piece& m);
  void prepare(const message::Prepare& m);
  void jobs(const message::Jobs& m);
  void drop(const message::Drop& m);
  void bad(const std::string& why);
  void applyComing();
  void apply(Coming& coming);
  void refuse(Epoch epoch, const std::string& why);
  void endSession();
  void giveUp(const std::string& why); // this master
  void answered(Epoch epoch);          // by the machine
  void tell(int level, const std::string& text) const;

  WorkerOptions options_;
  WorkerLink link_;
  Machine& machine_;
  ArrayCache cache_;
  LibraryCheck libraries_;
  std::unique_ptr<CommitValidator> validator_;
  Peer peer_ = 0;
  std::string address_, told_;
  double asked_ = 0; // when Hello was said
  uint64_t session_ = 0, masters_ = 0;
  // The machine's epochs go on where those of the former master ended, so that what comes late is
  // seen to be late.
  Epoch base_ = 0, newest_ = 0;
  std::string broken_; // why nothing can be made until a whole scene comes
  std::deque<Coming> coming_;
  std::map<Hash, ArrayStream> streams_;
  size_t begun_ = 0; // of these
  std::deque<std::pair<Epoch, size_t>>
      unanswered_; // scenes of which the machine has not spoken yet, bytes of their edits
  size_t unansweredBytes_ = 0;
  std::map<Epoch, edit::FrameSettingsT> frames_; // of what is prepared; the machine's epochs
  std::map<Epoch, std::set<Lease>> leases_;      // of jobs that are out
  uint64_t logged_ = 0;
};

} // namespace openrt::cluster
