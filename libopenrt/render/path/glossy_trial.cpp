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

// Traces camera paths in blocks of pixels, and tells the rays of one camera path and, in the mean
// over the pixels, its variance and what connections are worth; colours are summed.
struct CameraTrial {
  double variance = 0, rays = 0;
  GlossyGain connections;
};

CameraTrial tryCameraPaths(RenderScene& scene, const std::atomic<bool>& stop) {
  const edit::FrameSettingsT settings = scene.frame;
  prepareTrial(scene.frame);
  TileRenderer renderer(scene);
  CameraTrial out;
  renderer.observe(&out.connections);
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
  for (double* moment : {&out.connections.without, &out.connections.with})
    *moment /= pixels * samples;
  return out;
}

// The variance and the rays of a pixel's samples. Light paths that are worth their rays change
// them.
struct Expectation {
  double variance, rays;

  bool take(const GlossyGain& gain, double variantRays) {
    const bool pays = (variance + gain.with) * variantRays < (variance + gain.without) * rays;
    variance += pays ? gain.with : gain.without;
    if (pays) rays = variantRays;
    return pays;
  }
};

} // namespace

bool tryGlossyPaths(RenderScene& scene, const std::atomic<bool>& stop) {
  scene.glossySources = nullptr;
  scene.showsGlossy = scene.connectsGlossy = false;
  if (!canTrace(scene)) return true;
  const auto sources =
      std::make_shared<const LightSources>(scene, nullptr, LightSources::Kind::glossy);
  if (sources->empty()) return true;
  const CameraTrial camera = tryCameraPaths(scene, stop);
  if (stop) return false;
  scene.glossySources = sources;
  scene.showsGlossy = true;
  LightTracer tracer(scene);
  const GlossyGain shown = tracer.tryGlossy(lightPaths, trialSeed, stop);
  const double lightRays = raysOf(tracer.counters()) / (lightPaths * camerasPerGlossyPath);
  Expectation one{camera.variance, camera.rays};
  const bool shows = one.take(shown, camera.rays * costOfWeights + lightRays);
  scene.showsGlossy = false;
  scene.connectsGlossy = true;
  const CameraTrial connected = tryCameraPaths(scene, stop);
  const double more = connected.rays - camera.rays;
  const bool connects =
      more > 0 && one.take(connected.connections, one.rays * (shows ? 1 : costOfWeights) + more);
  scene.showsGlossy = !stop && shows;
  scene.connectsGlossy = !stop && connects;
  if (!scene.showsGlossy && !scene.connectsGlossy) scene.glossySources = nullptr;
  return !stop;
}

} // namespace openrt
