// cluster_simulation.h: simulates a cluster. The master is real; links, workers (which sleep) and
// the threads that merge results are models (cluster_model.h). Used by bench_cluster_sim
// (cluster_sim.cpp). [one thread]
#pragma once

#include <cstring>
#include <map>
#include <memory>
#include <set>

#include "backend/cluster/master/master.h"
#include "bench/cluster_model.h"
#include "thread_clock.h"

namespace sim {

struct Options {
  std::vector<uint32_t> workers{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
  uint32_t threads = 16, width = 1920, height = 1080, samples = 1024, tile = 0, frames = 3;
  double work = 2048;     // thread seconds per frame
  double network = 10e9;  // bits per second of the master's network card
  double link = 10e9;     // bits per second of a worker's link
  double latency = 50e-6; // seconds, one way
  // seconds of the master's socket thread per message and per byte (--curve: with encryption)
  double perMessage = 2e-6, perByte = 0;
  // Seconds of the master's thread: ZeroMQ's calls per message received and sent, copying per byte,
  // and handing a result to another thread.
  double receive = 2.5e-6, send = 1e-6, copy = 5e-10, handOver = 5e-7;
  // Threads of the master that unpack and merge results; 0: the master's thread does it.
  uint32_t mergers = 4;
  double prepare = 0;     // seconds to prepare a scene
  double noise = 0;       // change of a job's cost from frame to frame: sigma of its logarithm
  double slow = 0;        // fraction of workers that are four times slower
  bool ideal = false;     // the master takes no time, so only the schedule costs efficiency
  bool pipelined = false; // the next frame starts together with the current one
  std::string costs;
  SchedulerOptions schedule;
};

// Returns the seconds that one reading of the thread's clock takes. It is a system call, which the
// real master does not make.
inline double costOfClock() {
  std::vector<double> times;
  for (int i = 0; i < 10001; i++) times.push_back(threadSeconds());
  for (size_t i = 0; i + 1 < times.size(); i++) times[i] = times[i + 1] - times[i];
  times.pop_back();
  std::nth_element(times.begin(), times.begin() + 5000, times.end());
  return times[5000];
}

// Wide because its functions are those of a whole cluster: the network, the workers and the clock.
class Simulation {
 public:
  Simulation(const Options& o, const CostMap& costs, uint32_t workers)
      : o_(o), settings_(settingsOf(o)), grid_(settings_), results_(settings_), workers_(workers) {
    for (uint32_t i = 0; i < grid_.count(); i++)
      cost_.push_back(costs.of(grid_.at(i), o.width, o.height));
    double sum = 0;
    for (uint32_t i = 0; i < grid_.count(); i++) sum += cost_[i] * double(grid_.at(i).pixels());
    for (double& c : cost_) c *= o.work / sum / o.samples; // seconds per sample of a pixel
    MasterOptions options;
    options.schedule = o.schedule;
    options.self = hello();
    if (o.mergers > 0)
      options.results = [this](std::function<void()> heavy, MasterOptions::Then then) {
        paused_ -= o_.handOver;
        events_.at(clock(), [this, heavy = std::move(heavy), then = std::move(then)] {
          merging_.push_back({heavy, then});
          merge();
        });
      };
    options.close = [](Peer, const std::string& why) {
      throw std::runtime_error("a worker was refused: " + why);
    };
    master_ = std::make_unique<Master>(
        options, [this](Peer peer, Frames&& frames) { return send(peer, std::move(frames)); },
        nullptr);
    for (uint32_t i = 0; i < workers; i++) {
      workers_[i].speed = i < o.slow * workers ? 4 : 1;
      workers_[i].idle.resize(o.threads);
      atMaster([this, i](double now) {
        master_->joined(i + 1, "worker", now);
        master_->message(i + 1, encode(0, hello()), now);
      });
    }
  }

