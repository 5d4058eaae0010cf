// cluster.cpp: the backend that renders with remote workers. One thread, the network thread, owns
// the Wire and the Master. The local worker (WorkerCore) has its own threads. Other threads post
// functions to the network thread and wait if they need an answer. Longer than 500 lines because
// all of it is one backend, whose threads share its members.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <random>
#include <thread>

#include "backend/backend.h"
#include "backend/cluster/master/hosts.h"
#include "backend/cluster/master/master.h"
#include "backend/cluster/net/greeting.h"
#include "backend/queries.h"
#include "render/frame/threads.h"
#include "scene/sums_error.h"
#include "shortage.h"
#include "steady_clock.h"
#include "task_threads.h"

namespace openrt {
namespace {

using namespace cluster;

Split splitOf(const std::string& word) {
  if (word == "tiles") return Split::tiles;
  if (word == "samples") return Split::samples;
  if (word == "frames") return Split::frames;
  return Split::automatic;
}

// Returns the number of threads that merge remote results while one serves the network.
uint32_t mergersOf(uint32_t threads) { return std::clamp(threads / 2, 1u, 8u); }

class ClusterBackend final : public Backend, private Queries, private WorkerSink {
 public:
  ClusterBackend(const BackendOptions& options, const ClusterOptions& cluster)
      : log_(options.log), logUser_(options.logUser) {
    WireOptions wire;
    wire.connect = readHosts(cluster.workers);
    wire.listen = cluster.listen;
    if (!cluster.keyFile.empty())
      wire.keys = readKeys(cluster.keyFile, cluster.allowFile);
    else if (!cluster.allowFile.empty())
      throw ClusterError("the list of accepted keys (allow=" + cluster.allowFile +
                         ") needs key=FILE");
    wire_ = std::make_unique<Wire>(wire);
    BackendOptions local = options;
    if (cluster.local.value_or(0) > 0) local.threads = *cluster.local;
    core_ = std::make_unique<WorkerCore>(local, static_cast<WorkerSink&>(*this));
    RTstats self{};
    core_->ask([&](Backend& backend) { backend.stats(self); });

    MasterOptions master;
    master.schedule.split = splitOf(cluster.split);
    master.tolerant = cluster.tolerant;
    master.local = local;
    master.localThreads = cluster.local == 0u ? 0 : core_->threads();
    master.require = cluster.require;
    master.session = uint64_t(std::random_device()()) << 32 | 1;
    master.self = identity(self);
    identity_ = {0, 0, versionText(), self.machine.isa, self.machine.kernel};
    master.close = [this](Peer peer, const std::string& why) { wire_->close(peer, why); };
    master.background = [this](std::function<void()> heavy, MasterOptions::Then then) {
      background_.post(taskFor(std::move(heavy), std::move(then)));
    };
    master.results = [this](std::function<void()> heavy, MasterOptions::Then then) {
      results_.push_back(taskFor(std::move(heavy), std::move(then)));
    };
    master_ = std::make_unique<Master>(
        master, [this](Peer peer, Frames&& frames) { return wire_->send(peer, std::move(frames)); },
        core_.get());
    thread_ = std::thread([this] { run(); });
  }

  ~ClusterBackend() override;

  bool pipelines() const override { return true; }

  void apply(std::shared_ptr<const Commit> commit) override;
  bool keepSums(const SumsRequest& request) override;
  std::shared_ptr<FrameSums> sums() const override;
  void start() override;
  void wait() override;
  void cancel() override;
  float progress() const override;
  bool snapshot(RTenum channel, std::span<float> out) const override;
  bool read(RTenum channel, std::span<float> out) const override;
  void stats(RTstats& s) const override;
  std::vector<RTworker> workers() const override;

  Queries* queries() override { return this; }

 private:
  struct FrameInFlight { // a frame that was started
    Epoch epoch = 0;
    double begun = 0, ended = 0;
    Master::FrameState state;
  };

  // Posts the commits to the network thread. If `frame`, the last one starts a frame.
  void postCommits(bool frame);

