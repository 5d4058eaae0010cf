#include "render/surface/surface_shader.h"

#include "shading/running.h"

namespace openrt {

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
  return surface;
}

} // namespace openrt
