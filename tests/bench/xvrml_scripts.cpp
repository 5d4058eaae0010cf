// xvrml_scripts.cpp: the cost of a Script in this process and in a process of its own: an event
// that it answers, further calls to the host, and the start of worlds with many Scripts. The
// programs are those of the test engine. (docs/benchmarks.md)
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "xvrml/browser.h"

namespace {

using namespace xvrml;

BrowserOptions options(bool process) {
  BrowserOptions options;
  options.scriptPath = XVRML_TEST_SCRIPTS;
  options.scriptIsolation =
      process ? BrowserOptions::Isolation::always : BrowserOptions::Isolation::never;
  return options;
}

// One event in, and `reads` reads of a node's field.
void events(benchmark::State& state, bool process, int reads) {
  std::string program = "test:";
  for (int i = 0; i < reads; ++i) program += "in: find to translation\n";
  Browser browser(
      loadWorldFromMemory(
          fmt::format("#VRML V2.0 utf8\nDEF T Transform {{}} DEF S Script {{ field SFNode to USE T "
                      "eventIn SFInt32 in eventOut SFInt32 out url \"{}\" }}",
                      program),
          "bench.wrl"),
      options(process));
  browser.world();
  const NodeRef script = browser.node("S");
  int32_t number = 0;
  for (auto _ : state) browser.set(*script, "in", ++number);
}

void start(benchmark::State& state, bool process) {
  std::string world = "#VRML V2.0 utf8\n";
  for (int64_t i = 0; i < state.range(0); ++i)
    world += "Script { eventIn SFBool in url \"test:initialize: now in\" }\n";
  for (auto _ : state) {
    state.PauseTiming();
    auto loaded = loadWorldFromMemory(world, "bench.wrl");
    state.ResumeTiming();
    const Browser browser(std::move(loaded), options(process));
  }
}

BENCHMARK_CAPTURE(events, here, false, 0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(events, process, true, 0)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK_CAPTURE(events, here_10_findFields_and_logs, false, 10)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(events, process_10_findFields_and_logs, true, 10)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(start, here, false)->Arg(1)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(start, process, true)
    ->Arg(1)
    ->Arg(16)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
