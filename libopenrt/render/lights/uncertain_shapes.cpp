// uncertain_shapes.cpp: finds emissive shapes that rays may not report: shapes that are hidden, and
// those that have another surface in the same place, for example a face that a world contains
// twice. They count as lights only where rays report them. Short rays through each shape find them.
// Between frames.
#include <algorithm>
#include <cmath>

#include "render/lights/emissive_shapes.h"
#include "render/render_scene.h"

namespace openrt {
namespace {

constexpr uint32_t batchSize = 1024;
// Scenes with more shapes get one probe for each triangle instead of four.
constexpr size_t manyShapes = 1 << 16;

// Probe rays, and the shape that each one passes.
struct Probes {
  Rays rays;
  RayHits hits;
  uint32_t* shape;

  explicit Probes(Arena& arena) {
    rays.allocate(arena, batchSize);
    hits.allocate(arena, batchSize);
    shape = arena.take<uint32_t>(batchSize);
    rays.count = 0;
  }
  // Adds a ray that passes a point against the normal, from just before it to just behind it.
  void add(uint32_t number, const EmissiveShapes::Place& place, bool otherSide) {
    if (!(place.area > 0)) return;
    const double coordinates = largest(abs(place.position));
    // The rounding errors of the point and of the kernel, also in an instance.
    const auto reach = float(std::max(coordinates, std::sqrt(place.area)) * 0x1p-19);
    if (!(reach > 0) || !std::isfinite(reach)) return;
    const uint32_t i = rays.count++;
    const Vec3f towards = otherSide ? -place.normal : place.normal;
    store(place.position + reach * towards, rays.org, i);
    store(-towards, rays.dir, i);
    rays.tnear[i] = 0;
    rays.tfar[i] = 2 * reach;
    shape[i] = number;
  }
};

} // namespace

void EmissiveShapes::markUncertain(const RenderScene& scene) {
  // Points of the unit square that place() maps into the inside of a triangle or around a sphere.
  static constexpr float at[4][2] = {{0.45f, 0.5f}, {0.2f, 0.3f}, {0.8f, 0.15f}, {0.8f, 0.85f}};
  const uint32_t places = shapes_.size() > manyShapes ? 1 : 4;
  Arena arena;
  Probes probes(arena);
  // By record: whether it shares a place with another one. All its shapes count then, because the
  // probes may miss some.
  std::vector<uint8_t> uncertain(scene.records.size(), 0);
  const auto trace = [&] {
    scene.kernel->intersectFronts(probes.rays, maskAll, probes.hits);
    for (uint32_t i = 0; i < probes.rays.count; i++) {
      Shape& own = shapes_[probes.shape[i]];
      const uint32_t record = probes.hits.record[i], primitive = probes.hits.primitive[i];
      if (record == own.record && primitive == own.primitive) continue;
      own.uncertain = true;
      if (record == noHit) continue;
      if (const uint32_t other = find(record, primitive); other != none)
        shapes_[other].uncertain = true;
      if (record != own.record) uncertain[own.record] = uncertain[record] = 1;
    }
    probes.rays.count = 0;
  };
  for (uint32_t number = 0; number < shapes_.size(); number++) {
    const Shape& s = shapes_[number];
    if (!s.sides) continue;
    for (uint32_t p = 0; p < places; p++) {
      probes.add(number, place(scene, number, at[p][0], at[p][1]), !(s.sides & 1));
      if (probes.rays.count == batchSize) trace();
    }
  }
  if (probes.rays.count) trace();
  for (Shape& s : shapes_) {
    s.uncertain |= uncertain[s.record] != 0;
    anyUncertain_ |= s.uncertain;
  }
}

} // namespace openrt
