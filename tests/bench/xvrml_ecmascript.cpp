// xvrml_ecmascript.cpp: the ECMAScript engine in the browser's process: events into a trivial
// Script, a Script that reads and writes each of 10,000 points, arrays of numbers, starts, and the
// memory of one interpreter (counter `bytes`). An item is an event, a point, a number or a Script.
// See docs/benchmarks.md.
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <malloc.h>

#include "xvrml/browser.h"

namespace {

using namespace xvrml;

struct Bench {
  explicit Bench(const std::string& vrml)
      : browser(loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, "bench.wrl"),
                BrowserOptions{.scriptPath = XVRML_SCRIPTS,
                               .scriptSeconds = 60,
                               .scriptIsolation = BrowserOptions::Isolation::never}) {}
  // Sends one event into S.in per iteration.
  void run(benchmark::State& state, int64_t items) {
    const NodeRef node = browser.node("S");
    float value = 0;
    for (auto _ : state) {
      browser.set(*node, "go", value += 0.25f);
      browser.takeChanges();
    }
    if (!browser.world().diagnostics.list().empty())
      state.SkipWithError(browser.world().diagnostics.list().front().message.c_str());
    state.SetItemsProcessed(state.iterations() * items);
  }
  Browser browser;
};

std::string script(const std::string& fields, const std::string& program) {
  return fmt::format(
      "DEF S Script {{ directOutput TRUE eventIn SFFloat go {} url \"javascript:{}\" }} ", fields,
      program);
}

void event(benchmark::State& state) {
  Bench(script("eventOut SFFloat out", "function go(v) { out = v }")).run(state, 1);
}
void vectorEvent(benchmark::State& state) {
  Bench(script("eventOut SFVec3f out field SFVec3f at 1 2 3",
               "function go(v) { out = new SFVec3f(at.x, at.y + v, at.z) }"))
      .run(state, 1);
}
void nodeEvent(benchmark::State& state) {
  Bench("DEF T Transform { } " +
        script("field SFNode t USE T",
               "function go(v) { t.translation = t.translation.add(new SFVec3f(v, 0, 0)) }"))
      .run(state, 1);
}

std::string points(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{} 0 {},", i % 100, i / 100);
  return text;
}
constexpr int pointCount = 10'000, numberCount = 100'000;

void mfVec3f(benchmark::State& state) {
  Bench(script(
            "field MFVec3f p [" + points(pointCount) + "] eventOut MFVec3f out",
            "function go(v) { var a = p, o = new MFVec3f(), n = a.length; o.length = n; for (var i "
            "= 0; i < n; i++) { var q = a[i]; o[i] = new SFVec3f(q.x, q.y + v, q.z) } out = o }"))
      .run(state, pointCount);
}
// The slow way: field and eventOut are looked up for each element.
void mfVec3fElements(benchmark::State& state) {
  Bench(script("field MFVec3f p [" + points(pointCount) + "] eventOut MFVec3f out",
               "function go(v) { for (var i = 0; i < p.length; i++) out[i] = new SFVec3f(p[i].x, "
               "p[i].y + v, p[i].z) }"))
      .run(state, pointCount);
}
void nodePoints(benchmark::State& state) {
  Bench("Shape { geometry PointSet { coord DEF C Coordinate { point [" + points(pointCount) +
        "] } } } " +
        script("field SFNode c USE C", "function go(v) { var a = c.point, n = a.length; for (var i "
                                       "= 0; i < n; i++) a[i].y = v; c.point = a }"))
      .run(state, pointCount);
}
void mfFloat(benchmark::State& state) {
  Bench(script(
            "eventOut MFFloat out field MFFloat f []",
            fmt::format(
                "function initialize() {{ f.length = {} }} function go(v) {{ var a = f, n = "
                "a.length, s = 0; for (var i = 0; i < n; i++) {{ s += a[i]; a[i] = s }} out = a }}",
                numberCount)))
      .run(state, numberCount);
}
// A long list arrives and one of its numbers is read.
void tableLookup(benchmark::State& state) {
  Bench(script("eventOut SFFloat out field MFFloat f []",
               fmt::format(
                   "function initialize() {{ f.length = {} }} function go(v) {{ out = f[77] + v }}",
                   numberCount)))
      .run(state, 1);
}
void sums(benchmark::State& state) {
  Bench(
      script("eventOut SFFloat out",
             "function go(v) { var s = 0; for (var i = 0; i < 100000; i++) s += i * v; out = s }"))
      .run(state, 100'000);
}

void starts(benchmark::State& state) {
  const int64_t count = state.range(0);
  std::string world;
  for (int64_t i = 0; i < count; ++i)
    world +=
        fmt::format("Script {{ eventIn SFFloat go url \"javascript:function go(v) {{ }}\" }}\n");
  double bytes = 0;
  for (auto _ : state) {
    const size_t before = mallinfo2().uordblks;
    const Bench bench(world);
    state.PauseTiming();
    bytes = double(mallinfo2().uordblks - before) / double(count);
    state.ResumeTiming();
  }
  state.counters["bytes"] = bytes;
  state.SetItemsProcessed(state.iterations() * count);
}

BENCHMARK(event)->Name("ecmascript/event");
BENCHMARK(vectorEvent)->Name("ecmascript/vectorEvent");
BENCHMARK(nodeEvent)->Name("ecmascript/nodeEvent");
BENCHMARK(mfVec3f)->Name("ecmascript/MFVec3f")->Unit(benchmark::kMillisecond);
BENCHMARK(mfVec3fElements)->Name("ecmascript/MFVec3f_elements")->Unit(benchmark::kMillisecond);
BENCHMARK(nodePoints)->Name("ecmascript/MFVec3f_of_a_node")->Unit(benchmark::kMillisecond);
BENCHMARK(mfFloat)->Name("ecmascript/MFFloat")->Unit(benchmark::kMillisecond);
BENCHMARK(tableLookup)->Name("ecmascript/table");
BENCHMARK(sums)->Name("ecmascript/sums")->Unit(benchmark::kMillisecond);
BENCHMARK(starts)->Name("ecmascript/starts")->Arg(1)->Arg(300)->Unit(benchmark::kMillisecond);

} // namespace
