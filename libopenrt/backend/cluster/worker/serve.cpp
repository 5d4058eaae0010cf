// serve.cpp: runs the threads of a worker. One queue holds tasks for the session, another one the
// session's messages to the wire.
#include "backend/cluster/worker/serve.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "backend/cluster/net/greeting.h"
#include "backend/cluster/net/sockets.h"
#include "backend/cluster/worker/exchange.h"
#include "backend/cluster/worker/worker.h"
#include "backend/cluster/worker/worker_core.h"
#include "keep_running.h"

namespace openrt::cluster {
namespace {

// Bytes that the session has not read. Above this limit nothing is received.
constexpr size_t maxWaiting = size_t(512) << 20;
constexpr size_t overhead = 512; // approximate size of a waiting message besides its frames
// Seconds to wait for messages; `hurry` while a message could not be sent.
constexpr double idle = 0.05, hurry = 0.001;

} // namespace

struct WorkerService::Impl final : WorkerSink, JobExecutor {
  struct WireTask { // frames for a peer, or another action on the wire
    Peer peer = 0;
    Frames frames;
    std::function<void(Wire&)> act;
  };

  explicit Impl(const ServeOptions& o) : options(o), wire(o.wire) {
    options.backend.log = [](int level, const char* text, void* user) {
      static_cast<Impl*>(user)->backendLog(level, text);
    };
    options.backend.logUser = this;
    core = std::make_unique<WorkerCore>(options.backend, *this);
    RTstats stats{};
    stats.size = sizeof stats;
    core->ask([&](Backend& backend) { backend.stats(stats); });
    WorkerOptions w;
    w.self = identity(stats);
    w.self.threads = core->threads();
    w.shaders = options.backend.shaders;
    w.cacheBytes = options.cacheBytes;
    w.log = options.log;
    if (!options.folder.empty()) folder.emplace(options.folder, options.folderBytes, options.log);
    w.folder = folder ? &*folder : nullptr;
    share(w.self);
    self = w.self;
    worker = std::make_unique<Worker>(w, link(), *this, counts);
  }
  ~Impl() override { // stops all callbacks first
    exchange.reset();
    core.reset();
  }

  // Opens the door for other workers, and tells it in Hello.
  void share(message::Hello& hello) {
    if (options.share.empty()) return;
    if (!folder) throw std::runtime_error("arrays are shared from a folder, and none is given");
    ExchangeOptions e;
    e.listen = options.share;
    e.keys = options.wire.keys;
    e.done = [this](const Hash& hash, ArrayPtr array) {
      post([=](Worker& w) { w.fetched(hash, array); });
    };
    exchange = std::make_unique<Exchange>(e, *folder, counts);
    hello.share = exchange->port();
    hello.shareKey = options.wire.keys.publicKey;
  }

  std::string metrics() const {
    return metricsText(counts,
                       {.threads = core->threads(),
                        .serving = serving,
                        .damagedFiles = folder ? folder->damaged() : 0},
                       self);
  }

  WorkerLink link() {
    std::function<void(const std::string&, std::vector<message::ArrayName>)> fetch;
    if (exchange)
      fetch = [this](const std::string& address, std::vector<message::ArrayName> arrays) {
        exchange->fetch(address, std::move(arrays));
      };
    const auto does = [this](Peer peer, std::function<void(Wire&)> act) {
      postToWire({peer, {}, std::move(act)});
    };
    return {[this](Peer peer, Frames&& frames) {
              postToWire({peer, std::move(frames), {}});
            },
            [this, does](Peer peer, const std::string& why) {
              does(peer, [=, this](Wire& w) {
                w.close(peer, why);
                alive.erase(peer);
              });
            },
            [does](Peer peer, const std::string& why) {
              does(peer, [=](Wire& w) { w.bad(peer, why); });
            },
            [this, does](double heartbeat, double silence) {
              const double h = heartbeat > 0 ? heartbeat : options.wire.heartbeat,
                           s = silence > 0 ? silence : options.wire.silence;
              does(0, [h, s](Wire& w) { w.pace(h, s); });
            },
            std::move(fetch)};
  }

  // [any] Posts a task to the session.
  void post(std::function<void(Worker&)> task, size_t bytes = 0) {
    {
      const std::lock_guard lock(mutex);
      tasks.emplace_back(std::move(task), bytes);
      waiting += bytes;
    }
    changed.notify_one();
  }
  // [session] Posts a message or action to the wire.
  void postToWire(WireTask&& wireTask) {
    {
      const std::lock_guard lock(mutex);
      wireTasks.push_back(std::move(wireTask));
    }
    wire.wake();
  }
  void backendLog(int level, const std::string& text) {
    if (options.log) options.log(level, text);
    post([=](Worker& w) { w.log(level, text); });
  }

  // WorkerSink, called on the core's threads.
  void ready(Epoch epoch, const Prepared& prepared) override {
    post([=](Worker& w) { w.ready(epoch, prepared); });
  }
  void failed(Epoch epoch, const std::string& why) override {
    post([=](Worker& w) { w.failed(epoch, why); });
  }
  void done(Epoch epoch, const LeasedJob& job, JobResult&& result) override {
    const auto kept = std::make_shared<JobResult>(std::move(result));
    post([=](Worker& w) { w.done(epoch, job, std::move(*kept)); });
  }

