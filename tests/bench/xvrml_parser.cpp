// xvrml_parser.cpp: the speed of reading worlds, compared in the same run with a bare
// std::from_chars scan for numbers over the same bytes. The target is two thirds of that speed, or
// 200 MB/s (docs/benchmarks.md).
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "xvrml/edit.h"
#include "xvrml/world.h"

namespace {

// The world of tools/make_big_ifs.py: a wavy grid of 632 x 632 cells, 799,000 triangles, 30 MB.
const std::string& bigFaceSet() {
  static const std::string text = [] {
    constexpr int cells = 632, row = cells + 1;
    std::string out =
        "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [\n";
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        out += fmt::format("{:.6g} {:.6g} {:.6g},\n", i * 0.01 - 3.16,
                           std::sin(i * 0.05) * std::cos(j * 0.03), j * 0.01 - 3.16);
      }
    }
    out += "] } coordIndex [\n";
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        const int a = j * row + i;
        out += fmt::format("{}, {}, {}, -1,\n{}, {}, {}, -1,\n", a, a + row, a + row + 1, a,
                           a + row + 1, a + 1);
      }
    }
    return out + "] } }\n";
  }();
  return text;
}

// Many small nodes: 50,000 Transforms that USE one Shape.
const std::string& manyNodes() {
  static const std::string text = [] {
    std::string out = "#VRML V2.0 utf8\nDEF S Shape { geometry Box { } }\n";
    for (int i = 0; i < 50'000; ++i)
      out +=
          fmt::format("Transform {{ translation {} 0 {} children [ USE S ] }}\n", i % 100, i / 100);
    return out;
  }();
  return text;
}

void countBytes(benchmark::State& state, const std::string& text) {
  state.SetBytesProcessed(static_cast<int64_t>(state.iterations() * text.size()));
}

void load(benchmark::State& state, const std::string& (*make)()) {
  const std::string& text = make();
  for (auto _ : state) benchmark::DoNotOptimize(xvrml::loadWorldFromMemory(text, "bench.wrl"));
  countBytes(state, text);
}

void scanNumbers(benchmark::State& state) {
  const std::string& text = bigFaceSet();
  for (auto _ : state) {
    double sum = 0;
    for (const char *p = text.data(), *end = p + text.size(); p < end;) {
      float number = 0;
      const bool starts = (*p >= '0' && *p <= '9') || *p == '-' || *p == '.';
      const auto result = starts ? std::from_chars(p, end, number)
                                 : std::from_chars_result{p, std::errc::invalid_argument};
      p = result.ec == std::errc() ? result.ptr : p + 1;
      sum += number;
    }
    benchmark::DoNotOptimize(sum);
  }
  countBytes(state, text);
}

// Reads the file again for the editor, with the places of all its nodes and values.
void loadForEdits(benchmark::State& state) {
  const std::string path = std::filesystem::temp_directory_path() / "bench_edits.wrl";
  std::ofstream(path) << manyNodes();
  const auto world = xvrml::loadWorld(path);
  for (auto _ : state) {
    xvrml::Editor editor(*world);
    editor.preparation()();
  }
  std::filesystem::remove(path);
  countBytes(state, manyNodes());
}

void write(benchmark::State& state) {
  const auto world = xvrml::loadWorldFromMemory(bigFaceSet(), "bench.wrl");
  size_t bytes = 0;
  for (auto _ : state) bytes += xvrml::writeWorld(*world).size();
  state.SetBytesProcessed(static_cast<int64_t>(bytes));
}

BENCHMARK(scanNumbers)->Name("parser/fromCharsScan")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load, bigFaceSet, bigFaceSet)
    ->Name("parser/bigFaceSet")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load, manyNodes, manyNodes)
    ->Name("parser/manyNodes")
    ->Unit(benchmark::kMillisecond);
BENCHMARK(loadForEdits)->Name("parser/manyNodesForEdits")->Unit(benchmark::kMillisecond);
BENCHMARK(write)->Name("writer/bigFaceSet")->Unit(benchmark::kMillisecond);

} // namespace
