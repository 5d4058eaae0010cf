#include "render/path/light_path_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>
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
  // Traces camera paths in blocks of pixels. The first call also tells the brightness of these.
  void traceCameraPaths();
  // Traces light paths from sources. rays: gets their number for each camera path, where there are
  // `cameras` camera paths for a light path. Each number tells of other paths.
  std::vector<LightPathFind> traceLightPaths(const LightSources& sources, uint32_t cameras,
                                             double& rays, uint32_t number = 0) const;
  // Makes some finds the light by which errors are weighed. paths: light paths that have made them.
  void setLight(std::vector<LightPathFind> finds, double paths) {
    const edit::FrameSettingsT& frame = scene_.frame;
    weights_.setLight({std::move(finds), paths, double(frame.width), double(frame.height)});
  }

  // Return what the camera paths of the last call, and light paths, tell.
  CameraTrial camera() const;
  LightPathGain gainOf(const std::vector<LightPathFind>& finds, uint32_t cameras) const;

 private:
  struct Block {
    double radiance = 0, variance = 0; // in the mean over its pixels
    LightPathGain connections;
  };
  Block render(TileRenderer& renderer, const Tile& tile);

  RenderScene& scene_;
  const std::atomic<bool>& stop_;
  PixelWeights weights_;
  std::vector<Block> blocks_;
  double rays_ = 0; // a camera path has so many
  std::vector<PixelSums> sums_[2];
};

// Two pictures of a block with different seeds tell its variance with that number of samples, which
// is lower than that of independent samples. A pixel counts relative to its own brightness where
// that is above the mean: the edge of a lamp, or one bright sample, must not decide.
Trial::Block Trial::render(TileRenderer& renderer, const Tile& tile) {
  Block out;
  renderer.observe(&out.connections);
  for (uint32_t s = 0; s < 2; s++) {
    sums_[s].assign(tile.pixels(), {});
    renderer.render(tile, Replicates{trialSeed + s}, false, 0, samples, sums_[s], stop_);
  }
  const auto pixels = double(tile.pixels());
  std::vector<double> radiance(sums_[0].size()), variance(sums_[0].size());
  for (size_t p = 0; p < radiance.size(); p++) {
    for (int k = 0; k < 3; k++) {
      const double a = sums_[0][p].rgba[k], b = sums_[1][p].rgba[k];
      radiance[p] += (a + b) / (2 * samples);
      variance[p] += (a - b) * (a - b) / (2 * samples);
    }
    out.radiance += radiance[p] / pixels;
  }
  for (size_t p = 0; p < radiance.size(); p++) {
    const double darker = radiance[p] > out.radiance ? out.radiance / radiance[p] : 1;
    out.variance += variance[p] * darker * darker / pixels;
  }
  for (double* moment : {&out.connections.camera, &out.connections.both})
    *moment /= 2 * pixels * samples;
  return out;
}

void Trial::traceCameraPaths() {
  const edit::FrameSettingsT settings = scene_.frame;
  prepareTrial(scene_.frame);
  TileRenderer renderer(scene_);
  const bool first = weights_.empty();
  double pixels = 0;
  blocks_.clear();
  for (uint32_t b = 0; b < blocks && !stop_; b++) {
    const Tile tile = trialBlock(settings, b);
    blocks_.push_back(render(renderer, tile));
    if (first) weights_.add(tile, blocks_.back().radiance);
    pixels += double(tile.pixels());
  }
  scene_.frame = settings;
  rays_ = raysOf(renderer.counters()) / (2 * pixels * samples);
}

std::vector<LightPathFind> Trial::traceLightPaths(const LightSources& sources, uint32_t cameras,
                                                  double& rays, uint32_t number) const {
  LightTracer tracer(scene_);
  std::vector<LightPathFind> finds =
      tracer.tryPaths(sources, lightPaths, trialSeed + number, stop_);
  rays = raysOf(tracer.counters()) / (lightPaths * cameras);
  return finds;
}

CameraTrial Trial::camera() const {
  CameraTrial out{.rays = rays_};
  for (size_t b = 0; b < blocks_.size(); b++) {
    const double weight = weights_.ofBlock(b) / double(blocks_.size());
    out.variance += blocks_[b].variance * weight;
    out.connections.camera += blocks_[b].connections.camera * weight;
    out.connections.both += blocks_[b].connections.both * weight;
  }
  return out;
}

