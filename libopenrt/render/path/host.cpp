// host.cpp: the host functions that shaders call (openrts.h), each for one batch at a time.
// [render]
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/path/camera_connections.h"
#include "render/path/illumination.h"
#include "render/path/path_tracer.h"
#include "render/path/requests.h"
#include "render/surface/hit_info.h"
#include "render/wave/batch.h"
#include "shading/running.h"

namespace openrt {

void allocateLightArrays(RtsBatch& batch, uint32_t n) {
  if (batch.lights.reach) return;
  const uint32_t size = padded(n);
  for (auto* group :
       {batch.lights.local, batch.lights.toLight, batch.lights.color, batch.lights.ambient})
    for (int k = 0; k < 3; k++) group[k] = batch.arena.take<float>(size);
  batch.lights.reach = batch.arena.take<float>(size);
}

namespace {

uint32_t lights(RtsBatch* batch) { return lightCount(*batch); }
void illuminate(RtsBatch* batch, uint32_t i, const RtsHits* hits, RtsIllumination* out) {
  illuminateHits(*batch, i, *hits, *out);
}
void shadow(RtsBatch* batch, uint32_t i, const RtsHits* hits, const uint8_t* wanted,
            RtsIllumination* light) {
  shadowHits(*batch, i, *hits, wanted, *light);
}

void sample(RtsBatch* batch, RtsTexture texture, uint32_t n, const float* const uv[2],
            float* const rgba[4]) {
  const auto& textures = *batch->scene.textures;
  textures[texture < textures.size() ? texture : 0].sample(padded(n), uv, rgba);
}

void sampleVolume(RtsBatch* batch, RtsTexture texture, uint32_t n, const float* const str[3],
                  float* const rgba[4]) {
  const auto& textures = *batch->scene.textures;
  textures[texture < textures.size() ? texture : 0].sampleVolume(padded(n), str, rgba);
}

int pixels(RtsBatch* batch, uint32_t n, const float* const position[3], float* const xy[2]) {
  return pixelsOf(*batch, n, position, xy) ? 1 : 0;
}

uint32_t components(const RtsHost* host, RtsTexture texture) {
  const auto* textures = static_cast<const RenderHost*>(host)->textures;
  return textures && texture && texture < textures->size() ? (*textures)[texture].components() : 0;
}

float* scratch(RtsBatch* batch, uint32_t n) { return batch->arena.take<float>(padded(n)); }

RtsLobe* lobe(RtsBatch* batch, RtsLobeKind kind) {
  if (kind < RTS_LOBE_DIFFUSE || kind >= RTS_LOBE_CUSTOM) return nullptr;
  RtsLobe* added = batch->lobes.add();
  if (!added) return nullptr;
  const RtsHits& hits = batch->points->hits;
  const uint32_t size = padded(hits.count);
  RtsLobe& lobe = *added;
  lobe.kind = kind;
  for (int k = 0; k < 3; k++) {
    lobe.weight[k] = batch->arena.takeZero<float>(size);
    lobe.normal[k] = batch->arena.take<float>(size);
    std::copy_n(hits.normal[k], size, lobe.normal[k]);
  }
  for (auto& p : lobe.parameter) p = batch->arena.takeZero<float>(size);
  lobe.functions = nullptr;
  return &lobe;
}

RtsLobe* customLobe(RtsBatch* batch, const RtsLobeFunctions* functions, uint32_t floats) {
  if (!functions || functions->size < sizeof(RtsLobeFunctions) || !functions->evaluate ||
      !functions->sample || floats > RTS_MAX_LOBE_FLOATS)
    return nullptr;
  RtsLobe* made = lobe(batch, RTS_LOBE_DIFFUSE);
  if (!made) return nullptr;
  made->kind = RTS_LOBE_CUSTOM;
  made->functions = functions;
  for (uint32_t i = 0; i < floats; i++)
    made->data[i] = batch->arena.takeZero<float>(padded(batch->points->hits.count));
  return made;
}

void random(RtsBatch* batch, uint32_t pair, float* const square[2]) {
  if (batch->tracer && (batch->points || batch->lanes.cameraRays))
    return batch->tracer->randomPoints(*batch, pair, square);
  const uint32_t n = batch->points ? batch->hitCount() : batch->lanes.count;
  for (int k = 0; k < 2; k++) std::fill_n(square[k], n, 0.5f);
}

void trace(RtsBatch* batch, const RtsRequest* rays, float* const rgba[4]) {
  if (batch->tracer && !batch->describes) return traceRequest(*batch, *rays, rgba);
  for (int k = 0; k < 4; k++)
    if (rgba[k]) std::fill_n(rgba[k], rays->count, 0.0f);
}

void findHit(RtsBatch* batch, const RtsRequest* rays, RtsFound* out) {
  if (batch->tracer) return findRequest(*batch, *rays, *out);
  if (out->distance)
    std::fill_n(out->distance, rays->count, std::numeric_limits<float>::infinity());
}

void occluded(RtsBatch* batch, const RtsRequest* rays, float* const transmission[3]) {
  if (batch->tracer) return occludeRequest(*batch, *rays, transmission);
  for (int k = 0; k < 3; k++) std::fill_n(transmission[k], rays->count, 1.0f);
}

void local(RtsBatch* batch, float* const position[3], float* const normal[3]) {
  localOf(*batch, position, normal);
}
void derivatives(RtsBatch* batch, float* const alongS[3], float* const alongT[3]) {
  derivativesOf(*batch, alongS, alongT);
}
void ids(RtsBatch* batch, uint32_t* name, uint32_t* instance, uint32_t* primitive) {
  idsOf(*batch, name, instance, primitive);
}
void path(RtsBatch* batch, uint32_t* depth, float* const throughput[3]) {
  pathsOf(*batch, batch->tracer ? batch->tracer->level() : 0, depth, throughput);
}
void error(RtsBatch* batch, float* out) {
  if (!batch->points) return void(std::fill_n(out, batch->lanes.count, 0.0f));
  for (uint32_t i = 0; i < batch->hitCount(); i++) out[i] = batch->points->error[batch->pointOf(i)];
}

void backdrop(RtsBatch* batch, uint32_t* seen) {
  const uint32_t* straight = batch->lanes.straight;
  for (uint32_t i = 0; i < batch->lanes.count; i++) seen[i] = straight ? straight[i] : 0;
}

void log(const RtsHost* host, int level, const char* text) {
  const auto* self = static_cast<const RenderHost*>(host);
  if (self->logCallback) self->logCallback(level, text, self->logUser);
}

} // namespace

void fillHost(RtsHost& host) {
  host.size = sizeof(RtsHost);
  host.major = RTS_ABI_MAJOR;
  host.minor = RTS_ABI_MINOR;
  host.lights = lights;
  host.illuminate = illuminate;
  host.shadow = shadow;
  host.sample = sample;
  host.components = components;
  host.scratch = scratch;
  host.log = log;
  host.lobe = lobe;
  host.customLobe = customLobe;
  host.random = random;
  host.trace = trace;
  host.findHit = findHit;
  host.occluded = occluded;
  host.local = local;
  host.derivatives = derivatives;
  host.ids = ids;
  host.path = path;
  host.error = error;
  host.backdrop = backdrop;
  host.sampleVolume = sampleVolume;
  host.pixels = pixels;
}

} // namespace openrt