  struct Outcome {
    double frame = 0, efficiency = 0, master = 0, merging = 0, network = 0, socket = 0, in = 0,
           out = 0, jobs = 0, perJob = 0;
    double first = 0;                    // seconds of the first frame, with unknown costs
    double begin = 0, gaps = 0, end = 0; // idle fractions of the workers' time
    uint64_t again = 0;
  };
  Outcome run() {
    // Runs until every worker has joined.
    while (joined_ < workers_.size() || !events_.empty()) events_.step();
    firstCommit_ = events_.now;
    commit();
    if (o_.pipelined) commit(); // keep one frame queued
    Outcome outcome;
    double began = 0;
    while (finished_ < o_.frames && !events_.empty()) {
      const uint32_t before = finished_;
      events_.step();
      if (before == finished_ || finished_ != unmeasured()) continue;
      began = idleFrom_ = lastEnd_;
      outcome.first = ends_.front() - firstCommit_;
      mark_ = counts();
      idleBegin_ = idleGaps_ = idleEnd_ = 0;
    }
    if (finished_ < o_.frames) throw std::runtime_error("the simulation has come to a halt");
    const Counts end = counts();
    const double all = lastEnd_ - began, n = o_.frames - unmeasured();
    double power = 0;
    for (Machine& m : workers_) {
      power += o_.threads / m.speed;
      while (!m.idle.empty()) use(m, lastEnd_);
    }
    outcome.frame = all / n;
    outcome.efficiency = o_.work / power / outcome.frame;
    outcome.begin = idleBegin_ / power / all;
    outcome.gaps = idleGaps_ / power / all;
    outcome.end = idleEnd_ / power / all;
    outcome.master = (end.cpu - mark_.cpu) / all;
    outcome.merging = (end.merging - mark_.merging) / all / std::max(o_.mergers, 1u);
    outcome.network = std::max(end.in - mark_.in, end.out - mark_.out) * 8 / o_.network / all;
    outcome.socket = (end.socket - mark_.socket) / all;
    outcome.in = (end.in - mark_.in) / all;
    outcome.out = (end.out - mark_.out) / all;
    outcome.jobs = double(end.jobs - mark_.jobs) / all;
    outcome.perJob = (end.work - mark_.work) / double(std::max<uint64_t>(end.jobs - mark_.jobs, 1));
    outcome.again = (master_->totals().cluster.reissued - mark_.again) / uint64_t(n);
    return outcome;
  }

 private:
  struct Item { // an entry of a worker's queue
    LeasedJob job;
    Epoch epoch = 0;
    bool scene = false;
  };
  struct Merging {
    std::function<void()> heavy;
    MasterOptions::Then then;
  };
  struct Running {
    Item item;
    double seconds = 0, until = 0;
  };
  struct Machine {
    double speed = 1; // slowdown factor
    uint64_t session = 0;
    bool preparing = false;
    Epoch dropped = 0;
    std::deque<Item> queue;
    std::vector<double> idle;            // for each thread without a job, when it became idle
    std::map<uint64_t, Running> running; // by job number
    Server in, out;                      // its link
  };
  struct Counts {
    double cpu = 0, merging = 0, socket = 0, in = 0, out = 0, work = 0;
    uint64_t jobs = 0, again = 0;
  };
  using Call = std::function<void(double now)>;

  // Returns how many frames are left out of the measurement. The first frame learns the costs. With
  // overlapping frames the next ones profit from its length.
  uint32_t unmeasured() const { return o_.pipelined ? 3 : 1; }

  static edit::FrameSettingsT settingsOf(const Options& o) {
    edit::FrameSettingsT f;
    f.width = o.width;
    f.height = o.height;
    f.samples = o.samples;
    f.depth = 5;
    f.channels = RT_RGBA;
    f.transport = RT_TRANSPORT_PATH;
    f.tile = uint8_t(std::min(o.tile, 128u));
    return f;
  }
  message::Hello hello() const {
    message::Hello h;
    h.library = h.isa = h.kernel = h.platform = "simulated";
    h.threads = o_.threads;
    h.host = "simulated";
    return h;
  }
  Counts counts() const {
    return {masterCpu_, mergingCpu_, socket_.busy, bytesIn_,
            bytesOut_,  work_,       jobs_,        master_->totals().cluster.reissued};
  }

