#include "render/path/photon_pass.h"

#include <algorithm>

#include "render/lights/light_sources.h"
#include "render/path/guides.h"
#include "render/path/light_tracer.h"
#include "render/path/sampler.h"
#include "scene/transports.h"

namespace openrt {
namespace {

constexpr uint32_t fewestSamples = 16;
// One light path for so many camera paths, within bounds.
constexpr uint64_t cameraPaths = 64, fewestPaths = 1u << 12, mostPaths = 1u << 16;
// Keeps the light paths apart from those of the picture.
constexpr uint32_t photonSeed = 0x70686f74u;

} // namespace

std::shared_ptr<const PhotonGuide> makePhotonGuide(const RenderScene& scene,
                                                   const RenderScene* before) {
  const edit::FrameSettingsT& frame = scene.frame;
  const EmissiveShapes* shapes = scene.emitters.shapes();
  if (!tracesPaths(frame.transport) || showsNoLight(frame) || frame.samples < fewestSamples ||
      scene.transport.shaderClass || !scene.camera.shader.shaderClass || !shapes || shapes->empty())
    return nullptr;
  const LightSources sources(scene, before, LightSources::Kind::shapes);
  if (sources.empty()) return nullptr;
  const uint64_t paths = uint64_t(frame.width) * frame.height * frame.samples / cameraPaths;
  LightTracer tracer(scene, sources);
  auto guide = std::make_shared<const PhotonGuide>(tracer.tracePhotons(
      uint32_t(std::clamp(paths, fewestPaths, mostPaths)), hash(frame.seed, photonSeed)));
  return guide->empty() ? nullptr : guide;
}

} // namespace openrt
