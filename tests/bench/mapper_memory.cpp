// mapper_memory.cpp: the gain of grouping and instancing. Renders frames of 20,000 small static
// shapes, merged and as one object each. Compares the memory of a forest of 10,000 USEs with that
// of the same forest written out.
#include <chrono>
#include <cmath>
#include <fstream>
#include <malloc.h>
#include <memory>
#include <string>
#include <unistd.h>

#include <benchmark/benchmark.h>

#include "behaviour/viewer/interaction.h"
#include "openrt/openrt.h"
#include "xvrml/mapper.h"

namespace {

using namespace xvrml;

double residentBytes() {
  malloc_trim(0); // releases memory of earlier benchmarks
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * double(sysconf(_SC_PAGESIZE));
}

struct Still {
  RTcontext context;
  std::unique_ptr<World> world;
  // The world runs, so shapes that its routes reach become objects of their own.
  std::unique_ptr<Engine> engine;
  std::unique_ptr<OpenRTMapper> mapper;

  Still(const std::string& body, const char* config, int width, int height)
      : context(rtNewContext(config)) {
    world = loadWorldFromMemory("#VRML V2.0 utf8\n" + body, "still.wrl");
    engine = std::make_unique<Engine>(world->diagnostics, makeInteraction);
    engine->adoptScope(world->scope, true);
    mapper = std::make_unique<OpenRTMapper>(*world, MapOptions());
    mapper->map(mapper->viewpointCamera(0));
    rtFrameBuffer(width, height, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtRender();
  }
  ~Still() {
    mapper.reset();
    engine.reset();
    rtDeleteContext(context);
  }
};

// 20,000 pyramids in a square: merged into one object; each an object of its own (ORTInstance),
// which the backend may merge again; or each moved by a ROUTE, so that the backend may not merge
// them.
enum Grouping { merged, objects, moving };

std::string town(int64_t grouping) {
  std::string body = "Viewpoint { position 0 60 120 orientation 1 0 0 -0.5 }\nPointLight { "
                     "location 0 100 50 radius 1000 }\n"
                     "DEF I PositionInterpolator { }\n";
  std::string routes;
  for (int i = 0; i < 20'000; ++i) {
    const std::string name = "T" + std::to_string(i);
    const double x = i % 141 - 70, z = i / 141 - 70;
    body += "DEF " + name + " Transform { translation " + std::to_string(x) + " 0 " +
            std::to_string(z) + " children " +
            (grouping == objects ? "ORTInstance { children " : "") +
            "Shape { appearance Appearance { material Material { diffuseColor " +
            std::to_string(i % 10 / 10.0) +
            " .5 .5 } } geometry IndexedFaceSet { coord Coordinate { point [ -.4 0 -.4, .4 0 -.4, "
            ".4 0 .4, -.4 0 .4, 0 " +
            std::to_string(0.5 + i % 13 / 6.0) +
            " 0 ] } coordIndex [ 0 4 1 -1 1 4 2 -1 2 4 3 -1 3 4 0 -1 ] } }" +
            (grouping == objects ? " }" : "") + " }\n";
    if (grouping == moving) routes += "ROUTE I.value_changed TO " + name + ".set_scale\n";
  }
  return body + routes;
}

void Town(benchmark::State& state) {
  const double before = residentBytes();
  Still still(town(state.range(0)), "threads=1", 320, 240);
  const double memory = residentBytes() - before;
  for (auto _ : state) rtRender();
  RTstats stats{sizeof(RTstats)};
  rtGetStats(&stats);
  state.counters["render"] = stats.time.render;
  state.counters["MB"] = memory / 1e6;
  state.SetLabel(std::to_string(still.mapper->stats().objects) + " objects");
}
BENCHMARK(Town)
    ->ArgName("grouping")
    ->Arg(merged)
    ->Arg(objects)
    ->Arg(moving)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// A tree of 10,082 triangles, and n USEs of it.
std::string forest(int n) {
  std::string body =
      "Viewpoint { position 0 400 4000 orientation 1 0 0 -0.1 }\nDEF Tree Group { children Shape { "
      "geometry ElevationGrid { xDimension 72 zDimension 72 height [ ";
  for (int i = 0; i < 72 * 72; ++i)
    body += std::to_string(3 + 3 * std::sin(i * 0.37) * std::cos(i % 72 * 0.21)) + " ";
  body += "] } } }\n";
  for (int i = 1; i < n; ++i)
    body += "Transform { translation " + std::to_string(i % 100 * 80 - 4000) + " 0 " +
            std::to_string(-i / 100 * 80) + " children USE Tree }\n";
  return body;
}

// Memory of the whole process beyond its start. For the written-out forest it is the number of
// triangles times the memory per triangle of the first tree.
void Forest(benchmark::State& state) {
  const int n = int(state.range(0));
  const double before = residentBytes();
  Still still(forest(n), "threads=1", 64, 48);
  const double memory = residentBytes() - before;
  for (auto _ : state) rtRender();
  RTstats stats{sizeof(RTstats)};
  rtGetStats(&stats);
  state.counters["MB"] = memory / 1e6;
  state.counters["bvhMB"] = double(stats.bvh.bytes) / 1e6;
  state.counters["triangles"] = double(stats.scene.triangles);
  state.counters["stored"] = double(stats.scene.uniqueTriangles);
}
BENCHMARK(Forest)->Arg(1)->Arg(100)->Arg(10'000)->Unit(benchmark::kMillisecond)->Iterations(3);

enum Written { separate, different, used };

// Returns n small boxes: separate Shapes, of which many are equal; separate Shapes that all differ;
// or one Shape that is used n times.
std::string boxes(int n, int64_t written) {
  std::string body;
  for (int i = 0; i < n; ++i) {
    const std::string green = std::to_string(written == different ? i * 1e-6 : i % 100 / 100.0);
    const std::string size = std::to_string(written == different ? .5 + i * 1e-6 : .5);
    body += "Transform { translation " + std::to_string(i % 300) + " " + std::to_string(i / 300) +
            " 0 children ";
    if (written == used && i > 0)
      body += "USE S }\n";
    else
      body += std::string(written == used ? "DEF S " : "") +
              "Shape { appearance Appearance { material Material { diffuseColor .5 " + green +
              " .5 } } geometry Box { size " + size + " .5 .5 } } }\n";
  }
  return body;
}

// Many small shapes: bytes and seconds per shape, from the file's text to the picture.
void Shapes(benchmark::State& state) {
  const int n = int(state.range(0));
  const std::string body = boxes(n, state.range(1));
  const auto begin = std::chrono::steady_clock::now();
  const double before = residentBytes();
  RTcontext context = rtNewContext("threads=1");
  std::unique_ptr<World> world = loadWorldFromMemory("#VRML V2.0 utf8\n" + body, "shapes.wrl");
  const double loaded = residentBytes();
  auto mapper = std::make_unique<OpenRTMapper>(*world, MapOptions());
  const double built = residentBytes();
  mapper->map(mapper->fitCamera(0.8));
  const double mapped = residentBytes();
  rtFrameBuffer(64, 48, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtRender();
  const double rendered = residentBytes();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  for (auto _ : state) rtRender();
  state.counters["us_per_shape"] = seconds.count() * 1e6 / n;
  state.counters["world"] = (loaded - before) / n;
  state.counters["graph"] = (built - loaded) / n;
  state.counters["objects"] = (mapped - built) / n;
  state.counters["scene"] = (rendered - mapped) / n;
  mapper.reset();
  rtDeleteContext(context);
}
BENCHMARK(Shapes)
    ->Args({100'000, separate})
    ->Args({100'000, different})
    ->Args({100'000, used})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

} // namespace