  void commit() {
    const Epoch epoch = ++lastEpoch_;
    auto commit = std::make_shared<Commit>();
    auto edit = std::make_unique<edit::EditT>();
    edit->any.Set(edit::FrameSettingsT(settings_));
    commit->edits.edits.push_back(std::move(edit));
    commit->edits.render = true;
    atMaster([this, epoch, commit](double now) { master_->commit(epoch, commit, true, now); });
  }

  // Queues a call for the master's thread. The thread handles all that has arrived and then issues
  // jobs, as the backend's thread does.
  void atMaster(Call call) {
    inbox_.push_back(std::move(call));
    if (!awake_) wakeMaster(events_.now);
  }
  void wakeMaster(double when) {
    awake_ = true;
    const uint64_t number = ++wakes_;
    events_.at(std::max(when, masterFree_), [this, number] {
      if (number == wakes_) turn();
    });
  }
  void turn() {
    constexpr size_t most = 256; // messages handled before jobs are issued
    turnBegan_ = events_.now;
    turnCpu_ = threadSeconds();
    paused_ = 0;
    for (size_t i = 0; i < most && !inbox_.empty(); i++) {
      const Call call = std::move(inbox_.front());
      inbox_.pop_front();
      call(clock());
    }
    const double next = master_->advance(clock());
    const double took = clock() - turnBegan_;
    masterCpu_ += took;
    masterFree_ = turnBegan_ + took;
    if (!o_.ideal) master_->busy(took);
    look();
    awake_ = false;
    if (!inbox_.empty())
      wakeMaster(masterFree_);
    else if (std::isfinite(next))
      sleep(std::max(next, masterFree_));
  }
  // The threads that merge. The work is done here immediately and takes the simulated thread as
  // long as it took here.
  void merge() {
    while (mergersBusy_ < o_.mergers && !merging_.empty()) {
      const Merging next = std::move(merging_.front());
      merging_.pop_front();
      mergersBusy_++;
      const double began = threadSeconds();
      next.heavy();
      const double took = std::max(0.0, threadSeconds() - began - clockCost_);
      mergingCpu_ += took;
      events_.at(events_.now + (o_.ideal ? 0 : took), [this, then = next.then] {
        mergersBusy_--;
        atMaster(then);
        merge();
      });
    }
  }
  void sleep(double until) {
    const uint64_t number = wakes_;
    events_.at(until, [this, number] {
      if (number == wakes_ && !awake_) wakeMaster(events_.now);
    });
  }
  double clock() {
    paused_ += clockCost_;
    return turnBegan_ + (o_.ideal ? 0 : std::max(0.0, threadSeconds() - turnCpu_ - paused_));
  }
  void look() {
    for (Epoch epoch = oldest_; epoch <= lastEpoch_; epoch++) {
      const Master::FrameState state = master_->frame(epoch);
      if (!state.over) return;
      if (!state.failure.empty()) throw std::runtime_error(state.failure);
      master_->forget(epoch);
      oldest_ = epoch + 1;
      finished_++;
      lastEnd_ = masterFree_;
      ends_.push_back(lastEnd_);
      if (finished_ < o_.frames) commit();
    }
  }