  // Queries: the local worker answers them.
  void castRays(std::span<const RTray> rays, std::span<RThit> hits) override;
  void occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) override;
  bool pick(double x, double y, RThit& hit) override;
  void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) override;
  void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                std::span<RThit> hits) override;
  void closestPoints(std::span<const float> points, float radius,
                     std::span<RTclosest> closest) override;
  void castDouble(std::span<const RTrayd> rays, std::span<RThitd> hits) override;
  void occludeDouble(std::span<const RTrayd> rays, std::span<uint8_t> occluded) override;
  void countDouble(std::span<const RTrayd> rays, std::span<uint32_t> counts) override;
  void listDouble(std::span<const RTrayd> rays, std::span<const size_t> first,
                  std::span<RThitd> hits) override;
  void closestDouble(std::span<const double> points, double radius,
                     std::span<RThitd> closest) override;

  // Asks about the last committed scene. The local worker has it once all earlier frames are
  // finished.
  void ask(const std::function<void(Queries&)>& question);

  // [any] Runs a function on the network thread.
  void post(std::function<void(double)> command) const;

  // Returns the result of a function that runs on the network thread.
  template <class F> auto call(const F& function) const -> decltype(function(0.0)) {
    using Result = decltype(function(0.0));
    auto promise = std::make_shared<std::promise<Result>>();
    auto answer = promise->get_future();
    post([promise, &function](double now) {
      try {
        promise->set_value(function(now));
      } catch (...) { promise->set_exception(std::current_exception()); }
    });
    promise.reset(); // the future fails if the command is dropped
    try {
      return answer.get();
    } catch (const std::future_error&) {
      const std::lock_guard lock(mutex_);
      throw ClusterError(broken_.empty() ? "the cluster has ended" : broken_);
    }
  }

  // WorkerSink, called on the local worker's threads.
  void ready(Epoch epoch, const Prepared& prepared) override;
  void failed(Epoch epoch, const std::string& why) override;
  void done(Epoch epoch, const LeasedJob& job, JobResult&& result) override;

  void run() noexcept;

  TaskThreads::Task taskFor(std::function<void()> heavy, std::function<void(double)> then);
  void runCommands();

  // Handles the messages that have arrived and those that follow at once.
  void receiveMessages(double seconds);

  // Publishes the state of the frames in flight to the threads that poll or wait.
  void publish();

  RTlogCallback log_;
  void* logUser_;
  // Application thread.
  std::deque<std::shared_ptr<const Commit>> unsent_;
  Epoch epoch_ = 0;
  FrameInFlight finished_;
  SumsRequest keep_;
  SumsIdentity identity_; // without the scene
  double commitSeconds_ = 0;

  mutable std::mutex mutex_; // guards the members up to totalsAt_
  std::condition_variable changed_;
  std::deque<FrameInFlight> framesInFlight_;
  std::string broken_; // reason why no more frames are rendered
  Master::Totals totals_;
  std::vector<RTworker> workers_;
  double totalsAt_ = 0; // when totals_ and workers_ were updated

  mutable std::mutex commandMutex_; // guards commands_ and closed_
  mutable std::vector<std::function<void(double)>> commands_;
  mutable bool closed_ = false;

  // Network thread.
  bool stop_ = false;
  // Start of the current busy period, moved forward by the time spent waiting.
  double waited_ = steadySeconds();
  std::vector<TaskThreads::Task> results_; // for the merging threads
  std::unique_ptr<Wire> wire_;
  std::unique_ptr<WorkerCore> core_;
  std::unique_ptr<Master> master_;
  // Tasks that would hold up the network.
  TaskThreads background_, mergers_{mergersOf(availableThreads())};
  std::thread thread_;
};

ClusterBackend::~ClusterBackend() {
  cancel();
  post([this](double) { stop_ = true; });
  thread_.join();
}

void ClusterBackend::apply(std::shared_ptr<const Commit> commit) {
  const double begin = steadySeconds();
  unsent_.push_back(std::move(commit));
  commitSeconds_ = steadySeconds() - begin;
}

bool ClusterBackend::keepSums(const SumsRequest& request) {
  keep_ = request;
  return true;
}

std::shared_ptr<FrameSums> ClusterBackend::sums() const {
  std::shared_ptr<FrameWork> work;
  {
    const std::lock_guard lock(mutex_);
    work = framesInFlight_.empty() ? finished_.state.work : framesInFlight_.front().state.work;
  }
  return work ? work->sums() : nullptr;
}

void ClusterBackend::start() {
  if (unsent_.empty()) unsent_.push_back(std::make_shared<Commit>());
  FrameInFlight flight;
  flight.epoch = epoch_ + unsent_.size();
  flight.begun = steadySeconds();
  {
    const std::lock_guard lock(mutex_);
    framesInFlight_.push_back(flight);
  }
  postCommits(true);
}

void ClusterBackend::wait() {
  std::unique_lock lock(mutex_);
  if (framesInFlight_.empty()) return;
  changed_.wait(lock, [this] { return framesInFlight_.front().state.over || !broken_.empty(); });
  finished_ = std::move(framesInFlight_.front());
  framesInFlight_.pop_front();
  const std::string broken = broken_;
  lock.unlock();
  if (!finished_.state.over) throw ClusterError(broken);
  post([this, epoch = finished_.epoch](double) { master_->forget(epoch); });
  const Master::FrameState& state = finished_.state;
  if (state.failure.empty()) return;
  if (state.missing) throw ClusterError(state.failure);
  if (state.sumsWrong) throw SumsError(state.failure);
  throw std::runtime_error(state.failure);
}