  // JobExecutor, called by the session.
  void useInstructionSet(const std::string& isa) override { core->useInstructionSet(isa); }
  void scene(Epoch epoch, std::shared_ptr<const Commit> commit, bool whole, bool prepare) override {
    core->scene(epoch, std::move(commit), whole, prepare);
  }
  void prepare(Epoch epoch) override { core->prepare(epoch); }
  void work(Epoch epoch, std::span<const LeasedJob> jobs) override { core->work(epoch, jobs); }
  void drop(Epoch epoch) override { core->drop(epoch); }

  void sessionLoop() {
    keepRunning([this] { return stopping.load(); }, [this] { doTask(); }, [] {});
  }

  // Waits for a task, and does it.
  void doTask() {
    std::function<void(Worker&)> task;
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [this] { return stopping || !tasks.empty(); });
      if (stopping) return;
      task = std::move(tasks.front().first);
      waiting -= tasks.front().second;
      tasks.pop_front();
    }
    try {
      task(*worker);
    } catch (const std::exception& e) {
      if (options.log) options.log(3, e.what());
    }
    serving = worker->serving();
    if (options.once && worker->masters() > 0 && !worker->serving()) stop();
  }

  // Sends the session's messages in order, as far as the queues accept them. Returns true if all
  // were sent.
  bool flush() {
    for (;;) {
      WireTask wireTask;
      {
        const std::lock_guard lock(mutex);
        if (wireTasks.empty()) return true;
        wireTask = std::move(wireTasks.front());
        wireTasks.pop_front();
      }
      if (wireTask.act) {
        wireTask.act(wire);
      } else if (const size_t bytes = bytesOf(wireTask.frames);
                 wire.send(wireTask.peer, std::move(wireTask.frames))) {
        counts.toMaster += bytes;
      } else if (alive.contains(wireTask.peer)) {
        const std::lock_guard lock(mutex);
        wireTasks.push_front(std::move(wireTask));
        return false;
      }
    }
  }

  void take(Event&& event) {
    const double now = steadySeconds();
    const Peer peer = event.peer;
    switch (event.kind) {
    case Event::Kind::joined:
      alive.insert(peer);
      return post(
          [=, address = std::move(event.text)](Worker& w) { w.joined(peer, address, now); });
    case Event::Kind::left: {
      const std::lock_guard lock(mutex);
      std::erase_if(wireTasks, [&](const WireTask& s) { return s.peer == peer; });
      break;
    }
    case Event::Kind::message: {
      const size_t bytes = bytesOf(event.frames) + overhead;
      counts.fromMaster += bytes - overhead;
      const auto kept = std::make_shared<Frames>(std::move(event.frames));
      return post([=](Worker& w) { w.message(peer, std::move(*kept), now); }, bytes);
    }
    case Event::Kind::refused:
      if (options.log) options.log(2, event.text);
      return;
    default: return;
    }
    alive.erase(peer);
    post([=, why = std::move(event.text)](Worker& w) { w.left(peer, why, now); });
  }

  // Throws std::bad_alloc if there is no memory for a message.
  void run() {
    std::thread session([this] { sessionLoop(); });
    std::exception_ptr failure;
    try {
      serve();
    } catch (...) {
      failure = std::current_exception();
      stopping = true;
    }
    {
      const std::lock_guard lock(mutex); // no waiter can miss the notification
    }
    changed.notify_all();
    session.join();
    if (failure) std::rethrow_exception(failure);
    flush(); // last messages
  }

  // Exchanges messages until stop() is called.
  void serve() {
    double advanced = 0;
    while (!stopping) {
      const bool all = flush();
      if (bytesWaiting() > maxWaiting) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        continue;
      }
      take(wire.receive(all ? idle : hurry));
      if (const double now = steadySeconds(); now - advanced > 1) {
        advanced = now;
        post([=](Worker& w) { w.advance(now); });
      }
    }
  }

  size_t bytesWaiting() {
    const std::lock_guard lock(mutex);
    return waiting;
  }

  void stop() {
    stopping = true;
    wire.wake();
  }

  ServeOptions options;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::pair<std::function<void(Worker&)>, size_t>> tasks;
  size_t waiting = 0;
  std::deque<WireTask> wireTasks;
  std::atomic<bool> stopping{false}, serving{false};
  std::set<Peer> alive; // peers that the wire reports as connected
  Wire wire;
  WorkerCounts counts;
  message::Hello self;
  std::optional<ArrayFolder> folder;
  std::unique_ptr<Worker> worker;
  std::unique_ptr<WorkerCore> core;
  std::unique_ptr<Exchange> exchange;
};

WorkerService::WorkerService(const ServeOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
WorkerService::~WorkerService() = default;

std::string WorkerService::address() const { return impl_->wire.address(); }
void WorkerService::run() { impl_->run(); }
void WorkerService::stop() { impl_->stop(); }
bool WorkerService::serving() const { return impl_->serving; }
std::string WorkerService::metrics() const { return impl_->metrics(); }

} // namespace openrt::cluster