  static size_t sizeOf(const Frames& frames) {
    size_t bytes = 66; // headers of TCP/IP and Ethernet
    for (const auto& f : frames) bytes += f.size() + 9;
    return bytes + bytes / 1460 * 66;
  }
  bool send(Peer peer, Frames&& frames) {
    paused_ -= o_.send;
    const double when = clock(), begin = threadSeconds() - clockCost_;
    const double bytes = double(sizeOf(frames));
    bytesOut_ += bytes;
    const double sent = nicOut_.take(socket_.take(when, o_.perMessage + bytes * o_.perByte),
                                     bytes * 8 / o_.network);
    Machine& m = workers_[peer - 1];
    const double there = m.in.take(sent + o_.latency, bytes * 8 / o_.link);
    events_.at(there, [this, peer, frames = std::make_shared<Frames>(std::move(frames))] {
      arrived(peer - 1, std::move(*frames));
    });
    paused_ += threadSeconds() - begin;
    return true;
  }
  // Sends a worker's message: through its link, the network, the master's network card and the
  // master's socket thread.
  void toMaster(uint32_t w, size_t bytes, Call call) {
    const double size = double(bytes), left = workers_[w].out.take(events_.now, size * 8 / o_.link);
    events_.at(left + o_.latency, [this, size, call = std::move(call)] {
      const double here = nicIn_.take(events_.now, size * 8 / o_.network);
      bytesIn_ += size;
      events_.at(socket_.take(here, o_.perMessage + size * o_.perByte),
                 [this, call] { atMaster(call); });
    });
  }

  void arrived(uint32_t w, Frames&& frames) {
    Machine& m = workers_[w];
    Message message;
    if (const std::string wrong = decode(std::move(frames), message); !wrong.empty())
      throw std::runtime_error(wrong);
    if (const auto* welcome = std::get_if<message::Welcome>(&message.body)) {
      m.session = welcome->session;
      joined_++;
    }
    if (const auto* scene = std::get_if<message::Scene>(&message.body)) {
      reply(w, message::Need{.epoch = scene->epoch});
      if (scene->prepare) m.queue.push_back({{}, scene->epoch, true});
    }
    if (const auto* prepare = std::get_if<message::Prepare>(&message.body))
      m.queue.push_back({{}, prepare->epoch, true});
    if (const auto* jobs = std::get_if<message::Jobs>(&message.body))
      for (const LeasedJob& job : jobs->jobs) m.queue.push_back({job, jobs->epoch, false});
    if (const auto* drop = std::get_if<message::Drop>(&message.body)) {
      m.dropped = std::max(m.dropped, drop->epoch);
      std::erase_if(m.queue,
                    [&](const Item& item) { return !item.scene && item.epoch <= drop->epoch; });
      for (const auto& [number, running] : m.running)
        if (running.item.epoch <= drop->epoch) abandonJob(w, number, running);
    }
    begin(w);
  }
  void reply(uint32_t w, message::Body&& body) {
    auto frames = std::make_shared<Frames>(encode(workers_[w].session, std::move(body)));
    toMaster(w, sizeOf(*frames), [this, w, frames](double now) {
      paused_ -= o_.receive;
      master_->message(w + 1, std::move(*frames), now);
    });
  }
  void begin(uint32_t w) {
    Machine& m = workers_[w];
    while (!m.preparing && !m.queue.empty()) {
      if (m.queue.front().scene ? !m.running.empty() : m.idle.empty()) return;
      const Item item = m.queue.front();
      m.queue.pop_front();
      if (item.scene) {
        m.preparing = true;
        events_.at(events_.now + o_.prepare * m.speed, [this, w, item] {
          workers_[w].preparing = false;
          message::Ready ready;
          ready.epoch = item.epoch;
          ready.facts.camera = true;
          ready.transport = RT_TRANSPORT_PATH;
          reply(w, std::move(ready));
          begin(w);
        });
        return;
      }
      use(m, events_.now);
      const openrt::Job& job = item.job.job;
      const double differs =
          o_.noise > 0 ? std::exp(o_.noise * normal_(random_) - o_.noise * o_.noise / 2) : 1;
      const double seconds =
          cost_[job.number] * double(grid_.at(job.number).pixels()) * job.count * m.speed * differs;
      const uint64_t number = ++lastRunning_;
      m.running[number] = {item, seconds, events_.now + seconds};
      events_.at(events_.now + seconds, [this, w, number] { finished(w, number); });
    }
  }
  // An idle thread gets work. If a frame ended in between, the idle time before that belongs to the
  // end of the frame and the time after it to the start of the next.
  void use(Machine& m, double now) {
    const double since = std::max(m.idle.back(), idleFrom_);
    m.idle.pop_back();
    if (now <= since) return;
    const auto end = std::lower_bound(ends_.begin(), ends_.end(), since);
    if (end == ends_.end() || *end > now) {
      idleGaps_ += (now - since) / m.speed;
    } else {
      idleEnd_ += (*end - since) / m.speed;
      idleBegin_ += (now - *end) / m.speed;
    }
  }
  // Abandons a job that is no longer needed. A worker's thread checks for this after each bounce; a
  // wave is a leaf of samples.
  void abandonJob(uint32_t w, uint64_t number, const Running& running) {
    constexpr double leaf = 32, bounces = 4;
    const double until =
        events_.now + running.seconds / running.item.job.job.count * leaf / bounces;
    if (until >= running.until) return;
    events_.at(until, [this, w, number] { finished(w, number); });
  }
  void finished(uint32_t w, uint64_t number) {
    Machine& m = workers_[w];
    const auto found = m.running.find(number);
    if (found == m.running.end()) return; // it was abandoned
    const Item item = found->second.item;
    const double seconds = found->second.seconds;
    m.running.erase(found);
    m.idle.push_back(events_.now);
    if (item.epoch > m.dropped) {
      jobs_++;
      work_ += seconds;
      const size_t pixels = grid_.at(item.job.job.number).pixels();
      // Results are built when the master reads them, to keep less in memory.
      size_t& bytes = resultBytes_[{pixels, item.job.job.count}];
      if (bytes == 0)
        bytes = sizeOf(results_.make(m.session, item.epoch, item.job, pixels, seconds));
      toMaster(w, bytes, [this, w, item, pixels, seconds](double now) {
        const double began = threadSeconds() - clockCost_;
        Frames frames = results_.make(workers_[w].session, item.epoch, item.job, pixels, seconds);
        paused_ += threadSeconds() - began; // excluded from every measured time
        paused_ -= o_.receive + double(sizeOf(frames)) * o_.copy;
        master_->message(w + 1, std::move(frames), now);
      });
    }
    begin(w);
  }