void ClusterBackend::cancel() {
  Epoch last = 0;
  {
    const std::lock_guard lock(mutex_);
    if (framesInFlight_.empty()) return;
    last = framesInFlight_.back().epoch;
  }
  post([this, last](double now) { master_->cancel(last, now); });
}

float ClusterBackend::progress() const {
  const std::lock_guard lock(mutex_);
  if (framesInFlight_.empty()) return 1;
  const Master::FrameState& state = framesInFlight_.front().state;
  if (state.over || !broken_.empty()) return 1; // wait() returns at once
  return state.work ? state.work->progress() : 0;
}

bool ClusterBackend::snapshot(RTenum channel, std::span<float> out) const {
  std::shared_ptr<FrameWork> work;
  {
    const std::lock_guard lock(mutex_);
    if (!framesInFlight_.empty()) work = framesInFlight_.front().state.work;
  }
  return work && work->snapshot(channel, out);
}

bool ClusterBackend::read(RTenum channel, std::span<float> out) const {
  return finished_.state.work && finished_.state.work->film().read(channel, out);
}

void ClusterBackend::stats(RTstats& s) const {
  if (const Master::FrameState& state = finished_.state; state.work) {
    s = state.prepared.stats; // scene statistics
    s.time.render = finished_.ended - finished_.begun;
    s.transport.chosen = state.prepared.frame.transport;
    state.work->describe(s);
  } else {
    core_->ask([&](Backend& backend) { backend.stats(s); });
  }
  s.time.commit = commitSeconds_;
  const std::lock_guard lock(mutex_);
  s.cluster = totals_.cluster;
  s.machine.threads = totals_.threads;
}

std::vector<RTworker> ClusterBackend::workers() const {
  // The network thread may be inside the application's log callback.
  const std::lock_guard lock(mutex_);
  return workers_;
}

void ClusterBackend::postCommits(bool frame) {
  KeepSums kept{keep_.keep, identity_, frame ? std::exchange(keep_.from, nullptr) : nullptr};
  kept.identity.world = keep_.scene.world;
  kept.identity.view = keep_.scene.view;
  while (!unsent_.empty()) {
    const bool last = unsent_.size() == 1;
    post([this, epoch = ++epoch_, commit = std::move(unsent_.front()), render = frame && last,
          kept](double now) { master_->commit(epoch, commit, render, now, kept); });
    unsent_.pop_front();
  }
}

void ClusterBackend::castRays(std::span<const RTray> rays, std::span<RThit> hits) {
  ask([&](Queries& local) { local.castRays(rays, hits); });
}

void ClusterBackend::occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) {
  ask([&](Queries& local) { local.occludedRays(rays, occluded); });
}

bool ClusterBackend::pick(double x, double y, RThit& hit) {
  bool seen = false;
  ask([&](Queries& local) { seen = local.pick(x, y, hit); });
  return seen;
}

void ClusterBackend::countHits(std::span<const RTray> rays, std::span<uint32_t> counts) {
  ask([&](Queries& local) { local.countHits(rays, counts); });
}

void ClusterBackend::listHits(std::span<const RTray> rays, std::span<const size_t> first,
                              std::span<RThit> hits) {
  ask([&](Queries& local) { local.listHits(rays, first, hits); });
}

void ClusterBackend::closestPoints(std::span<const float> points, float radius,
                                   std::span<RTclosest> closest) {
  ask([&](Queries& local) { local.closestPoints(points, radius, closest); });
}

void ClusterBackend::castDouble(std::span<const RTrayd> rays, std::span<RThitd> hits) {
  ask([&](Queries& local) { local.castDouble(rays, hits); });
}

void ClusterBackend::occludeDouble(std::span<const RTrayd> rays, std::span<uint8_t> occluded) {
  ask([&](Queries& local) { local.occludeDouble(rays, occluded); });
}

void ClusterBackend::countDouble(std::span<const RTrayd> rays, std::span<uint32_t> counts) {
  ask([&](Queries& local) { local.countDouble(rays, counts); });
}

void ClusterBackend::listDouble(std::span<const RTrayd> rays, std::span<const size_t> first,
                                std::span<RThitd> hits) {
  ask([&](Queries& local) { local.listDouble(rays, first, hits); });
}

void ClusterBackend::closestDouble(std::span<const double> points, double radius,
                                   std::span<RThitd> closest) {
  ask([&](Queries& local) { local.closestDouble(points, radius, closest); });
}

void ClusterBackend::ask(const std::function<void(Queries&)>& question) {
  postCommits(false);
  for (;;) {
    if (call([this](double) { return master_->sendSceneToLocal(); })) break;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(20)); // perhaps a frame has ended
  }
  core_->ask([&](Backend& backend) { question(*backend.queries()); });
}

