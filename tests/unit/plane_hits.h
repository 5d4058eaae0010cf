// plane_hits.h: hits of paths on the plane z = 0, for tests and benchmarks that call stages of the
// ray core alone. All rays come down at 45 degrees along x.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "render/lights/emitters.h"
#include "render/wave/batch.h"
#include "render/wave/path_states.h"

namespace openrt::test {

struct PlaneHits {
  RenderScene scene;
  Arena arena;
  RayCounters counters;
  Points points{};
  PathStates states{};

  explicit PlaneHits(uint32_t n)
      : size_(padded(n)), order_(size_), zeros_(size_), pointers_(size_) {
    fillHost(scene.host);
    scene.emitters = std::make_shared<Emitters>(); // none emits
    std::iota(order_.begin(), order_.end(), 0u);
    const float s = std::sqrt(0.5f);
    RtsHits& h = points.hits;
    h.count = n;
    const float direction[3] = {s, 0, -s}, normal[3] = {0, 0, 1};
    for (int k = 0; k < 3; k++) {
      h.position[k] = fill(0);
      h.direction[k] = fill(direction[k]);
      h.geometric[k] = h.normal[k] = fill(normal[k]);
    }
    for (auto& a : h.uv) a = fill(0);
    for (auto& a : h.color) a = fill(1);
    h.distance = h.segment = fill(2);
    h.flags = zeros_.data();
    h.params = pointers_.data();
    points.error = fill(1e-6f);
    points.record = zeros_.data();
    points.order = order_.data();
    states.allocate(arena, n);
    for (uint32_t i = 0; i < n; i++) states.set(i, RayState{.path = i});
  }
  PlaneHits(const PlaneHits&) = delete;
  PlaneHits& operator=(const PlaneHits&) = delete;

  StageContext context() { return {scene, arena, counters}; }
  RtsBatch batch() { return {context(), points, states}; }
  // Adds a grey lobe to the batch.
  void add(RtsBatch& batch, RtsLobeKind kind, float weight) {
    RtsLobe* lobe = scene.host.lobe(&batch, kind);
    for (auto* a : lobe->weight) std::fill_n(a, size_, weight);
  }

 private:
  float* fill(float value) {
    auto* a = arena.take<float>(size_);
    std::fill_n(a, size_, value);
    return a;
  }
  const uint32_t size_;
  std::vector<uint32_t> order_, zeros_;
  std::vector<const void*> pointers_;
};

} // namespace openrt::test
