#include "render/path/surface_connections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/lights/emitted.h"
#include "render/lights/light_path_weights.h"
#include "render/lights/shadows.h"
#include "render/surface/adjoint.h"
#include "render/surface/lobes.h"

namespace openrt {
namespace {

// Connections, as arrays.
struct Connections {
  uint32_t count;
  const uint32_t* vertex;            // index of the hit in the light paths' batch
  uint32_t* surface;                 // index of the hit in the camera paths' batch
  float *toSurface[3], *toVertex[3]; // unit
  float* square;                     // squared distance
  float* connections;                // connectionsAt() of the surface
  float *whole[3], *shared[3];       // light for a flux of 1: all, and times the light paths' share
  float* coated[3];                  // the part of `shared` that coats of the surface reflect
};

void takeVectors(Arena& arena, uint32_t n, float* out[3]) {
  for (int k = 0; k < 3; k++) out[k] = arena.takeZero<float>(padded(n));
}

void addTo(float* const sums[3], uint32_t j, const Vec3f& light) {
  store(load(sums, j) + light, sums, j);
}

Connections startConnections(const ConnectedSurfaces& surfaces, const LightVertices& vertices) {
  const RtsBatch &light = vertices.batch, &camera = surfaces.batch;
  Arena& arena = light.arena;
  const uint32_t n = vertices.count;
  Connections out{.count = n, .vertex = vertices.hit};
  out.surface = arena.take<uint32_t>(padded(n));
  out.square = arena.take<float>(padded(n));
  out.connections = arena.take<float>(padded(n));
  for (auto* group : {out.toSurface, out.toVertex, out.whole, out.shared, out.coated})
    takeVectors(arena, n, group);
  for (uint32_t j = 0; j < n; j++) {
    const uint32_t i = out.surface[j] =
                       surfaces.hit[light.states->path[light.order[out.vertex[j]]]],
                   lane = camera.order[i];
    const Vec3f way =
        load(light.points->hits.position, out.vertex[j]) - load(camera.points->hits.position, i);
    const float distance = length(way);
    out.square[j] = distance * distance;
    out.connections[j] = connectionsAt(camera.scene, camera.states->flagsOf(lane),
                                       load(camera.states->throughput, lane));
    const Vec3f direction = distance > 0 ? way / distance : Vec3f{0, 0, 1};
    store(direction, out.toVertex, j);
    store(-direction, out.toSurface, j);
  }
  return out;
}

// The answer of a lobe to each connection: the light that it sends on, and the solid-angle pdf of
// the weights.
struct Answer {
  const RtsLobe* lobe;
  float *light[3], *pdf;
};

// Computes what a lobe of the surfaces sends back to the camera: in the directions of BSDF
// sampling.
Answer answerOfSurface(const RtsBatch& batch, const RtsLobe& lobe, const Connections& to) {
  const RtsHits& hits = batch.points->hits;
  LobeValues values(batch.arena, to.count, &batch);
  values.evaluate(lobe, hits, to.count, to.surface, to.toVertex);
  for (uint32_t j = 0; j < to.count; j++) {
    const uint32_t i = to.surface[j];
    const Vec3f direction = load(to.toVertex, j);
    const float cosine = dot(direction, load(lobe.normal, i));
    const bool front = dot(direction, load(hits.geometric, i)) > 0;
    Vec3f weight;
    if (!weightAt(lobe, i, weight) || front != (cosine > 0) ||
        (!front && !nonSpecularFunctions(lobe)->transmits))
      weight = {};
    store(weight * load(values.value, j), values.value, j);
    // projectedPdfs() says why a direction behind the surface has the pdf of Lambert
    if (!(cosine > 0)) values.pdf[j] = -cosine * std::numbers::inv_pi_v<float>;
  }
  return {&lobe, {values.value[0], values.value[1], values.value[2]}, values.pdf};
}

// Computes what a lobe of the vertices sends to the surfaces, with the correction for shading
// normals. Flux is not scaled where a rough boundary lets it pass.
Answer answerOfVertex(const RtsBatch& batch, const RtsLobe& lobe, const Connections& to) {
  const RtsHits& hits = batch.points->hits;
  LobeValues values(batch.arena, to.count, &batch);
  values.evaluate(lobe, hits, to.count, to.vertex, to.toSurface);
  for (uint32_t j = 0; j < to.count; j++) {
    const uint32_t i = to.vertex[j];
    const Vec3f direction = load(to.toSurface, j);
    const bool front = dot(direction, load(hits.geometric, i)) > 0;
    Vec3f weight;
    if (!weightAt(lobe, i, weight) || (!front && !nonSpecularFunctions(lobe)->transmits))
      weight = {};
    const float factor =
        adjointCorrection(lobe, hits, i, direction) / radianceScale(lobe, i, direction);
    store(weight * load(values.value, j) * factor, values.value, j);
  }
  return {&lobe, {values.value[0], values.value[1], values.value[2]}, values.pdf};
}

// Returns by connection the ratio of pdfs (lights/light_path_weights.h) times the pdf of the
// surface's lobe.
const float* ratiosAt(const LightVertices& vertices, const Answer& from,
                      const ConnectedSurfaces& surfaces, const Connections& to) {
  const RtsBatch& batch = vertices.batch;
  auto* ratio = batch.arena.take<float>(padded(to.count));
  ArenaScope scope(batch.arena);
  auto* spread = batch.arena.take<float>(padded(to.count));
  for (uint32_t j = 0; j < to.count; j++)
    spread[j] = connectionRatio(to.connections[j]) *
                spreadTo(lightSampleContext(*surfaces.batch.points, to.surface[j], false).position,
                         load(batch.points->hits.position, to.vertex[j]),
                         load(from.lobe->normal, to.vertex[j]));
  const ProjectedPdfs pdfs =
      projectedPdfs(batch, *from.lobe, to.count, to.vertex, to.toSurface, from.pdf);
  const float* factor = lightPathFactors(batch, *from.lobe, {to.count, to.vertex, to.toSurface},
                                         pdfs, spread, vertices.starts);
  for (uint32_t j = 0; j < to.count; j++)
    ratio[j] = factor[j] * batch.states->lightPathRatio[batch.order[to.vertex[j]]];
  return ratio;
}

// Computes the light of the connections for a flux of 1, lobe by lobe of both ends.
void scatterAtBothEnds(const ConnectedSurfaces& surfaces, const LightVertices& vertices,
                       const Connections& to) {
  const RtsBatch &light = vertices.batch, &camera = surfaces.batch;
  ArenaScope lightScope(light.arena), cameraScope(camera.arena);
  Answer answers[RTS_MAX_LOBES];
  uint32_t count = 0;
  for (const RtsLobe& lobe : camera.lobes)
    if (nonSpecularFunctions(lobe)) answers[count++] = answerOfSurface(camera, lobe, to);
  for (const RtsLobe& lobe : light.lobes) {
    if (!nonSpecularFunctions(lobe)) continue;
    ArenaScope scope(light.arena);
    const Answer sent = answerOfVertex(light, lobe, to);
    const float* ratio = ratiosAt(vertices, sent, surfaces, to);
    for (const Answer& back : std::span(answers, count))
      for (uint32_t j = 0; j < to.count; j++) {
        const Vec3f found = load(sent.light, j) * load(back.light, j);
        const Vec3f shared = found * lightPathShare(ratio[j] / back.pdf[j]);
        addTo(to.whole, j, found);
        addTo(to.shared, j, shared);
        if (back.lobe->coat) addTo(to.coated, j, shared);
      }
  }
}

// Returns the transmittance between vertices and surfaces by colour. The rays run from the
// surfaces, as those of camera paths do, and pass what those pass straight on.
void traceConnections(const ConnectedSurfaces& surfaces, const LightVertices& vertices,
                      const Connections& to, float* const through[3]) {
  const RtsBatch& camera = surfaces.batch;
  const RenderScene& scene = camera.scene;
  Arena& arena = vertices.batch.arena;
  ArenaScope scope(arena);
  ShadowRays rays = allocateShadowRays(scene, to.count, arena, true);
  rays.toEmitters = !scene.kernel->cullsBacks(); // such a path is left to camera paths
  rays.hit = to.surface;
  uint32_t n = 0;
  for (uint32_t j = 0; j < to.count; j++) {
    if (!(largest(load(to.whole, j)) > 0)) continue;
    const uint32_t i = to.surface[j];
    const Vec3f origin = liftPoint(*camera.points, i, load(to.toVertex, j)),
                end = liftPoint(*vertices.batch.points, to.vertex[j], load(to.toSurface, j)),
                way = end - origin;
    const float distance = length(way);
    if (!(distance > 0)) continue;
    store(Vec3f{1, 1, 1}, through, j);
    store(origin, rays.rays.org, n);
    store(way / distance, rays.rays.dir, n);
    rays.rays.tnear[n] = 0;
    rays.rays.tfar[n] = distance * (1 - 0x1p-20f);
    if (rays.media)
      rays.media[n] = mediaTowards(*camera.points, i, load(to.toVertex, j), surfaces.boundaries,
                                   camera.states->media[camera.order[i]]);
    rays.lane[n++] = j;
  }
  rays.rays.count = n;
  traceTransmittance(camera, rays, through);
}

void addFinite(float* const sums[3], uint32_t i, const Vec3f& light) {
  if (isFinite(light)) addTo(sums, i, light);
}

} // namespace

void connectVertices(const ConnectedSurfaces& surfaces, const LightVertices& vertices) {
  if (vertices.count == 0) return;
  const RtsBatch& camera = surfaces.batch;
  ArenaScope scope(vertices.batch.arena);
  const Connections to = startConnections(surfaces, vertices);
  scatterAtBothEnds(surfaces, vertices, to);
  float* through[3];
  takeVectors(vertices.batch.arena, to.count, through);
  traceConnections(surfaces, vertices, to, through);
  for (uint32_t j = 0; j < to.count; j++) {
    const uint32_t i = to.surface[j];
    const Vec3f arriving =
        load(vertices.flux, j) * load(through, j) * (1 / (to.square[j] * to.connections[j]));
    addFinite(surfaces.sent.radiance, i, arriving * load(to.shared, j));
    if (surfaces.sent.coated[0]) addFinite(surfaces.sent.coated, i, arriving * load(to.coated, j));
    if (!surfaces.gain) continue;
    const Vec3f whole = load(to.whole, j), shared = load(to.shared, j);
    const Vec3d seen(load(camera.states->throughput, camera.order[i]) * arriving * whole);
    const double all = double(whole.x + whole.y + whole.z);
    if (all > 0) surfaces.gain->add(dot(seen, seen), double(shared.x + shared.y + shared.z) / all);
  }
}

} // namespace openrt
