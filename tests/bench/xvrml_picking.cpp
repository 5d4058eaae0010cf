// xvrml_picking.cpp: the cost of a pointer motion: a ray among 10,000 shapes of one group, among
// 10,000 in a tree of groups, and into one mesh of half a million triangles; and a ray after one of
// the shapes has moved.
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "xvrml/browser.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> load(const std::string& vrml) {
  return loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, "bench.wrl");
}

std::string shapeAt(int x, int y) {
  return fmt::format(
      "DEF T{}_{} Transform {{ translation {} {} 0 children Shape {{ geometry Box {{ }} }} }}\n", x,
      y, 3 * x, 3 * y);
}

void shoot(Browser& browser, benchmark::State& state, bool moves) {
  const double direction[3] = {0, 0, -1};
  const NodeRef moved = browser.node("T50_50");
  const double first[3] = {0, 0, 10};
  PickHit warm;
  browser.pick(first, direction, {}, warm); // builds boxes and meshes once
  int i = 0, hits = 0;
  for (auto _ : state) {
    ++i;
    if (moves) browser.set(*moved, "translation", Vec3f{150, 150, float(i % 2)});
    const double origin[3] = {3.0 * (i * 37 % 100), 3.0 * (i * 61 % 100), 10};
    PickHit hit;
    hits += browser.pick(origin, direction, {}, hit);
    if (moves) browser.takeChanges();
  }
  if (hits != i) state.SkipWithError("a ray has missed");
}

void flat(benchmark::State& state) {
  std::string world;
  for (int i = 0; i < 10'000; ++i) world += shapeAt(i / 100, i % 100);
  Browser browser(load(world));
  shoot(browser, state, false);
}

std::string tree() {
  std::string world;
  for (int x = 0; x < 100; x += 10)
    for (int y = 0; y < 100; y += 10) {
      world += "Group { children [\n";
      for (int i = 0; i < 100; ++i) world += shapeAt(x + i / 10, y + i % 10);
      world += "] }\n";
    }
  return world;
}

void grouped(benchmark::State& state) {
  Browser browser(load(tree()));
  shoot(browser, state, false);
}

void moving(benchmark::State& state) {
  Browser browser(load(tree()));
  shoot(browser, state, true);
}

void mesh(benchmark::State& state) {
  std::string heights;
  for (int i = 0; i < 500 * 500; ++i) heights += i % 3 ? "0 " : "1 ";
  Browser browser(
      load("Transform { rotation 1 0 0 1.5707963 translation 0 300 0 children Shape { geometry "
           "ElevationGrid { xDimension 500 zDimension 500 solid FALSE height [ " +
           heights + "] } } }"));
  shoot(browser, state, false);
}

BENCHMARK(flat)->Name("pick/10000 shapes in one group")->Unit(benchmark::kMicrosecond);
BENCHMARK(grouped)->Name("pick/10000 shapes in 100 groups")->Unit(benchmark::kMicrosecond);
BENCHMARK(moving)->Name("pick/after one of 10000 moved")->Unit(benchmark::kMicrosecond);
BENCHMARK(mesh)->Name("pick/one mesh of 498002 triangles")->Unit(benchmark::kMicrosecond);

} // namespace
