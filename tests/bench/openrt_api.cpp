// openrt_api.cpp: the cost of the API itself, with the null backend: rtBegin/rtEnd in vertices per
// second, arrays against a bare memcpy of the same bytes, commits of moved instances.
#include <cstring>
#include <vector>

#include <benchmark/benchmark.h>

#include "openrt/openrt.h"

namespace {

class NullContext {
 public:
  NullContext() : context_(rtNewContext("backend=null")) { rtFrameBuffer(1, 1, RT_RGBA); }
  ~NullContext() { rtDeleteContext(context_); }

 private:
  RTcontext context_;
};

void check(benchmark::State& state) {
  if (rtGetError() != RT_NO_ERROR) state.SkipWithError(rtGetErrorMessage());
}

void countVertices(benchmark::State& state, size_t vertices) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(vertices));
}

// One list of many triangles. Argument: attributes (0 none, 1 normal, 2 normal, texture coordinate
// and colour).
void beginEnd(benchmark::State& state) {
  constexpr size_t vertices = 3 * 200000;
  const NullContext context;
  for (auto _ : state) {
    const RTid object = rtBeginObject(0);
    rtBegin(RT_TRIANGLES);
    for (size_t i = 0; i < vertices; i++) {
      if (state.range(0) >= 1) rtNormal3f(0, 0, 1);
      if (state.range(0) >= 2) {
        rtTexCoord2f(0.5f, 0.5f);
        rtColor3f(1, 0, 0);
      }
      rtVertex3f(float(i), float(i % 3 == 1), float(i % 3 == 2));
    }
    rtEnd();
    rtEndObject();
    rtDeleteObject(object);
  }
  check(state);
  countVertices(state, vertices);
}
BENCHMARK(beginEnd)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

// One list per triangle: merged into one geometry.
void beginEndPerTriangle(benchmark::State& state) {
  constexpr size_t triangles = 200000;
  const NullContext context;
  for (auto _ : state) {
    const RTid object = rtBeginObject(0);
    for (size_t i = 0; i < triangles; i++) {
      rtBegin(RT_TRIANGLES);
      rtVertex3f(float(i), 0, 0);
      rtVertex3f(float(i + 1), 0, 0);
      rtVertex3f(float(i), 1, 0);
      rtEnd();
    }
    rtEndObject();
    rtDeleteObject(object);
  }
  check(state);
  countVertices(state, 3 * triangles);
}
BENCHMARK(beginEndPerTriangle)->Unit(benchmark::kMillisecond);

struct Mesh { // a grid of 2 side^2 triangles
  std::vector<float> points;
  std::vector<uint32_t> indices;
  explicit Mesh(uint32_t side) {
    for (uint32_t y = 0; y <= side; y++)
      for (uint32_t x = 0; x <= side; x++)
        points.insert(points.end(), {float(x), float(y), float((x * y) % 7)});
    for (uint32_t y = 0; y < side; y++)
      for (uint32_t x = 0; x < side; x++) {
        const uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
        indices.insert(indices.end(), {a, b, c, b, d, c});
      }
  }
  size_t bytes() const { return points.size() * sizeof(float) + indices.size() * sizeof(uint32_t); }
};

void drawElements(benchmark::State& state) {
  const Mesh mesh(636); // 808,992 triangles
  const NullContext context;
  rtVertexPointer(3, RT_FLOAT, 0, mesh.points.data());
  for (auto _ : state) {
    const RTid object = rtBeginObject(0);
    rtDrawElements(RT_TRIANGLES, mesh.indices.size(), mesh.indices.data(), mesh.points.size() / 3);
    rtEndObject();
    rtDeleteObject(object);
  }
  check(state);
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(mesh.bytes()));
  countVertices(state, mesh.points.size() / 3);
}
BENCHMARK(drawElements)->Unit(benchmark::kMillisecond);

void drawArrays(benchmark::State& state) {
  std::vector<float> points;
  for (size_t i = 0; i < 3 * 400000; i++)
    points.insert(points.end(), {float(i), float(i % 3 == 1), float(i % 3 == 2)});
  const NullContext context;
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  for (auto _ : state) {
    const RTid object = rtBeginObject(0);
    rtDrawArrays(RT_TRIANGLES, 0, points.size() / 3);
    rtEndObject();
    rtDeleteObject(object);
  }
  check(state);
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(points.size() * sizeof(float)));
  countVertices(state, points.size() / 3);
}
BENCHMARK(drawArrays)->Unit(benchmark::kMillisecond);

// Copies the bytes of drawElements once into fresh memory: the upper limit.
void bareCopy(benchmark::State& state) {
  const Mesh mesh(636);
  for (auto _ : state) {
    std::vector<char> points(mesh.points.size() * sizeof(float)),
        indices(mesh.indices.size() * sizeof(uint32_t));
    std::memcpy(points.data(), mesh.points.data(), points.size());
    std::memcpy(indices.data(), mesh.indices.data(), indices.size());
    benchmark::DoNotOptimize(points.data());
    benchmark::DoNotOptimize(indices.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(mesh.bytes()));
}
BENCHMARK(bareCopy)->Unit(benchmark::kMillisecond);

// Moves one, or every one, of 10,000 instances and commits.
void moveInstances(benchmark::State& state) {
  const NullContext context;
  const RTid object = rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  std::vector<RTid> instances(10000);
  for (RTid& id : instances) id = rtInstantiateObject(object);
  rtRender();
  double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  for (auto _ : state) {
    m[12] += 1;
    for (int64_t i = 0; i < state.range(0); i++) rtInstanceMatrix(instances[size_t(i)], m);
    rtRender();
  }
  check(state);
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(moveInstances)->Arg(1)->Arg(10000)->Unit(benchmark::kMicrosecond);

} // namespace
