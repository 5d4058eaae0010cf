#include "render/medium/containing_media.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "render/wave/nearest_hits.h"

namespace openrt {
namespace {

// The direction of the probe rays has no relation to the axes, so that they do not run along faces.
const Vec3f probeDirection = normalize(Vec3f{0.5377f, 0.8018f, 0.2604f});
// A probe that passes more surfaces than this gives up.
constexpr int mostSurfaces = 1000;

// Holds what a probe ray has passed.
struct Probe {
  std::vector<uint16_t> entered, left; // left: media that it never entered, in the order of leaving

  void pass(uint16_t medium, bool back) {
    if (!back) return entered.push_back(medium);
    const auto own = std::find(entered.rbegin(), entered.rend(), medium);
    if (own == entered.rend())
      left.push_back(medium);
    else
      entered.erase(std::next(own).base());
  }
  // Returns the stack at the start of the probe: the body that was left last was entered first.
  MediaStack stack() const {
    MediaStack media{};
    const size_t n = std::min(left.size(), media.size());
    std::copy_n(left.rbegin() + std::ptrdiff_t(left.size() - n), n, media.begin());
    return media;
  }
};

Probe probe(const StageContext& context, Vec3f origin) {
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  Probe found;
  for (int pass = 0; pass < mostSurfaces; pass++) {
    ArenaScope scope(arena);
    Rays ray;
    ray.allocate(arena, 1);
    store(origin, ray.org, 0);
    store(probeDirection, ray.dir, 0);
    ray.tnear[0] = 0;
    ray.tfar[0] = std::numeric_limits<float>::infinity();
    const RayHits hits = findNearest(context, ray, Coherence::coherent);
    context.counters.secondary++;
    if (hits.record[0] == noHit) break;
    if (const uint16_t medium = (*scene.shaders)[scene.records[hits.record[0]].shader].medium)
      found.pass(medium, isBackFaceHit(scene, ray, hits, 0));
    const uint32_t lane = 0;
    const auto* travelled = arena.takeZero<float>(padded(1));
    const Points points = makePoints(scene, ray, hits, &lane, 1, travelled, arena);
    origin = liftPoint(points, 0, probeDirection);
  }
  return found;
}

} // namespace

// The rays of most cameras start at one point.
void findContainingMedia(const StageContext& context, const Rays& rays, MediaStack* media) {
  for (uint32_t i = 0; i < rays.count; i++) {
    const Vec3f origin = load(rays.org, i);
    media[i] =
        i > 0 && origin == load(rays.org, i - 1) ? media[i - 1] : probe(context, origin).stack();
  }
}

MediaStack mediaAroundEye(const RenderScene& scene) {
  if (scene.shaders->media().empty()) return {};
  Arena arena;
  RayCounters counters;
  return probe({scene, arena, counters}, scene.eye).stack();
}

bool isInMedium(const RenderScene& scene, const Vec3f& point, uint16_t medium) {
  Arena arena;
  RayCounters counters; // a warning must not change the statistics
  const std::vector<uint16_t> left = probe({scene, arena, counters}, point).left;
  return std::find(left.begin(), left.end(), medium) != left.end();
}

} // namespace openrt