void ClusterBackend::post(std::function<void(double)> command) const {
  bool first = false;
  {
    const std::lock_guard lock(commandMutex_);
    if (closed_) return;
    first = commands_.empty();
    commands_.push_back(std::move(command));
  }
  if (first) wire_->wake();
}

void ClusterBackend::ready(Epoch epoch, const Prepared& prepared) {
  post([this, epoch, prepared](double now) { master_->localReady(epoch, prepared, now); });
}

void ClusterBackend::failed(Epoch epoch, const std::string& why) {
  post([this, epoch, why](double now) { master_->localFailed(epoch, why, now); });
}

void ClusterBackend::done(Epoch epoch, const LeasedJob& job, JobResult&& result) {
  post([this, epoch, job, result = std::make_shared<JobResult>(std::move(result))](double now) {
    master_->localDone(epoch, job, std::move(*result), now);
  });
}

void ClusterBackend::run() noexcept {
  try {
    while (!stop_) {
      runCommands();
      const double next = master_->advance(steadySeconds());
      publish();
      receiveMessages(std::clamp(next - steadySeconds(), 0.0, 0.1));
      master_->busy(steadySeconds() - waited_);
      waited_ = steadySeconds();
    }
  } catch (const std::bad_alloc&) {
    const std::lock_guard lock(mutex_);
    broken_ = "out of memory"; // so short that it needs none
  } catch (const std::exception& e) {
    const std::lock_guard lock(mutex_);
    broken_ = std::string("the cluster has failed: ") + e.what();
  }
  std::vector<std::function<void(double)>> left;
  {
    const std::lock_guard lock(commandMutex_);
    closed_ = true;
    left.swap(commands_);
  }
  left.clear(); // threads that wait for a command get an exception
  changed_.notify_all();
}

TaskThreads::Task ClusterBackend::taskFor(std::function<void()> heavy,
                                          std::function<void(double)> then) {
  return [this, heavy = std::move(heavy), then = std::move(then)]() mutable {
    heavy();
    post(std::move(then));
  };
}

void ClusterBackend::runCommands() {
  std::vector<std::function<void(double)>> commands;
  {
    const std::lock_guard lock(commandMutex_);
    commands.swap(commands_);
  }
  for (auto& command : commands) command(steadySeconds());
  mergers_.post(results_);
}

void ClusterBackend::receiveMessages(double seconds) {
  constexpr int most = 256; // messages before jobs are handed out
  // Results per batch for the merging threads: waking a thread for each one would take longer.
  constexpr size_t together = 16;
  for (int i = 0; i < most; i++) {
    if (results_.size() >= together) mergers_.post(results_);
    const double asked = steadySeconds();
    Event event = wire_->receive(i == 0 ? seconds : 0);
    const double now = steadySeconds();
    if (i == 0) waited_ += now - asked;
    switch (event.kind) {
    case Event::Kind::nothing:
    case Event::Kind::woken: return mergers_.post(results_);
    case Event::Kind::joined: master_->joined(event.peer, event.text, now); break;
    case Event::Kind::message: master_->message(event.peer, std::move(event.frames), now); break;
    case Event::Kind::left: master_->left(event.peer, event.text, now); break;
    case Event::Kind::refused:
      if (log_) log_(2, ("cluster: " + event.text).c_str(), logUser_);
      break;
    }
  }
  mergers_.post(results_);
}

void ClusterBackend::publish() {
  constexpr double often = 0.1; // seconds between counts while no frame ends
  bool ended = false;
  std::vector<std::shared_ptr<FrameWork>> works;
  {
    const std::lock_guard lock(mutex_);
    for (FrameInFlight& flight : framesInFlight_) {
      if (flight.state.over) continue;
      flight.state = master_->frame(flight.epoch);
      if (!flight.state.over) continue;
      flight.ended = steadySeconds();
      ended = true;
      if (flight.state.work) works.push_back(flight.state.work);
    }
    if (const double now = steadySeconds(); ended || now > totalsAt_ + often) {
      totals_ = master_->totals();
      workers_ = master_->workers();
      totalsAt_ = now;
    }
  }
  if (log_)
    for (const auto& work : works) {
      const RayCounters counters = work->counters();
      counters.faults.report(log_, logUser_, counters.camera);
    }
  if (ended) changed_.notify_all();
}

} // namespace

std::unique_ptr<Backend> makeClusterBackend(const BackendOptions& options,
                                            const ClusterOptions& cluster) {
  try {
    return std::make_unique<ClusterBackend>(options, cluster);
  } catch (const ClusterError&) { throw; } catch (const std::exception& e) {
    if (isShortage(e)) throw;
    throw ClusterError(e.what());
  }
}

} // namespace openrt
