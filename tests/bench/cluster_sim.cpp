// cluster_sim.cpp: bench_cluster_sim drives the real master (scheduler, protocol, decoding, merging) with up to 4,096 workers
// that only sleep, over modelled links, and prints how long a frame takes and what limits it (docs/cluster-scaling.md). The
// network's and the workers' time is virtual; the master's own is what it takes here, on one thread, and is added to the virtual
// clock.
#include <time.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <set>

#include "backend/cluster/master.h"
#include "bench/cluster_model.h"

namespace {

using namespace sim;

struct Options {
  std::vector<uint32_t> workers{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
  uint32_t threads = 16, width = 1920, height = 1080, samples = 1024, tile = 0, frames = 3;
  double work = 2048;                    // seconds of one thread for a frame
  double network = 10e9;                 // bits a second, of the master
  double link = 10e9;                    // of a worker
  double latency = 50e-6;                // seconds, one way
  double perMessage = 2e-6, perByte = 0; // seconds that the master's socket thread takes (--curve: encrypting, too)
  double prepare = 0;                    // seconds for a scene
  double slow = 0;                       // share of workers that are four times slower
  bool ideal = false;                    // the master takes no time: what is lost is the schedule's
  bool pipelined = false;                // the next frame is begun with the last
  std::string costs;
  SchedulerOptions schedule;
};

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
}

class Simulation {
 public:
  Simulation(const Options& o, const CostMap& costs, uint32_t workers)
      : o_(o), settings_(settingsOf(o)), grid_(settings_), results_(settings_), workers_(workers) {
    for (uint32_t i = 0; i < grid_.count(); i++) cost_.push_back(costs.of(grid_.at(i), o.width, o.height));
    double sum = 0;
    for (uint32_t i = 0; i < grid_.count(); i++) sum += cost_[i] * double(grid_.at(i).pixels());
    for (double& c : cost_) c *= o.work / sum / o.samples; // seconds of a pixel's sample
    MasterOptions options;
    options.schedule = o.schedule;
    options.self = hello();
    options.close = [](Peer, const std::string& why) { throw std::runtime_error("a worker was refused: " + why); };
    master_ = std::make_unique<Master>(
        options, [this](Peer peer, Frames&& frames) { return send(peer, std::move(frames)); }, nullptr);
    for (uint32_t i = 0; i < workers; i++) {
      workers_[i].speed = i < o.slow * workers ? 4 : 1;
      atMaster([this, i](double now) {
        master_->joined(i + 1, "worker", now);
        master_->message(i + 1, encode(0, hello()), now);
      });
    }
  }

  struct Outcome {
    double frame = 0, efficiency = 0, master = 0, network = 0, socket = 0, in = 0, out = 0, jobs = 0, perJob = 0;
    uint64_t again = 0;
  };
  Outcome run() {
    while (joined_ < workers_.size() || !events_.empty()) events_.step(); // all are there
    commit();
    if (o_.pipelined) commit();
    Outcome outcome;
    double began = 0;
    while (finished_ < o_.frames && !events_.empty()) {
      const uint32_t before = finished_;
      events_.step();
      if (before == finished_ || finished_ != 1) continue; // the first frame finds out what it costs
      began = lastEnd_;
      mark_ = counts();
    }
    if (finished_ < o_.frames) throw std::runtime_error("the simulation has come to a halt");
    const Counts end = counts();
    const double all = lastEnd_ - began, n = o_.frames - 1;
    double power = 0;
    for (const Machine& m : workers_) power += o_.threads / m.speed;
    outcome.frame = all / n;
    outcome.efficiency = o_.work / power / outcome.frame;
    outcome.master = (end.cpu - mark_.cpu) / all;
    outcome.network = std::max(end.in - mark_.in, end.out - mark_.out) * 8 / o_.network / all;
    outcome.socket = (end.socket - mark_.socket) / all;
    outcome.in = (end.in - mark_.in) / all, outcome.out = (end.out - mark_.out) / all;
    outcome.jobs = double(end.jobs - mark_.jobs) / all;
    outcome.perJob = (end.work - mark_.work) / double(std::max<uint64_t>(end.jobs - mark_.jobs, 1));
    outcome.again = (master_->totals().reissued - mark_.again) / uint64_t(n);
    return outcome;
  }

