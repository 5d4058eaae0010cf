// openrt_edits.cpp: Measures the cost of an edit as rtRender of a one-pixel picture after it. The
// scene has a number of dynamic objects next to a static terrain of 20,000 triangles. Counters show
// the builds per step. Also measures the memory of a forest of instances.
#include <cmath>
#include <cstdio>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "openrt/openrt.h"

namespace {

struct Mesh {
  std::vector<float> points;
  std::vector<uint32_t> indices;
};

Mesh wave(int n, double size, double phase) {
  Mesh mesh;
  for (int y = 0; y <= n; y++)
    for (int x = 0; x <= n; x++) {
      const double u = size * (double(x) / n - .5), v = size * (double(y) / n - .5);
      mesh.points.insert(
          mesh.points.end(),
          {float(u), float(.02 * size * std::sin(9 * u / size + phase) * std::cos(7 * v / size)),
           float(v)});
      const auto i = uint32_t(y * (n + 1) + x), w = uint32_t(n + 1);
      if (x < n && y < n)
        mesh.indices.insert(mesh.indices.end(), {i, i + w, i + 1, i + 1, i + w, i + w + 1});
    }
  return mesh;
}

RTid define(RTid object, const Mesh& mesh) {
  const RTid id = rtBeginObject(object);
  rtVertexPointer(3, RT_FLOAT, 0, mesh.points.data());
  rtDrawElements(RT_TRIANGLES, mesh.indices.size(), mesh.indices.data(), mesh.points.size() / 3);
  rtEndObject();
  return id;
}

RTid grid(RTid object, int n, double size, double phase) {
  return define(object, wave(n, size, phase));
}

void place(RTid instance, double x, double y, double z) {
  const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
  rtInstanceMatrix(instance, m);
}

void look(double x) {
  rtPushMatrix();
  rtLookAt(x, 40, 100, 0, 0, 0, 0, 1, 0);
  rtPerspective(45);
  rtPopMatrix();
}

RTstats stats() {
  RTstats s{};
  s.size = sizeof s;
  rtGetStats(&s);
  return s;
}

class EditScene {
 public:
  // same: all dynamic instances share one object of 128 triangles. Otherwise each has its own
  // object and shader.
  EditScene(int64_t count, bool same) : context_(rtNewContext("threads=2")) {
    rtFrameBuffer(1, 1, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    shader = rtNewShader(rtNewShaderClass("VRML97", nullptr));
    rtBindShader(shader);
    diffuse = rtParameterHandle("diffuseColor");
    rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", nullptr)));
    rtInstantiateObject(grid(0, 100, 200, 0));
    RTid object = 0;
    for (int64_t i = 0; i < count; i++) {
      if (!same || i == 0) {
        rtGenObjects(1, &object);
        if (!same) {
          rtObjectHint(object, RT_DYNAMIC);
          rtBindShader(rtNewShader(rtNewShaderClass("VRML97", nullptr)));
        }
        grid(object, 8, 1, 0);
        objects.push_back(object);
      }
      instances.push_back(rtInstantiateObject(object));
      rtInstanceHint(instances.back(), RT_DYNAMIC);
      place(instances.back(), double(i % 100) - 50, 2, double(i / 100) - 50);
    }
    look(0);
    rtRender();
    before_ = stats();
  }
  ~EditScene() { rtDeleteContext(context_); }
  void report(benchmark::State& state) {
    const RTstats now = stats();
    const double n = double(state.iterations());
    state.counters["objects"] = double(now.bvh.objectBuilds - before_.bvh.objectBuilds) / n;
    state.counters["topLevels"] = double(now.bvh.topLevelBuilds - before_.bvh.topLevelBuilds) / n;
    if (rtGetError() != RT_NO_ERROR) state.SkipWithError(rtGetErrorMessage());
  }
  RTid shader = 0;
  int diffuse = 0;
  std::vector<RTid> objects, instances;

 private:
  RTcontext context_;
  RTstats before_;
};

template <class Edit> void edit(benchmark::State& state, bool same, const Edit& change) {
  EditScene scene(state.range(0), same);
  int step = 0;
  for (auto _ : state) {
    change(scene, ++step);
    rtRender();
  }
  scene.report(state);
}

void nothing(benchmark::State& state) {
  edit(state, true, [](EditScene&, int) {});
}
void moveOne(benchmark::State& state) {
  edit(state, true, [](EditScene& s, int i) {
    place(s.instances[size_t(i * 7) % s.instances.size()], i % 50, 3, i % 31);
  });
}
void moveAll(benchmark::State& state) {
  edit(state, true, [](EditScene& s, int i) {
    for (size_t k = 0; k < s.instances.size(); k++)
      place(s.instances[k], double(k % 100) - 50, 2 + i % 5, double(k / 100) - 50);
  });
}
void hideOne(benchmark::State& state) {
  edit(state, true, [](EditScene& s, int i) { rtInstanceVisible(s.instances[0], i % 2); });
}
void moveOneOfDifferent(benchmark::State& state) {
  edit(state, false, [](EditScene& s, int i) {
    place(s.instances[size_t(i * 7) % s.instances.size()], i % 50, 3, i % 31);
  });
}
void redefineOne(benchmark::State& state) {
  edit(state, false,
       [](EditScene& s, int i) { grid(s.objects[size_t(i) % s.objects.size()], 8, 1, i); });
}
void parameter(benchmark::State& state) {
  edit(state, true, [](EditScene& s, int i) {
    rtBindShader(s.shader);
    rtParameter3f(s.diffuse, float(i % 10) / 10, .5f, .5f);
  });
}
void parameterOfMany(benchmark::State& state) {
  edit(state, false, [](EditScene& s, int i) {
    rtBindShader(s.shader);
    rtParameter3f(s.diffuse, float(i % 10) / 10, .5f, .5f);
  });
}
void moveCamera(benchmark::State& state) {
  edit(state, true, [](EditScene&, int i) { look(i % 20); });
}
void addAndDelete(benchmark::State& state) {
  edit(state, true, [](EditScene& s, int i) {
    rtDeleteInstance(s.instances.back());
    s.instances.back() = rtInstantiateObject(s.objects[0]);
    rtInstanceHint(s.instances.back(), RT_DYNAMIC);
    place(s.instances.back(), i % 40, 3, 0);
  });
}
// The camera leaves its cell of the grid of origins, so all static geometry is rounded again.
void buildAll(benchmark::State& state) {
  edit(state, true, [](EditScene&, int i) { look(i % 2 ? 3000 : 0); });
}

BENCHMARK(nothing)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(moveOne)->RangeMultiplier(10)->Range(10, 10000)->Unit(benchmark::kMillisecond);
BENCHMARK(moveOneOfDifferent)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(moveAll)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(hideOne)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(redefineOne)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(parameter)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(parameterOfMany)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(moveCamera)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(addAndDelete)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(buildAll)->Arg(10)->Arg(10000)->Unit(benchmark::kMillisecond);

// A mesh of n x n squares that deforms with each frame of 320x240 pixels, under a lamp.
void deform(benchmark::State& state) {
  std::vector<Mesh> phases;
  for (int i = 0; i < 6; i++) phases.push_back(wave(int(state.range(0)), 2, i));
  const RTcontext context = rtNewContext("threads=2");
  rtFrameBuffer(320, 240, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtBindShader(rtNewShader(rtNewShaderClass("VRML97", nullptr)));
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", nullptr)));
  RTid object = 0;
  rtGenObjects(1, &object);
  rtObjectHint(object, RT_DYNAMIC);
  rtInstantiateObject(define(object, phases[0]));
  rtLookAt(0, 1, 2, 0, 0, 0, 0, 1, 0);
  rtPerspective(45);
  rtRender();
  const RTstats before = stats();
  size_t step = 0;
  for (auto _ : state) {
    define(object, phases[++step % phases.size()]);
    rtRender();
  }
  const RTstats now = stats();
  state.counters["objects"] = double(now.bvh.objectBuilds - before.bvh.objectBuilds);
  state.counters["buildSeconds"] = now.time.build;
  state.counters["renderSeconds"] = now.time.render;
  if (rtGetError() != RT_NO_ERROR) state.SkipWithError(rtGetErrorMessage());
  rtDeleteContext(context);
}
BENCHMARK(deform)->Arg(300)->Arg(1000)->UseRealTime()->Unit(benchmark::kMillisecond);

double residentMegabytes() {
  long pages = 0, resident = 0;
  if (FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return double(resident) * double(sysconf(_SC_PAGESIZE)) / 1e6;
}

// 10,000 instances of 10,000 triangles. Argument: 1 if they are dynamic.
void forest(benchmark::State& state) {
  double bytes = 0, resident = 0;
  for (auto _ : state) {
    const double before = residentMegabytes();
    const RTcontext context = rtNewContext("threads=2");
    rtFrameBuffer(1, 1, RT_RGBA);
    const RTid tree = grid(0, 71, 1, 0);
    for (int i = 0; i < 10000; i++) {
      const RTid instance = rtInstantiateObject(tree);
      rtInstanceHint(instance, state.range(0) ? RT_DYNAMIC : RT_STATIC);
      place(instance, i % 100, 0, i / 100);
    }
    look(0);
    rtRender();
    bytes = double(stats().bvh.bytes) / 1e6;
    resident = residentMegabytes() - before;
    rtDeleteContext(context);
  }
  state.counters["bvhMB"] = bytes;
  state.counters["residentMB"] = resident;
}
BENCHMARK(forest)->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond);

} // namespace
