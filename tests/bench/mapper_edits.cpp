// mapper_edits.cpp: the mapper's cost of a change in a running world, by kind of change and number
// of objects. The null backend keeps acceleration structures and rendering out of the measurement.
// A move must cost the same next to 10 objects and next to 10,000.
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "behaviour/viewer/interaction.h"
#include "openrt/openrt.h"
#include "xvrml/mapper.h"

namespace {

using namespace xvrml;

// Returns n moving objects, and a material, a coordinate and a switch that events reach.
std::string body(int64_t n) {
  std::string text =
      "#VRML V2.0 utf8\nViewpoint { position 0 0 200 }\nDEF I PositionInterpolator { }\n";
  std::string routes;
  for (int64_t i = 0; i < n; ++i) {
    const std::string name = "T" + std::to_string(i);
    text += "DEF " + name + " Transform { translation " + std::to_string(i % 100) + " " +
            std::to_string(i / 100) + " 0 children Shape { appearance Appearance { material DEF M" +
            std::to_string(i) + " Material { } } geometry Box { size .5 .5 .5 } } }\n";
    routes += "ROUTE I.value_changed TO " + name + ".set_translation\n";
  }
  text += "Shape { geometry IndexedFaceSet { coord DEF C Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 "
          "] } coordIndex [ 0 1 2 ] } }\n"
          "DEF S Switch { whichChoice 0 choice [ Shape { geometry Box { } } Shape { geometry Cone "
          "{ } } ] }\n"
          "DEF K CoordinateInterpolator { }\nDEF N Script { eventOut SFInt32 out }\nDEF L "
          "PointLight { }\n";
  return text + routes + "ROUTE K.value_changed TO C.set_point\nROUTE N.out TO S.set_whichChoice\n";
}

struct Running {
  RTcontext context;
  std::unique_ptr<World> world;
  std::unique_ptr<Engine> engine;
  std::unique_ptr<OpenRTMapper> mapper;
  CameraSettings camera;

  explicit Running(int64_t n, const char* backend = "backend=null")
      : context(rtNewContext(backend)) {
    world = loadWorldFromMemory(body(n), "edits.wrl");
    engine = std::make_unique<Engine>(world->diagnostics, makeInteraction);
    engine->adoptScope(world->scope, true);
    mapper = std::make_unique<OpenRTMapper>(*world, MapOptions());
    camera = mapper->viewpointCamera(0);
    rtFrameBuffer(1, 1, RT_RGBA);
    frame();
  }
  ~Running() {
    mapper.reset();
    engine.reset();
    rtDeleteContext(context);
  }
  void send(const char* name, const char* in, Value value) {
    engine->dispatch(*world->scope.names.find(name)->second, in, std::move(value));
  }
  void show() {
    mapper->update(engine->takeChanges());
    mapper->map(camera);
  }
  void frame() {
    show();
    rtRender();
  }
};

template <class Send> void edit(benchmark::State& state, const Send& send) {
  Running running(state.range(0));
  int i = 0;
  send(running, i++); // promotions happen here, before the measurement
  running.show();
  const MapStats before = running.mapper->stats();
  for (auto _ : state) {
    send(running, i++);
    running.show();
  }
  const MapStats after = running.mapper->stats();
  state.counters["defined"] = benchmark::Counter(
      double(after.objectsDefined - before.objectsDefined), benchmark::Counter::kAvgIterations);
  state.SetLabel(std::to_string(after.objects) + " objects");
}

void Nothing(benchmark::State& state) {
  edit(state, [](Running&, int) {});
}
void MoveOne(benchmark::State& state) {
  edit(state, [](Running& r, int i) {
    r.send("T3", "set_translation", Vec3f{float(i % 7), 1, 2});
  });
}
void Material(benchmark::State& state) {
  edit(state, [](Running& r, int i) {
    r.send("M3", "set_diffuseColor", Color{float(i % 7) / 7, 1, 0});
  });
}
void Coordinates(benchmark::State& state) {
  edit(state, [](Running& r, int i) {
    r.send("C", "set_point", MFVec3f{{0, 0, 0}, {1, float(i % 7), 0}, {0, 1, 0}});
  });
}
void Light(benchmark::State& state) {
  edit(state, [](Running& r, int i) { r.send("L", "set_intensity", float(i % 7) / 7); });
}
void SwitchOver(benchmark::State& state) {
  edit(state, [](Running& r, int i) { r.send("S", "set_whichChoice", int32_t(i % 2)); });
}
void FromNothing(benchmark::State& state) { // the cost of every change without update()
  Running running(state.range(0));
  for (auto _ : state) {
    running.mapper.reset();
    running.mapper = std::make_unique<OpenRTMapper>(*running.world, MapOptions());
    running.mapper->map(running.camera);
  }
}

BENCHMARK(Nothing)->Arg(10)->Arg(10'000);
BENCHMARK(MoveOne)->Arg(10)->Arg(10'000);
BENCHMARK(Material)->Arg(10)->Arg(10'000);
BENCHMARK(Coordinates)->Arg(10)->Arg(10'000);
BENCHMARK(Light)->Arg(10)->Arg(10'000);
BENCHMARK(SwitchOver)->Arg(10)->Arg(10'000);
BENCHMARK(FromNothing)->Arg(10)->Arg(10'000)->Unit(benchmark::kMillisecond);

// With the local backend and a frame of one pixel: the total cost of a move.
void MoveOneAndRender(benchmark::State& state) {
  Running running(state.range(0), "threads=1");
  int i = 0;
  for (int k = 0; k < 2; ++k) {
    running.send("T3", "set_translation", Vec3f{float(i++ % 7), 1, 2});
    running.frame();
  }
  RTstats before{sizeof(RTstats)}, after{sizeof(RTstats)};
  rtGetStats(&before);
  for (auto _ : state) {
    running.send("T3", "set_translation", Vec3f{float(i++ % 7), 1, 2});
    running.frame();
  }
  rtGetStats(&after);
  state.counters["objectBuilds"] = benchmark::Counter(
      double(after.bvh.objectBuilds - before.bvh.objectBuilds), benchmark::Counter::kAvgIterations);
}
BENCHMARK(MoveOneAndRender)->Arg(10)->Arg(10'000)->Unit(benchmark::kMillisecond);

} // namespace
