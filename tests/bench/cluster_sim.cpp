// cluster_sim.cpp: bench_cluster_sim drives the real master (scheduler, protocol, decoding,
// merging) with up to 4,096 workers that only sleep, over modelled links. It prints the time per
// frame and what limits it (docs/cluster-scaling.md). The time of the network and the workers is
// virtual. The master's time is measured on one thread and added to the virtual clock.
#include <cstdlib>
#include <map>

#include "bench/cluster_simulation.h"

namespace {

using namespace sim;

std::string limitOf(const Simulation::Outcome& o) {
  const std::pair<double, const char*> used[] = {{o.master, "master's thread"},
                                                 {o.merging, "merging"},
                                                 {o.network, "network"},
                                                 {o.socket, "socket thread"}};
  const auto most = *std::max_element(std::begin(used), std::end(used));
  if (o.efficiency >= 0.95) return "workers";
  if (most.first >= 0.8) return most.second;
  return o.end > o.gaps ? "end of frame" : std::string("bursts, ") + most.second;
}

// Prints fractions of the workers' time: useful work (efficiency), waiting at a frame's start,
// during it and at its end, and wasted work.
void print(const Options& o) {
  const CostMap costs = o.costs.empty() ? CostMap() : CostMap(o.costs);
  std::printf(
      "%ux%u, %u samples, %s, %g s of one thread a frame; workers of %u threads; master %g Gbit/s, "
      "links %g Gbit/s, %g ms; %s\n",
      o.width, o.height, o.samples,
      o.tile ? ("tiles of " + std::to_string(o.tile) + " pixels").c_str() : "ordinary tiles",
      o.work, o.threads, o.network * 1e-9, o.link * 1e-9, o.latency * 1e3,
      o.ideal ? "the master takes no time"
              : ("the master's time is measured, " + std::to_string(o.mergers) + " threads merge")
                    .c_str());
  std::printf("| workers | first (ms) | frame (ms) | efficiency | begin | gaps | end | vain | "
              "jobs/s | mean job (ms) | again | in (MB/s) | out (MB/s) | master | merging | "
              "network | socket | limit |\n|");
  for (int i = 0; i < 17; i++) std::printf(" ---: |");
  std::printf(" --- |\n");
  for (const uint32_t n : o.workers) {
    Simulation simulation(o, costs, n);
    const Simulation::Outcome r = simulation.run();
    std::printf("| %u | %.1f | %.1f | %.1f %% | %.1f %% | %.1f %% | %.1f %% | %.1f %% |", n,
                r.first * 1e3, r.frame * 1e3, r.efficiency * 100, r.begin * 100, r.gaps * 100,
                r.end * 100, (1 - r.efficiency - r.begin - r.gaps - r.end) * 100);
    std::printf(
        " %.0f | %.2f | %llu | %.1f | %.2f | %.0f %% | %.0f %% | %.0f %% | %.0f %% | %s |\n",
        r.jobs, r.perJob * 1e3, static_cast<unsigned long long>(r.again), r.in * 1e-6, r.out * 1e-6,
        r.master * 100, r.merging * 100, r.network * 100, r.socket * 100, limitOf(r).c_str());
    std::fflush(stdout);
  }
}

constexpr const char* usage = R"(bench_cluster_sim [OPTION=VALUE]...
  workers=1,2,4...  threads=16  size=1920x1080  samples=1024  tile=0  frames=3 (the first is not counted; overlapping: three)
  work=2048 (seconds of one thread a frame)  network=10e9  link=10e9 (bits/s)  latency=50e-6 (one way)
  per-message=2e-6  per-byte=0 (seconds of the socket thread)
  receive=2.5e-6  send=1e-6  copy=5e-10  hand-over=5e-7 (seconds of the master's thread: a message, a byte, a result)
  mergers=4 (threads that merge results)
  prepare=0 (seconds a scene)  noise=0 (by which costs differ from the frame before)
  slow=0 (share of workers, 4 times slower)
  in-flight=3  shortest=0.002 (of the scheduler)
  split=auto|tiles|samples|frames  ideal=0|1 (the master takes no time)  pipelined=0|1  costs=FILE (width, height, cells)
)";

bool set(Options& o, const std::string& name, const std::string& value) {
  const std::map<std::string, std::function<void()>> table = {
      {"workers",
       [&] {
         o.workers.clear();
         for (size_t at = 0; at < value.size();
              at = value.find(',', at) == value.npos ? value.size() : value.find(',', at) + 1)
           o.workers.push_back(uint32_t(std::strtoul(value.c_str() + at, nullptr, 10)));
       }},
      {"threads", [&] { o.threads = uint32_t(std::stoul(value)); }},
      {"size", [&] { std::sscanf(value.c_str(), "%ux%u", &o.width, &o.height); }},
      {"samples", [&] { o.samples = uint32_t(std::stoul(value)); }},
      {"tile", [&] { o.tile = uint32_t(std::stoul(value)); }},
      {"frames", [&] { o.frames = uint32_t(std::stoul(value)); }},
      {"work", [&] { o.work = std::stod(value); }},
      {"network", [&] { o.network = std::stod(value); }},
      {"link", [&] { o.link = std::stod(value); }},
      {"latency", [&] { o.latency = std::stod(value); }},
      {"per-message", [&] { o.perMessage = std::stod(value); }},
      {"per-byte", [&] { o.perByte = std::stod(value); }},
      {"receive", [&] { o.receive = std::stod(value); }},
      {"send", [&] { o.send = std::stod(value); }},
      {"copy", [&] { o.copy = std::stod(value); }},
      {"hand-over", [&] { o.handOver = std::stod(value); }},
      {"mergers", [&] { o.mergers = uint32_t(std::stoul(value)); }},
      {"noise", [&] { o.noise = std::stod(value); }},
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
      if (equals == argument.npos ||
          !set(options, argument.substr(0, equals), argument.substr(equals + 1))) {
        std::fputs(usage, stderr);
        return 2;
      }
    }
    options.frames = std::max(options.frames, options.pipelined ? 8u : 2u);
    print(options);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_cluster_sim: %s\n", e.what());
    return 1;
  }
}
