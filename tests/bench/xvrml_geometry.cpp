// xvrml_geometry.cpp: building a mesh from an IndexedFaceSet of 800,000 triangles. Flat triangles
// used in place are limited by memory bandwidth. Creases and face colours take time proportional to
// the faces.
#include <cmath>
#include <memory>

#include <benchmark/benchmark.h>

#include "geometry/mesh.h"
#include "xvrml/nodes.h"

namespace {

using namespace xvrml;

template <class T> T* make(const char* name, NodeRef& ref) {
  const NodeType* type = findNodeType(name);
  ref = NodeRef(type->create(*type));
  return nodeCast<T>(ref);
}

// A wavy grid of 632 x 632 cells.
struct BigFaceSet {
  NodeRef node, coordinate, color;
  nodes::IndexedFaceSet* faces;

  BigFaceSet() {
    constexpr int cells = 632, row = cells + 1;
    faces = make<nodes::IndexedFaceSet>("IndexedFaceSet", node);
    auto* points = make<nodes::Coordinate>("Coordinate", coordinate);
    make<nodes::Color>("Color", color)->color.resize(2 * cells * cells);
    for (int j = 0; j <= cells; j++)
      for (int i = 0; i <= cells; i++)
        points->point.push_back({float(i) * 0.01f,
                                 std::sin(float(i) * 0.05f) * std::cos(float(j) * 0.03f),
                                 float(j) * 0.01f});
    for (int j = 0; j < cells; j++)
      for (int i = 0; i < cells; i++) {
        const int a = j * row + i;
        faces->coordIndex.insert(faces->coordIndex.end(),
                                 {a, a + row, a + row + 1, -1, a, a + row + 1, a + 1, -1});
      }
    faces->coord = coordinate;
  }

  void run(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(buildMesh(*node, {}).indices.size());
    state.counters["triangles"] = benchmark::Counter(double(faces->coordIndex.size() / 4),
                                                     benchmark::Counter::kIsIterationInvariantRate);
  }
};

void flatTriangles(benchmark::State& state) { BigFaceSet().run(state); }
BENCHMARK(flatTriangles)->Unit(benchmark::kMillisecond);

void creasedTriangles(benchmark::State& state) {
  BigFaceSet big;
  big.faces->creaseAngle = 0.5f;
  big.run(state);
}
BENCHMARK(creasedTriangles)->Unit(benchmark::kMillisecond);

void colouredFaces(benchmark::State& state) {
  BigFaceSet big;
  big.faces->color = big.color;
  big.faces->colorPerVertex = false;
  big.run(state);
}
BENCHMARK(colouredFaces)->Unit(benchmark::kMillisecond);

} // namespace