LightPathGain Trial::gainOf(const std::vector<LightPathFind>& finds, uint32_t cameras) const {
  const double pixels = double(scene_.frame.width) * scene_.frame.height,
               scale = cameras / (pixels * pixels * lightPaths);
  LightPathGain gain;
  for (const LightPathFind& f : finds) gain.add(f.square * scale * weights_.at(f.x, f.y), f.share);
  return gain;
}

// The variance and the rays of one sample of a pixel, with what has been taken so far.
struct Expectation {
  double variance = 0, rays = 0;
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
  // variance that falls with it. Twice as many have to lower the product by three tenths: a trial
  // finds few of the rare bright samples of camera paths.
  uint32_t takeLightPaths(double light) {
    constexpr uint32_t most = 8;
    const double others = variance - light;
    const auto product = [&](uint32_t number) {
      return (others + light / number) * (rays + lightRays * number);
    };
    uint32_t number = 1;
    while (number < most && product(2 * number) < .7 * product(number)) number *= 2;
    variance = others + light / number;
    lightRays *= number;
    return number;
  }
};

// Decides about the light paths that begin at mirrors and glass. Two halves of them weigh each
// other: where a half has found one bright path alone, it would take the place for bright. Where a
// target error or a time limit leaves the number of camera paths open, light paths are traced
// first, and one of them goes with a camera path.
void chooseMirrorPaths(RenderScene& scene, Trial& trial, Expectation& expected) {
  const edit::FrameSettingsT& frame = scene.frame;
  const EmissiveShapes* shapes = scene.emitters->shapes();
  const bool sharable = shapes && !shapes->empty() && canShare(scene);
  scene.sharesMirrors = sharable; // the light paths are traced in any case
  std::vector<LightPathFind> finds[2];
  for (uint32_t h = 0; h < 2; h++)
    finds[h] = trial.traceLightPaths(*scene.lightSources, 1, expected.lightRays, h);
  LightPathGain halves[2];
  for (uint32_t h = 0; h < 2; h++) {
    trial.setLight(finds[1 - h], lightPaths);
    halves[h] = trial.gainOf(finds[h], 1);
  }
  // The smaller result counts: a single bright path must not decide.
  const LightPathGain& gain = halves[halves[1].light < halves[0].light];
  finds[0].insert(finds[0].end(), finds[1].begin(), finds[1].end());
  trial.setLight(std::move(finds[0]), 2 * lightPaths);
  expected.variance = trial.camera().variance;
  if (sharable)
    scene.sharesMirrors = expected.take(gain.light, gain.both, 0);
  else
    expected.variance += gain.light;
  if (frame.targetError > 0 || frame.timeLimit > 0) return;
  scene.lightPathsOfCameraPath =
      expected.takeLightPaths(scene.sharesMirrors ? gain.ofLight : gain.light);
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
  trial.traceCameraPaths();
  if (stop) return false;
  trial.setLight({}, 1);
  const CameraTrial camera = trial.camera();
  Expectation expected{camera.variance, camera.rays};
  if (scene.lightSources) chooseMirrorPaths(scene, trial, expected);
  if (glossy) {
    double rays = 0;
    scene.glossySources = sources;
    scene.showsGlossy = true;
    const std::vector<LightPathFind> finds =
        trial.traceLightPaths(*sources, camerasPerGlossyPath, rays);
    const LightPathGain gain = trial.gainOf(finds, camerasPerGlossyPath);
    const bool shows = expected.take(gain.camera, gain.both, rays);
    scene.showsGlossy = false;
    scene.connectsGlossy = true;
    trial.traceCameraPaths();
    const CameraTrial connected = trial.camera();
    const LightPathGain& more = connected.connections;
    scene.connectsGlossy = expected.take(more.camera, more.both, connected.rays - camera.rays);
    scene.showsGlossy = shows;
  }
  if (stop) shareNothing(scene);
  if (!scene.showsGlossy && !scene.connectsGlossy) scene.glossySources = nullptr;
  return !stop;
}

} // namespace openrt
