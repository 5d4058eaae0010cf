#include "render/path/light_path_trial.h"

#include <algorithm>
#include <vector>

#include "render/lights/emitters.h"
#include "render/lights/light_path_weights.h"
#include "render/lights/light_sources.h"
#include "render/path/light_tracer.h"
#include "render/path/pixel_weights.h"
#include "render/path/tile.h"
#include "render/path/trial_blocks.h"
#include "render/wave/light_stride.h"
#include "scene/quality.h"
#include "scene/transports.h"

namespace openrt {
namespace {

// Pictures of fewer samples are previews.
constexpr uint32_t fewestSamples = 16;
constexpr uint32_t lightPaths = 4096, blocks = 32, samples = 8;
constexpr uint32_t trialSeed = 0x676c6f74u;
// The weights of light paths make a camera path cost about so much more.
constexpr double costOfWeights = 1.1;

bool canTrace(const RenderScene& scene) {
  const edit::FrameSettingsT& frame = scene.frame;
  const RtsClass* camera = scene.camera.shader.shaderClass;
  return tracesLamps(frame.transport) && !showsNoLight(frame) && frame.samples >= fewestSamples &&
         frame.measure == RT_MEASURE_NOTHING && lightStrideOf(frame) == 1 && camera &&
         camera->project && scene.mediumLights.empty() && !scene.transport.shaderClass;
}

// Worlds with culled backs and clear things share nothing: clear sheets of one side pass other
// light in one direction than in the other.
bool canShare(const RenderScene& scene) {
  return !(scene.kernel->cullsBacks() && scene.transparentShadows);
}

double raysOf(const RayCounters& counters) {
  return double(counters.camera + counters.secondary + counters.shadow);
}

// Rays of one camera path and, in the mean over the pixels and by their weights, its variance and
// what connections are worth; colours are summed.
struct CameraTrial {
  double variance = 0, rays = 0;
  LightPathGain connections;
};

// Traces camera paths and light paths before a frame.
class Trial {
 public:
  Trial(RenderScene& scene, const std::atomic<bool>& stop) : scene_(scene), stop_(stop) {}
  // Traces camera paths in blocks of pixels. The first call also finds the weights of pixels.
  CameraTrial tryCameraPaths();
  // Traces light paths from sources. rays: gets their number for each camera path, where there are
  // `cameras` camera paths for a light path. Each number tells of other paths.
  LightPathGain tryLightPaths(const LightSources& sources, uint32_t cameras, double& rays,
                              uint32_t number = 0) {
    LightTracer tracer(scene_);
    const LightPathGain gain =
        tracer.tryPaths(sources, lightPaths, trialSeed + number, weights_, stop_);
    rays = raysOf(tracer.counters()) / (lightPaths * cameras);
    return gain;
  }

 private:
  struct Block {
    double radiance = 0, variance = 0; // in the mean over its pixels
    LightPathGain connections;
  };
  Block render(TileRenderer& renderer, const Tile& tile);

  RenderScene& scene_;
  const std::atomic<bool>& stop_;
  PixelWeights weights_;
  std::vector<PixelSums> sums_;
};

Trial::Block Trial::render(TileRenderer& renderer, const Tile& tile) {
  Block out;
  renderer.observe(&out.connections);
  sums_.assign(tile.pixels(), {});
  renderer.render(tile, Replicates{trialSeed}, false, 0, samples, sums_, stop_);
  for (const PixelSums& pixel : sums_)
    for (int k = 0; k < 3; k++) {
      out.radiance += pixel.rgba[k] / samples;
      out.variance += (pixel.delta2[k] - pixel.delta[k] * pixel.delta[k] / samples) / (samples - 1);
    }
  const auto pixels = double(tile.pixels());
  out.radiance /= pixels;
  out.variance /= pixels;
  for (double* moment : {&out.connections.camera, &out.connections.both})
    *moment /= pixels * samples;
  return out;
}

CameraTrial Trial::tryCameraPaths() {
  const edit::FrameSettingsT settings = scene_.frame;
  prepareTrial(scene_.frame);
  TileRenderer renderer(scene_);
  std::vector<Block> rendered;
  double pixels = 0;
  const bool first = weights_.empty();
  for (uint32_t b = 0; b < blocks && !stop_; b++) {
    const Tile tile = trialBlock(settings, b);
    rendered.push_back(render(renderer, tile));
    if (first) weights_.add(tile, rendered.back().radiance);
    pixels += double(tile.pixels());
  }
  scene_.frame = settings;
  CameraTrial out;
  if (stop_) return out;
  if (first) weights_.finish();
  for (uint32_t b = 0; b < blocks; b++) {
    const double weight = weights_.ofBlock(b) / blocks;
    out.variance += rendered[b].variance * weight;
    out.connections.camera += rendered[b].connections.camera * weight;
    out.connections.both += rendered[b].connections.both * weight;
  }
  out.rays = raysOf(renderer.counters()) / (pixels * samples);
  return out;
}

// The variance and the rays of one sample of a pixel, with what has been taken so far.
struct Expectation {
  double variance, rays;
  double lightRays = 0;  // rays of the light paths that begin at mirrors and glass
  bool weighted = false; // camera paths have weights

