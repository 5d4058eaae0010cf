#include "render/path/glossy_trial.h"

#include <vector>

#include "render/lights/light_sources.h"
#include "render/path/light_path_ratios.h"
#include "render/path/light_tracer.h"
#include "render/path/tile.h"
#include "render/path/trial_blocks.h"
#include "render/wave/light_stride.h"
#include "scene/quality.h"
#include "scene/transports.h"

namespace openrt {
namespace {

// Pictures of fewer samples are previews.
constexpr uint32_t fewestSamples = 16;
constexpr uint32_t lightPaths = 4096, blocks = 16, samples = 16;
constexpr uint32_t trialSeed = 0x676c6f74u;
// The weights of light paths make a camera path cost about so much more.
constexpr double costOfWeights = 1.1;

// Worlds with culled backs and clear things have no such paths: clear sheets of one side pass other
// light in one direction than in the other.
bool canTrace(const RenderScene& scene) {
  const edit::FrameSettingsT& frame = scene.frame;
  const RtsClass* camera = scene.camera.shader.shaderClass;
  return tracesLamps(frame.transport) && !showsNoLight(frame) && frame.samples >= fewestSamples &&
         frame.measure == RT_MEASURE_NOTHING && lightStrideOf(frame) == 1 && camera &&
         camera->project && scene.mediumLights.empty() && !scene.transport.shaderClass &&
         !(scene.kernel->cullsBacks() && scene.transparentShadows);
}

double raysOf(const RayCounters& counters) {
  return double(counters.camera + counters.secondary + counters.shadow);
}

// The variance and the rays of one camera path: the mean over the pixels, colours summed.
struct CameraTrial {
  double variance = 0, rays = 0;
};

CameraTrial tryCameraPaths(RenderScene& scene, const std::atomic<bool>& stop) {
  const edit::FrameSettingsT settings = scene.frame;
  prepareTrial(scene.frame);
  TileRenderer renderer(scene);
  CameraTrial out;
  double pixels = 0;
  std::vector<PixelSums> sums;
  for (uint32_t b = 0; b < blocks && !stop; b++) {
    const Tile tile = trialBlock(settings, b);
    sums.assign(tile.pixels(), {});
    renderer.render(tile, Replicates{trialSeed}, false, 0, samples, sums, stop);
    for (const PixelSums& pixel : sums) {
      for (int k = 0; k < 3; k++)
        out.variance +=
            (pixel.delta2[k] - pixel.delta[k] * pixel.delta[k] / samples) / (samples - 1);
      pixels++;
    }
  }
  scene.frame = settings;
  out.variance /= pixels;
  out.rays = raysOf(renderer.counters()) / (pixels * samples);
  return out;
}

} // namespace

bool tryGlossyPaths(RenderScene& scene, const std::atomic<bool>& stop) {
  scene.glossySources = nullptr;
  if (!canTrace(scene)) return true;
  const auto sources =
      std::make_shared<const LightSources>(scene, nullptr, LightSources::Kind::glossy);
  if (sources->empty()) return true;
  const CameraTrial camera = tryCameraPaths(scene, stop);
  if (stop) return false;
  scene.glossySources = sources;
  LightTracer tracer(scene);
  const GlossyGain gain = tracer.tryGlossy(lightPaths, trialSeed, stop);
  const double lightRays = raysOf(tracer.counters()) / (lightPaths * camerasPerGlossyPath),
               rays = camera.rays * costOfWeights + lightRays,
               without = (camera.variance + gain.without) * camera.rays,
               with = (camera.variance + gain.with) * rays;
  if (stop || !(with < without)) scene.glossySources = nullptr;
  return !stop;
}

} // namespace openrt
