#include "render/surface/surface_shader.h"

#include "shading/running.h"

namespace openrt {
namespace {

// Marks the hits whose surfaces have RTS_IRRADIANCE.
void markIrradiance(RtsBatch& batch) {
  const ShaderTable& shaders = *batch.scene.shaders;
  batch.irradiance = nullptr;
  if (!(shaders.allTraits() & RTS_IRRADIANCE)) return;
  const uint32_t n = batch.points->hits.count;
  auto* marks = batch.arena.take<uint8_t>(padded(n));
  uint8_t any = 0;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t record = batch.points->record[i]; // noHit: a place on no surface of the scene
    marks[i] = record < batch.scene.records.size() &&
               (shaders[batch.scene.records[record].shader].traits & RTS_IRRADIANCE) != 0;
    any |= marks[i];
  }
  if (any) batch.irradiance = marks;
}

} // namespace

RtsSurface runSurfaceShader(RtsBatch& batch, const RtsClass& shaderClass, bool albedo) {
  const RtsHits& hits = batch.points->hits;
  const uint32_t size = padded(hits.count);
  RtsSurface surface{};
  for (int k = 0; k < 3; k++) {
    surface.emission[k] = batch.arena.takeZero<float>(size);
    if (albedo) surface.albedo[k] = batch.arena.takeZero<float>(size);
  }
  const RunningShader running(shaderClass);
  shaderClass.surface(&batch.scene.host, &batch, &hits, &surface);
  markIrradiance(batch);
  return surface;
}

} // namespace openrt