 private:
  struct Item { // of a worker's queue
    LeasedJob job;
    Epoch epoch = 0;
    bool scene = false;
  };
  struct Machine {
    double speed = 1; // times slower
    uint64_t session = 0;
    uint32_t running = 0;
    bool preparing = false;
    Epoch dropped = 0;
    std::deque<Item> queue;
    Server in, out; // its link
  };
  struct Counts {
    double cpu = 0, socket = 0, in = 0, out = 0, work = 0;
    uint64_t jobs = 0, again = 0;
  };
  using Call = std::function<void(double now)>;

  static edit::FrameSettingsT settingsOf(const Options& o) {
    edit::FrameSettingsT f;
    f.width = o.width, f.height = o.height, f.samples = o.samples, f.depth = 5;
    f.channels = RT_RGBA, f.transport = RT_TRANSPORT_PATH;
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
  Counts counts() const { return {masterCpu_, socket_.busy, bytesIn_, bytesOut_, work_, jobs_, master_->totals().reissued}; }

  void commit() {
    const Epoch epoch = ++lastEpoch_;
    auto commit = std::make_shared<Commit>();
    auto edit = std::make_unique<edit::EditT>();
    edit->any.Set(edit::FrameSettingsT(settings_));
    commit->edits.edits.push_back(std::move(edit));
    commit->edits.render = true;
    atMaster([this, epoch, commit](double now) { master_->commit(epoch, commit, true, now); });
  }

  // The master's thread: calls wait for it; it takes what has come, and then hands out, as the backend's thread does.
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
    constexpr size_t most = 256; // messages before anything is handed out
    turnBegan_ = events_.now, turnCpu_ = cpuSeconds(), paused_ = 0;
    for (size_t i = 0; i < most && !inbox_.empty(); i++) {
      const Call call = std::move(inbox_.front());
      inbox_.pop_front();
      call(clock());
    }
    const double next = master_->advance(clock());
    const double took = clock() - turnBegan_;
    masterCpu_ += took, masterFree_ = turnBegan_ + took;
    look();
    awake_ = false;
    if (!inbox_.empty())
      wakeMaster(masterFree_);
    else if (std::isfinite(next))
      sleep(std::max(next, masterFree_));
  }
  void sleep(double until) {
    const uint64_t number = wakes_;
    events_.at(until, [this, number] {
      if (number == wakes_ && !awake_) wakeMaster(events_.now);
    });
  }
  double clock() const { return turnBegan_ + (o_.ideal ? 0 : cpuSeconds() - turnCpu_ - paused_); }
  void look() {
    for (Epoch epoch = oldest_; epoch <= lastEpoch_; epoch++) {
      const Master::FrameState state = master_->frame(epoch);
      if (!state.over) return;
      if (!state.failure.empty()) throw std::runtime_error(state.failure);
      master_->forget(epoch);
      oldest_ = epoch + 1, finished_++, lastEnd_ = masterFree_;
      if (lastEpoch_ < o_.frames) commit();
    }
  }

  static size_t sizeOf(const Frames& frames) {
    size_t bytes = 66; // of TCP/IP and Ethernet
    for (const auto& f : frames) bytes += f.size() + 9;
    return bytes + bytes / 1460 * 66;
  }
  bool send(Peer peer, Frames&& frames) {
    const double when = clock(), begin = cpuSeconds();
    const double bytes = double(sizeOf(frames));
    bytesOut_ += bytes;
    const double sent = nicOut_.take(socket_.take(when, o_.perMessage + bytes * o_.perByte), bytes * 8 / o_.network);
    Machine& m = workers_[peer - 1];
    const double there = m.in.take(sent + o_.latency, bytes * 8 / o_.link);
    events_.at(there,
               [this, peer, frames = std::make_shared<Frames>(std::move(frames))] { arrived(peer - 1, std::move(*frames)); });
    paused_ += cpuSeconds() - begin;
    return true;
  }
  // A worker's message: its link, the way, the master's network card, its socket thread.
  void toMaster(uint32_t w, size_t bytes, Call call) {
    const double size = double(bytes), left = workers_[w].out.take(events_.now, size * 8 / o_.link);
    events_.at(left + o_.latency, [this, size, call = std::move(call)] {
      const double here = nicIn_.take(events_.now, size * 8 / o_.network);
      bytesIn_ += size;
      events_.at(socket_.take(here, o_.perMessage + size * o_.perByte), [this, call] { atMaster(call); });
    });
  }

