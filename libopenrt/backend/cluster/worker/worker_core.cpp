// worker_core.cpp: orders the requests of a worker. All requests wait in one queue. Threads take
// jobs from its front. Changes of the scene and queries are run by the control thread alone, once
// they are at the front and no job runs.
#include "backend/cluster/worker/worker_core.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "backend/local/local.h"
#include "keep_running.h"
#include "render/frame/job_runner.h"
#include "start_threads.h"

namespace openrt::cluster {
namespace {

struct Command {
  enum class Kind : uint8_t { job, instructionSet, scene, prepare, question } kind = Kind::job;
  Epoch epoch = 0;
  LeasedJob job;
  std::shared_ptr<const Commit> commit;
  bool whole = false, prepare = false;
  std::string isa;
  const std::function<void(Backend&)>* question = nullptr;
  bool* answered = nullptr;
  std::exception_ptr* failure = nullptr;
};

} // namespace

struct WorkerCore::Impl {
  Impl(const BackendOptions& o, WorkerSink& s)
      : options(o), sink(s), count(o.threads ? o.threads : availableThreads()) {
    options.threads = count;
    backend = std::make_unique<LocalBackend>(options);
    running = std::make_unique<Running[]>(count);
    startThreads(threads, 1, [this](size_t) { control(); });
    try {
      startThreads(threads, count, [this](size_t i) { work(uint32_t(i)); });
    } catch (...) {
      end();
      throw;
    }
  }
  ~Impl() { end(); }

  void end(); // ends the threads

  void push(Command&& command);
  void work(uint32_t thread);
  void control();
  void runCommands(const Command& command); // the control thread runs it alone, without the lock
  void applyCommit(const Command& command);
  void makeReady(Epoch epoch);
  void reportFailure(Epoch epoch, const std::string& why);
  // Repeats a report for which memory is short: nobody would repeat the job otherwise.
  template <class Report> void insist(const Report& report) {
    const auto isClosing = [this] {
      const std::lock_guard lock(mutex);
      return closing;
    };
    repeatUntilDone(isClosing, report);
  }
  bool jobInFront() const {
    return !alone && !queue.empty() && queue.front().kind == Command::Kind::job;
  }
  bool controlInFront() const {
    return busy == 0 && !queue.empty() && queue.front().kind != Command::Kind::job;
  }

  BackendOptions options;
  WorkerSink& sink;
  const uint32_t count;
  std::mutex sinkMutex; // serialises the calls of the sink

  struct Running { // the job of a thread
    Epoch epoch = 0;
    std::atomic<bool> stop{false};
    std::unique_ptr<JobRunner> runner; // uses the prepared scene; null: none yet
  };
  // One per thread. A runner belongs to its thread, or to the control thread while that is alone.
  std::unique_ptr<Running[]> running;

  // Owned by the control thread. Other threads read it only while the control thread is not alone.
  std::unique_ptr<LocalBackend> backend;
  bool intact = true;                       // all commits since the last whole scene were applied
  std::shared_ptr<const RenderScene> scene; // null until it is prepared
  Epoch applied = 0;                        // epoch of the last commit
  Epoch broken = 0;                         // epoch of the last reported failure

  std::mutex mutex; // guards all members below and Running::epoch
  std::condition_variable jobsCame, controlCame, answers;
  std::deque<Command> queue;
  uint32_t busy = 0; // threads that run a job
  bool alone = false, closing = false;