  // Takes a sharing if that lowers the product. without, with: the second moments of the light that
  // may be shared. more: the rays that it adds.
  bool take(double without, double with, double more) {
    const double then = rays * (weighted ? 1 : costOfWeights) + more;
    const bool pays =
        (variance + with) * (then + lightRays) < (variance + without) * (rays + lightRays);
    variance += pays ? with : without;
    if (pays) rays = then;
    weighted |= pays;
    return pays;
  }
  // Takes a number of light paths for each camera path, and returns it. light: the part of the
  // variance that falls with it. Twice as many have to lower the product by a tenth.
  uint32_t takeLightPaths(double light) {
    constexpr uint32_t most = 8;
    const double others = variance - light;
    const auto product = [&](uint32_t number) {
      return (others + light / number) * (rays + lightRays * number);
    };
    uint32_t number = 1;
    while (number < most && product(2 * number) < .9 * product(number)) number *= 2;
    variance = others + light / number;
    lightRays *= number;
    return number;
  }
};

// Decides about the light paths that begin at mirrors and glass. Where a target error or a time
// limit leaves the number of camera paths open, light paths are traced first, and one of them goes
// with a camera path.
void chooseMirrorPaths(RenderScene& scene, Trial& trial, Expectation& expected) {
  const edit::FrameSettingsT& frame = scene.frame;
  const EmissiveShapes* shapes = scene.emitters->shapes();
  const bool sharable = shapes && !shapes->empty() && canShare(scene);
  scene.sharesMirrors = sharable; // the light paths are traced in any case
  const LightPathGain gain = trial.tryLightPaths(*scene.lightSources, 1, expected.lightRays);
  if (sharable)
    scene.sharesMirrors = expected.take(gain.light, gain.both, 0);
  else
    expected.variance += gain.light;
  if (frame.targetError > 0 || frame.timeLimit > 0) return;
  // The smaller of two results counts: a single bright path must not decide.
  const bool shared = scene.sharesMirrors;
  scene.sharesMirrors = sharable;
  const LightPathGain again = trial.tryLightPaths(*scene.lightSources, 1, expected.lightRays, 1);
  scene.sharesMirrors = shared;
  scene.lightPathsOfCameraPath = expected.takeLightPaths(
      shared ? std::min(gain.ofLight, again.ofLight) : std::min(gain.light, again.light));
}

// Forgets what was decided.
void shareNothing(RenderScene& scene) {
  scene.sharesMirrors = scene.showsGlossy = scene.connectsGlossy = false;
  scene.lightPathsOfCameraPath = 1;
}

} // namespace

bool tryLightPaths(RenderScene& scene, const std::atomic<bool>& stop) {
  scene.glossySources = nullptr;
  shareNothing(scene);
  if (!canTrace(scene)) return true;
  const auto sources =
      std::make_shared<const LightSources>(scene, nullptr, LightSources::Kind::glossy);
  const bool glossy = canShare(scene) && !sources->empty();
  if (!scene.lightSources && !glossy) return true;
  Trial trial(scene, stop);
  const CameraTrial camera = trial.tryCameraPaths();
  if (stop) return false;
  Expectation expected{camera.variance, camera.rays};
  if (scene.lightSources) chooseMirrorPaths(scene, trial, expected);
  if (glossy) {
    double rays = 0;
    scene.glossySources = sources;
    scene.showsGlossy = true;
    const LightPathGain gain = trial.tryLightPaths(*sources, camerasPerGlossyPath, rays);
    const bool shows = expected.take(gain.camera, gain.both, rays);
    scene.showsGlossy = false;
    scene.connectsGlossy = true;
    const CameraTrial connected = trial.tryCameraPaths();
    const LightPathGain& more = connected.connections;
    scene.connectsGlossy = expected.take(more.camera, more.both, connected.rays - camera.rays);
    scene.showsGlossy = shows;
  }
  if (stop) shareNothing(scene);
  if (!scene.showsGlossy && !scene.connectsGlossy) scene.glossySources = nullptr;
  return !stop;
}

} // namespace openrt