  void arrived(uint32_t w, Frames&& frames) {
    Machine& m = workers_[w];
    Message message;
    if (const std::string wrong = decode(std::move(frames), message); !wrong.empty()) throw std::runtime_error(wrong);
    if (const auto* welcome = std::get_if<message::Welcome>(&message.body)) m.session = welcome->session, joined_++;
    if (const auto* scene = std::get_if<message::Scene>(&message.body)) {
      reply(w, message::Need{scene->epoch, {}});
      if (scene->prepare) m.queue.push_back({{}, scene->epoch, true});
    }
    if (const auto* prepare = std::get_if<message::Prepare>(&message.body)) m.queue.push_back({{}, prepare->epoch, true});
    if (const auto* jobs = std::get_if<message::Jobs>(&message.body))
      for (const LeasedJob& job : jobs->jobs) m.queue.push_back({job, jobs->epoch, false});
    if (const auto* drop = std::get_if<message::Drop>(&message.body)) {
      m.dropped = std::max(m.dropped, drop->epoch);
      std::erase_if(m.queue, [&](const Item& item) { return !item.scene && item.epoch <= drop->epoch; });
    }
    begin(w);
  }
  void reply(uint32_t w, message::Body&& body) {
    auto frames = std::make_shared<Frames>(encode(workers_[w].session, std::move(body)));
    toMaster(w, sizeOf(*frames), [this, w, frames](double now) { master_->message(w + 1, std::move(*frames), now); });
  }
  void begin(uint32_t w) {
    Machine& m = workers_[w];
    while (!m.preparing && !m.queue.empty()) {
      if (m.queue.front().scene ? m.running > 0 : m.running == o_.threads) return;
      const Item item = m.queue.front();
      m.queue.pop_front();
      if (item.scene) {
        m.preparing = true;
        events_.at(events_.now + o_.prepare * m.speed, [this, w, item] {
          workers_[w].preparing = false;
          message::Ready ready;
          ready.epoch = item.epoch, ready.facts.camera = true, ready.transport = RT_TRANSPORT_PATH;
          reply(w, std::move(ready));
          begin(w);
        });
        return;
      }
      m.running++;
      const openrt::Job& job = item.job.job;
      const double pixels = double(grid_.at(job.number).pixels());
      const double seconds = cost_[job.number] * pixels * job.count * m.speed;
      work_ += seconds;
      events_.at(events_.now + seconds, [this, w, item, seconds] { finished(w, item, seconds); });
    }
  }
  void finished(uint32_t w, const Item& item, double seconds) {
    Machine& m = workers_[w];
    m.running--, jobs_++;
    if (item.epoch > m.dropped) {
      const size_t pixels = grid_.at(item.job.job.number).pixels();
      size_t& bytes = resultBytes_[{pixels, item.job.job.count}]; // what is in it is made when it is looked at: less is kept
      if (bytes == 0) bytes = sizeOf(results_.make(m.session, item.epoch, item.job, pixels, seconds));
      toMaster(w, bytes, [this, w, item, pixels, seconds](double now) {
        const double began = cpuSeconds();
        Frames frames = results_.make(workers_[w].session, item.epoch, item.job, pixels, seconds);
        paused_ += cpuSeconds() - began; // nobody's time
        master_->message(w + 1, std::move(frames), now);
      });
    }
    begin(w);
  }

