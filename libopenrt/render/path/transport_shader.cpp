#include "render/path/transport_shader.h"

#include <cmath>

#include "render/surface/sanitize_output.h"
#include "shading/running.h"

namespace openrt {

void runTransportShader(const StageContext& context, const Rays& rays, PixelSamples& found) {
  const ShaderSlot& transport = context.scene.transport;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  const uint32_t n = rays.count;
  float* rgba[4];
  for (auto& a : rgba) a = arena.takeZero<float>(padded(n));
  RtsRequest request{};
  request.count = n;
  request.hit = arena.takeNumbers(n);
  for (int k = 0; k < 3; k++) {
    request.origin[k] = rays.org[k];
    request.direction[k] = rays.dir[k];
  }
  RtsBatch batch(context);
  batch.lanes = {.count = n, .cameraRays = true};
  {
    const RunningShader running(*transport.shaderClass);
    transport.shaderClass->radiance(&context.scene.host, &batch, transport.params, &request, rgba);
  }
  sanitizeOutput(*transport.shaderClass, batch, n, {rgba[0], rgba[1], rgba[2], rgba[3]});
  for (uint32_t i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++)
      if (std::isfinite(rgba[k][i])) found.radiance[k][i] = rgba[k][i];
    if (std::isfinite(rgba[3][i])) found.alpha[i] = rgba[3][i];
  }
}

} // namespace openrt
