// xvrml_events.cpp: events per second through 100,000 routes: in a chain, from one node to all,
// from all to one, and in a chain through prototype instances. An item is an event delivered.
// Target: 5 million per second in chains (docs/benchmarks.md).
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "xvrml/browser.h"

namespace {

using namespace xvrml;

constexpr int routes = 100'000;

struct Bench {
  explicit Bench(const std::string& vrml)
      : browser(loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, "bench.wrl"),
                BrowserOptions{.maximumEvents = 10'000'000}) {}
  // Sends one event into node `first` per iteration; perIteration deliveries follow.
  void run(benchmark::State& state, std::string_view first, std::string_view field,
           int64_t perIteration) {
    const NodeRef node = browser.node(first);
    float value = 0;
    for (auto _ : state) {
      value = value == 0 ? 0.5f : 0;
      browser.set(*node, field, value);
      browser.takeChanges();
    }
    state.SetItemsProcessed(state.iterations() * perIteration);
  }
  Browser browser;
};

// Lights have SFFloat exposedFields, which forward the values they are set to.
std::string lights(int count) {
  std::string out;
  for (int i = 0; i <= count; ++i) out += fmt::format("DEF M{} PointLight {{ }}\n", i);
  return out;
}

void chain(benchmark::State& state) {
  std::string world = lights(routes);
  for (int i = 0; i < routes; ++i)
    world += fmt::format("ROUTE M{}.intensity TO M{}.intensity\n", i, i + 1);
  Bench(world).run(state, "M0", "intensity", routes + 1);
}

void fanOut(benchmark::State& state) {
  std::string world = lights(routes);
  for (int i = 0; i < routes; ++i)
    world += fmt::format("ROUTE M{}.intensity TO M{}.intensity\n", routes, i);
  Bench(world).run(state, fmt::format("M{}", routes), "intensity", routes + 1);
}

// From one node to all and from all to one: the last node gets an event of each.
void fanIn(benchmark::State& state) {
  std::string world = lights(routes / 2 + 1);
  const int last = routes / 2 + 1, source = routes / 2;
  for (int i = 0; i < source; ++i)
    world +=
        fmt::format("ROUTE M{}.intensity TO M{}.intensity ROUTE M{}.intensity TO M{}.intensity\n",
                    source, i, i, last);
  Bench(world).run(state, fmt::format("M{}", source), "intensity", routes + 1);
}

// Each step is an instance: into its body, to a light in it, and out.
void prototypes(benchmark::State& state) {
  constexpr int instances = routes / 4;
  std::string world = "PROTO P [ exposedField SFFloat x 1 ] { PointLight { intensity IS x } }\n";
  for (int i = 0; i <= instances; ++i) world += fmt::format("DEF M{} P {{ }}\n", i);
  for (int i = 0; i < instances; ++i) world += fmt::format("ROUTE M{}.x TO M{}.x\n", i, i + 1);
  Bench(world).run(state, "M0", "x", 2 * (instances + 1));
}

void interpolators(benchmark::State& state) {
  constexpr int count = routes / 10;
  std::string world;
  for (int i = 0; i <= count; ++i)
    world += fmt::format("DEF M{} ScalarInterpolator {{ key [ 0 1 ] keyValue [ 0 1 ] }}\n", i);
  for (int i = 0; i < count; ++i)
    world += fmt::format("ROUTE M{}.value_changed TO M{}.set_fraction\n", i, i + 1);
  Bench(world).run(state, "M0", "set_fraction", count + 1);
}

// Ticks of 10,000 running TimeSensors, each with one route.
void timeSensors(benchmark::State& state) {
  constexpr int count = 10'000;
  std::string world;
  for (int i = 0; i < count; ++i)
    world += fmt::format("DEF T{} TimeSensor {{ loop TRUE }} DEF L{} PointLight {{ }} ROUTE "
                         "T{}.fraction_changed TO L{}.intensity\n",
                         i, i, i, i);
  Bench bench(world);
  double time = 1;
  for (auto _ : state) {
    bench.browser.tick(time += 1.0 / 64);
    bench.browser.takeChanges();
  }
  state.SetItemsProcessed(state.iterations() * count);
}

BENCHMARK(chain)->Name("events/chain")->Unit(benchmark::kMillisecond);
BENCHMARK(fanOut)->Name("events/fanOut")->Unit(benchmark::kMillisecond);
BENCHMARK(fanIn)->Name("events/fanIn")->Unit(benchmark::kMillisecond);
BENCHMARK(prototypes)->Name("events/prototypes")->Unit(benchmark::kMillisecond);
BENCHMARK(interpolators)->Name("events/interpolators")->Unit(benchmark::kMillisecond);
BENCHMARK(timeSensors)->Name("events/timeSensors")->Unit(benchmark::kMillisecond);

} // namespace