  const Options& o_;
  const edit::FrameSettingsT settings_;
  const TileGrid grid_;
  Results results_;
  std::vector<double> cost_; // seconds per sample of a pixel, by tile
  std::unique_ptr<Master> master_;
  std::vector<Machine> workers_;
  Events events_;
  std::deque<Call> inbox_;
  Server nicIn_, nicOut_, socket_;
  bool awake_ = false;
  uint64_t wakes_ = 0, jobs_ = 0;
  double masterFree_ = 0, masterCpu_ = 0, turnBegan_ = 0, turnCpu_ = 0, paused_ = 0, bytesIn_ = 0,
         bytesOut_ = 0, work_ = 0;
  uint32_t joined_ = 0, finished_ = 0;
  Epoch lastEpoch_ = 0, oldest_ = 1;
  double lastEnd_ = 0;
  std::vector<double> ends_; // when each frame ended
  double firstCommit_ = 0;
  std::deque<Merging> merging_;
  uint32_t mergersBusy_ = 0;
  double mergingCpu_ = 0;
  const double clockCost_ = costOfClock();
  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
  double idleFrom_ = 0, idleBegin_ = 0, idleGaps_ = 0, idleEnd_ = 0;
  uint64_t lastRunning_ = 0;
  std::map<std::pair<size_t, uint32_t>, size_t> resultBytes_;
  Counts mark_;
};

} // namespace sim