  std::vector<std::thread> threads;
};

void WorkerCore::Impl::end() {
  {
    std::lock_guard lock(mutex);
    closing = true;
    for (uint32_t i = 0; i < count; i++) running[i].stop = true;
  }
  jobsCame.notify_all();
  controlCame.notify_all();
  for (std::thread& thread : threads) thread.join();
}

void WorkerCore::Impl::push(Command&& command) {
  {
    std::lock_guard lock(mutex);
    queue.push_back(std::move(command));
  }
  jobsCame.notify_one();
  controlCame.notify_one();
}

void WorkerCore::Impl::reportFailure(Epoch epoch, const std::string& why) {
  std::lock_guard lock(sinkMutex);
  if (broken == epoch && epoch != 0) return;
  sink.failed(epoch, why);
  broken = epoch;
}

void WorkerCore::Impl::work(uint32_t thread) {
  Running& mine = running[thread];
  JobResult result;
  std::unique_lock lock(mutex);
  for (;;) {
    jobsCame.wait(lock, [this] { return closing || jobInFront(); });
    if (closing) return;
    const Command command = std::move(queue.front());
    queue.pop_front();
    busy++;
    mine.epoch = command.epoch;
    mine.stop = false;
    const bool here = scene && command.epoch == applied;
    lock.unlock();
    try {
      if (here) {
        if (!mine.runner) mine.runner = std::make_unique<JobRunner>(scene);
        if (mine.runner->run(command.job.job, mine.stop, result)) {
          std::lock_guard sinkLock(sinkMutex);
          sink.done(command.epoch, command.job, std::move(result));
        }
      } else {
        reportFailure(command.epoch, "a job is of a scene that is not prepared");
      }
    } catch (const std::exception& e) {
      mine.runner = nullptr; // it may be in an undefined state
      insist([&] { reportFailure(command.epoch, std::string("rendering failed: ") + e.what()); });
    }
    lock.lock();
    busy--;
    mine.epoch = 0;
    if (controlInFront()) controlCame.notify_one();
  }
}

void WorkerCore::Impl::control() {
  std::unique_lock lock(mutex);
  for (;;) {
    controlCame.wait(lock, [this] { return closing || controlInFront(); });
    if (closing) return;
    const Command command = std::move(queue.front());
    queue.pop_front();
    alone = true;
    lock.unlock();
    runCommands(command);
    lock.lock();
    alone = false;
    if (command.answered) *command.answered = true, answers.notify_all();
    jobsCame.notify_all();
  }
}

void WorkerCore::Impl::runCommands(const Command& command) {
  try {
    switch (command.kind) {
    case Command::Kind::job: return;
    case Command::Kind::instructionSet: options.isa = command.isa; return;
    case Command::Kind::scene: return applyCommit(command);
    case Command::Kind::prepare:
      if (command.epoch == applied && intact && !scene) makeReady(command.epoch);
      return;
    case Command::Kind::question:
      if (!backend) throw std::runtime_error("there is no scene");
      return (*command.question)(*backend);
    }
  } catch (const std::exception& e) {
    if (command.failure)
      *command.failure = std::current_exception();
    else
      insist([&] { reportFailure(command.epoch, e.what()); });
  }
}

void WorkerCore::Impl::applyCommit(const Command& command) {
  for (uint32_t i = 0; i < count; i++) running[i].runner = nullptr;
  scene = nullptr;
  applied = command.epoch;
  if (!command.whole && !intact) throw std::runtime_error("an earlier change of the scene failed");
  intact = false;
  if (command.whole) {
    backend = nullptr; // frees its memory first
    backend = std::make_unique<LocalBackend>(options);
  }
  backend->apply(command.commit);
  intact = true;
  if (command.prepare) makeReady(command.epoch);
}

void WorkerCore::Impl::makeReady(Epoch epoch) {
  scene = backend->prepared();
  Prepared prepared{.facts = factsOf(*scene), .frame = scene->frame};
  prepared.stats.size = sizeof prepared.stats;
  backend->stats(prepared.stats);
  std::lock_guard lock(sinkMutex);
  sink.ready(epoch, prepared);
}

WorkerCore::WorkerCore(const BackendOptions& options, WorkerSink& sink)
    : impl_(std::make_unique<Impl>(options, sink)) {}
WorkerCore::~WorkerCore() = default;

uint32_t WorkerCore::threads() const { return impl_->count; }

void WorkerCore::useInstructionSet(const std::string& isa) {
  Command command;
  command.kind = Command::Kind::instructionSet;
  command.isa = isa;
  impl_->push(std::move(command));
}

void WorkerCore::scene(Epoch epoch, std::shared_ptr<const Commit> commit, bool whole,
                       bool prepare) {
  Command command;
  command.kind = Command::Kind::scene;
  command.epoch = epoch;
  command.commit = std::move(commit);
  command.whole = whole;
  command.prepare = prepare;
  impl_->push(std::move(command));
}

void WorkerCore::prepare(Epoch epoch) {
  Command command;
  command.kind = Command::Kind::prepare;
  command.epoch = epoch;
  impl_->push(std::move(command));
}

void WorkerCore::work(Epoch epoch, std::span<const LeasedJob> jobs) {
  {
    std::lock_guard lock(impl_->mutex);
    for (const LeasedJob& job : jobs) {
      Command& command = impl_->queue.emplace_back();
      command.epoch = epoch;
      command.job = job;
    }
  }
  impl_->jobsCame.notify_all();
}

void WorkerCore::drop(Epoch epoch) {
  std::lock_guard lock(impl_->mutex);
  std::erase_if(impl_->queue,
                [&](const Command& c) { return c.kind == Command::Kind::job && c.epoch <= epoch; });
  for (uint32_t i = 0; i < impl_->count; i++)
    if (impl_->running[i].epoch != 0 && impl_->running[i].epoch <= epoch)
      impl_->running[i].stop = true;
  impl_->jobsCame.notify_all();
  impl_->controlCame.notify_one();
}

void WorkerCore::ask(const std::function<void(Backend&)>& question) {
  bool answered = false;
  std::exception_ptr failure;
  Command command;
  command.kind = Command::Kind::question;
  command.question = &question;
  command.answered = &answered;
  command.failure = &failure;
  impl_->push(std::move(command));
  std::unique_lock lock(impl_->mutex);
  impl_->answers.wait(lock, [&] { return answered; });
  if (failure) std::rethrow_exception(failure);
}

} // namespace openrt::cluster
