#include "render/path/photon_pass.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "render/film/error.h"
#include "render/lights/light_sources.h"
#include "render/path/light_tracer.h"
#include "render/path/tile.h"
#include "render/path/trial_blocks.h"
#include "render/wave/sampler.h"
#include "scene/quality.h"
#include "scene/transports.h"

namespace openrt {
namespace {

constexpr uint32_t fewestSamples = 16;
// One light path for so many camera paths, within bounds.
constexpr uint64_t cameraPaths = 8, fewestPaths = 1u << 13, mostPaths = 1u << 16;
// One path of the trial for so many camera paths, within bounds. Blocks of pixels are tried.
constexpr uint64_t trialShare = 32, fewestBlocks = 4, mostBlocks = 32;
constexpr uint32_t trialSamples = 16;
// Keep the light paths and the trial apart from those of the picture.
constexpr uint32_t photonSeed = 0x70686f74u, trialSeed = 0x74726961u;

uint64_t cameraPathsOf(const edit::FrameSettingsT& frame) {
  return uint64_t(frame.width) * frame.height * frame.samples;
}

uint64_t pathsOf(const edit::FrameSettingsT& frame) {
  return std::clamp(cameraPathsOf(frame) / cameraPaths, fewestPaths, mostPaths);
}

uint64_t blocksOf(const edit::FrameSettingsT& frame) {
  return std::clamp(cameraPathsOf(frame) /
                        (trialShare * trialBlockEdge * trialBlockEdge * trialSamples),
                    fewestBlocks, mostBlocks);
}

// Returns the shares of the cells.
std::vector<float> tryGuide(RenderScene& scene, const std::atomic<bool>& stop) {
  const edit::FrameSettingsT settings = scene.frame;
  prepareTrial(scene.frame);
  GuideTrial trial(scene.photonGuide->cells());
  TileRenderer renderer(scene);
  renderer.observe(&trial);
  const Replicates replicates{hash(settings.seed, trialSeed)};
  const uint64_t blocks = blocksOf(settings);
  std::vector<PixelSums> sums;
  for (uint32_t b = 0; b < blocks && !stop; b++) {
    const Tile tile = trialBlock(settings, b);
    sums.assign(tile.pixels(), {});
    renderer.render(tile, replicates, false, 0, trialSamples, sums, stop);
    trial.endBlock(sums);
  }
  scene.frame = settings;
  return trial.choose(renderer.counters(), wantsError(settings));
}

} // namespace

uint64_t photonsOf(const edit::FrameSettingsT& frame) {
  return pathsOf(frame) << 32 | blocksOf(frame);
}

bool guideByPhotons(RenderScene& scene, const std::atomic<bool>& stop) {
  scene.photonGuide = nullptr;
  scene.lightPathFlux = 0;
  const edit::FrameSettingsT& frame = scene.frame;
  if (!tracesPaths(frame.transport) || showsNoLight(frame) || frame.samples < fewestSamples ||
      frame.measure != RT_MEASURE_NOTHING || !scene.mediumLights.empty() ||
      scene.transport.shaderClass || !scene.camera.shader.shaderClass)
    return true;
  const LightSources sources(scene, &scene, LightSources::Kind::emitters);
  if (sources.empty()) return true;
  const uint64_t paths = pathsOf(frame);
  LightTracer tracer(scene);
  std::vector<Photon> photons =
      tracer.tracePhotons(sources, uint32_t(paths), hash(frame.seed, photonSeed), stop);
  if (stop) return false;
  // With error bars every cell sends guided rays, so that the picture lacks none of the light that
  // light paths have found.
  const double flux = wantsError(frame) ? tracer.largestFlux() / double(paths) : 0;
  if (photons.empty()) scene.lightPathFlux = flux;
  const auto guide = std::make_shared<PhotonGuide>(std::move(photons));
  if (guide->empty()) return true;
  scene.photonGuide = guide;
  const std::vector<float> shares = tryGuide(scene, stop);
  if (!stop) guide->setShares(shares);
  if (stop || guide->empty())
    scene.photonGuide = nullptr;
  else
    scene.lightPathFlux = flux;
  return !stop;
}

} // namespace openrt