  const Options& o_;
  const edit::FrameSettingsT settings_;
  const TileGrid grid_;
  Results results_;
  std::vector<double> cost_; // by tile: seconds of a pixel's sample
  std::unique_ptr<Master> master_;
  std::vector<Machine> workers_;
  Events events_;
  std::deque<Call> inbox_;
  Server nicIn_, nicOut_, socket_;
  bool awake_ = false;
  uint64_t wakes_ = 0, jobs_ = 0;
  double masterFree_ = 0, masterCpu_ = 0, turnBegan_ = 0, turnCpu_ = 0, paused_ = 0, bytesIn_ = 0, bytesOut_ = 0, work_ = 0;
  uint32_t joined_ = 0, finished_ = 0;
  Epoch lastEpoch_ = 0, oldest_ = 1;
  double lastEnd_ = 0;
  std::map<std::pair<size_t, uint32_t>, size_t> resultBytes_;
  Counts mark_;
};

const char* limitOf(const Simulation::Outcome& o) {
  const double most = std::max({o.master, o.network, o.socket});
  if (o.efficiency >= 0.95) return "workers";
  if (most < 0.8) return o.perJob > o.frame / 8 ? "size of jobs" : "end of frame";
  return most == o.master ? "master's thread" : most == o.network ? "network" : "socket thread";
}

void print(const Options& o) {
  const CostMap costs = o.costs.empty() ? CostMap() : CostMap(o.costs);
  std::printf(
      "%ux%u, %u samples, tiles of %u (0: as they are), %g s of one thread a frame; workers of %u threads; master %g Gbit/s, "
      "links %g Gbit/s, %g ms; %s\n",
      o.width, o.height, o.samples, o.tile, o.work, o.threads, o.network * 1e-9, o.link * 1e-9, o.latency * 1e3,
      o.ideal ? "the master takes no time" : "the master's time is measured");
  std::printf("| workers | frame (ms) | efficiency | jobs/s | mean job (ms) | again | in (MB/s) | out (MB/s) | master | network "
              "| socket | limit |\n"
              "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n");
  for (const uint32_t n : o.workers) {
    Simulation simulation(o, costs, n);
    const Simulation::Outcome r = simulation.run();
    std::printf("| %u | %.1f | %.1f %% | %.0f | %.2f | %llu | %.1f | %.2f | %.0f %% | %.0f %% | %.0f %% | %s |\n", n,
                r.frame * 1e3, r.efficiency * 100, r.jobs, r.perJob * 1e3, static_cast<unsigned long long>(r.again), r.in * 1e-6,
                r.out * 1e-6, r.master * 100, r.network * 100, r.socket * 100, limitOf(r));
    std::fflush(stdout);
  }
}

constexpr const char* usage = R"(bench_cluster_sim [OPTION=VALUE]...
  workers=1,2,4...  threads=16  size=1920x1080  samples=1024  tile=0  frames=3 (the first is not counted)
  work=2048 (seconds of one thread a frame)  network=10e9  link=10e9 (bits/s)  latency=50e-6 (one way)
  per-message=2e-6  per-byte=0 (seconds of the socket thread)  prepare=0 (seconds a scene)
  slow=0 (share of workers, 4 times slower)
  in-flight=3  shortest=0.002 (of the scheduler)
  split=auto|tiles|samples|frames  ideal=0|1 (the master takes no time)  pipelined=0|1  costs=FILE (width, height, cells)
)";

bool set(Options& o, const std::string& name, const std::string& value) {
  const std::map<std::string, std::function<void()>> table = {
      {"workers",
       [&] {
         o.workers.clear();
         for (size_t at = 0; at < value.size(); at = value.find(',', at) == value.npos ? value.size() : value.find(',', at) + 1)
           o.workers.push_back(uint32_t(std::strtoul(value.c_str() + at, nullptr, 10)));
       }},
      {"threads", [&] { o.threads = uint32_t(std::stoul(value)); }},
      {"size", [&] { std::sscanf(value.c_str(), "%ux%u", &o.width, &o.height); }},
      {"samples", [&] { o.samples = uint32_t(std::stoul(value)); }},
      {"tile", [&] { o.tile = uint32_t(std::stoul(value)); }},
      {"frames", [&] { o.frames = std::max(2u, uint32_t(std::stoul(value))); }},
      {"work", [&] { o.work = std::stod(value); }},
      {"network", [&] { o.network = std::stod(value); }},
      {"link", [&] { o.link = std::stod(value); }},
      {"latency", [&] { o.latency = std::stod(value); }},
      {"per-message", [&] { o.perMessage = std::stod(value); }},
      {"per-byte", [&] { o.perByte = std::stod(value); }},
      {"prepare", [&] { o.prepare = std::stod(value); }},
      {"slow", [&] { o.slow = std::stod(value); }},
      {"ideal", [&] { o.ideal = value == "1"; }},
      {"pipelined", [&] { o.pipelined = value == "1"; }},
      {"in-flight", [&] { o.schedule.inFlight = uint32_t(std::stoul(value)); }},
      {"shortest", [&] { o.schedule.shortest = std::stod(value); }},
      {"costs", [&] { o.costs = value; }},
      {"split",
       [&] {
         o.schedule.split = value == "tiles"     ? Split::tiles
                            : value == "samples" ? Split::samples
                            : value == "frames"  ? Split::frames
                                                 : Split::automatic;
       }},
  };
  const auto found = table.find(name);
  if (found == table.end()) return false;
  found->second();
  return true;
}

} // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    for (int i = 1; i < argc; i++) {
      const std::string argument = argv[i];
      const size_t equals = argument.find('=');
      if (equals == argument.npos || !set(options, argument.substr(0, equals), argument.substr(equals + 1))) {
        std::fputs(usage, stderr);
        return 2;
      }
    }
    print(options);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_cluster_sim: %s\n", e.what());
    return 1;
  }
}
