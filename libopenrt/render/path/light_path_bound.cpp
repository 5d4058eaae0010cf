#include "render/path/light_path_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/lights/emitters.h"
#include "render/path/camera_rays.h"
#include "render/path/guided_rays.h"
#include "render/surface/lobes.h"

namespace openrt {
namespace {

// Mirrors and glass concentrate light: what a tile lacks may come to a quarter of its pixels.
constexpr double concentration = 4;

// Returns the paths of a tile that arrive per area at hit i, over all paths of the tile.
float densityAt(const RtsBatch& batch, const RayState& state, uint32_t i,
                const TileFootprint& footprint) {
  const RtsHits& hits = batch.points->hits;
  const float cosine = std::fabs(dot(load(hits.geometric, i), load(hits.direction, i))),
              own = cosine / footprint.area(hits.distance[i]);
  if (!state.flags.scattered()) return own;
  const Vec3f way = load(hits.position, i) - state.previous.position;
  const float pdf = state.pdf > 0 ? state.pdf : 1 / std::numbers::pi_v<float>,
              scattered = pdf * cosine / dot(way, way);
  return scattered < own ? scattered : own;
}

// Returns the radiance that the lobes of hit i send back for an irradiance of 1 that comes from the
// directions which they have sampled.
Vec3f responseAt(const RtsBatch& batch, const LobeSampling& sampling, uint32_t i) {
  Vec3f sum;
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    const LobeSamples* samples = sampling.samples[l];
    Vec3f weight;
    if (!samples || !(samples->pdf[i] > 0) || !weightAt(batch.lobes[l], i, weight)) continue;
    const float cosine =
        std::fabs(dot(load(batch.lobes[l].normal, i), load(samples->direction, i)));
    if (cosine > 0) sum += weight * load(samples->value, i) * (samples->pdf[i] / cosine);
  }
  return sum;
}

} // namespace

float TileFootprint::area(float distance) const {
  const Vec3d a = Vec3d(origin[0]) + double(distance) * Vec3d(direction[0]),
              b = Vec3d(origin[1]) + double(distance) * Vec3d(direction[1]);
  return float(length(cross(a, b)));
}

TileFootprint footprintOf(const StageContext& context, const Tile& tile) {
  const StageContext alone{context.scene, context.arena, context.counters}; // the lens has a centre
  ArenaScope scope(context.arena);
  constexpr uint32_t n = 3;
  const auto x0 = float(tile.x0), y0 = float(tile.y0), x1 = float(tile.x1), y1 = float(tile.y1);
  const float corner[2][n] = {{x0, x1, x0}, {y0, y0, y1}};
  float* xy[2];
  for (int k = 0; k < 2; k++) {
    xy[k] = context.arena.take<float>(padded(n));
    for (uint32_t i = 0; i < padded(n); i++) xy[k][i] = corner[k][std::min(i, n - 1)];
  }
  Rays rays;
  rays.allocate(context.arena, n);
  makeCameraRays(alone, xy, rays);
  TileFootprint out;
  for (uint32_t side = 0; side < 2; side++) {
    out.origin[side] = load(rays.org, side + 1) - load(rays.org, 0);
    out.direction[side] = load(rays.dir, side + 1) - load(rays.dir, 0);
  }
  return out;
}

void addLightPathBound(const CameraPaths& paths, const LobeSampling& sampling,
                       const TileFootprint& footprint) {
  const RtsBatch& batch = paths.batch;
  const double flux = concentration * batch.scene.lightPathFlux;
  const Emitters& emitters = *batch.scene.emitters;
  const bool shapes = emitters.brightestShape() > 0, sun = emitters.hasSun();
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    const RayState state = (*batch.states)[batch.order[i]];
    if (!isGuided(batch.scene, state.flags)) continue;
    const double radiance = double(largest(state.throughput * responseAt(batch, sampling, i))) *
                            double(densityAt(batch, state, i, footprint)) * flux;
    if (!std::isfinite(radiance)) continue;
    if (shapes) paths.ledger.unsampled.byLightPath += radiance;
    if (sun) paths.ledger.unsampledSky.byLightPath += radiance;
  }
}

} // namespace openrt
