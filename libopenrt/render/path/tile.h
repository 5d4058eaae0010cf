// tile.h: the wavefront path tracer: renders one tile of the picture on one thread. Rays are
// processed in batches through intersection, sorting by shader, shading and shadow rays. Rays that
// continue a path are queued and form the next wave. [render]
#pragma once

#include <atomic>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "render/film/ledger.h"
#include "render/film/sums.h"
#include "render/frame/tiles.h"
#include "render/path/path_states.h"
#include "render/path/random_numbers.h"
#include "render/surface/batch.h"
#include "render/surface/lobes.h"
#include "scene/transports.h"

namespace openrt {

struct Boundaries;

class TileRenderer {
 public:
  explicit TileRenderer(const RenderScene& scene);
  // Adds the samples of one leaf (sums.h) to the sums of the tile's pixels, row by row. centred:
  // takes one sample in the middle of each pixel. Returns false if `stop` was set meanwhile; the
  // sums must then be discarded.
  bool render(const Tile& tile, const Replicates& replicates, bool centred, uint32_t first,
              uint32_t samples, std::span<PixelSums> sums, const std::atomic<bool>& stop);
  // Maximum number of samples per pixel in a wave.
  static constexpr uint32_t largestWave = 32;
  // Ray counts since the last reset.
  RayCounters& counters() { return counters_; }
  // Energy left out by the last render().
  const Ledger& ledger() const { return ledger_; }
  // Returns the depth of the wave: the number of surfaces that its paths have hit before.
  uint32_t level() const { return level_; }
  // trace.cpp: services that shaders request from the renderer (RtsHost).
  void randomPoints(const RtsBatch& batch, uint32_t pair, float* const square[2]);
  void trace(RtsBatch& batch, const RtsRequest& request, float* const rgba[4]);
  void findHit(const RtsBatch& batch, const RtsRequest& request, RtsFound& out);
  void occluded(const RtsBatch& batch, const RtsRequest& request, float* const transmission[3]);

 private:
  struct Paths; // structure of arrays with one entry per path
  void begin(const Tile& tile);
  bool stopped() const { return stop_->load(std::memory_order_relaxed); }
  bool has(uint32_t channel) const { return scene_.frame.channels & channel; }
  void runTransportShader(Paths& paths);

  void loadRays(Paths& paths, size_t begin, uint32_t n);
  void traceWave(Paths& paths);
  void wave(uint32_t firstSample, uint32_t samples);
  void allocate(Paths& paths, uint32_t n, bool film);
  void follow(Paths& paths, uint32_t n);
  RtsBatch makeBatch();
  RtsBatch makeBatch(const Paths& paths, const Points& points, const uint32_t* order);
  void makeCameraRays(Paths& paths, uint32_t firstSample);
  void evaluateSky(const Rays& rays, const uint32_t* lanes, uint32_t n, float* direction[3],
                   float* rgba[4]);
  void addEnvironment(Paths& paths, const uint32_t* missed, uint32_t n);
  void shadeRange(Paths& paths, const RayHits& hits, const BucketRange& range,
                  const uint32_t* order);
  // Shade the hits of a bucket, each as the value of Shading with its name says. A transport that
  // shades in a way of its own has a function here, in a file of its own.
  void shadeByShade(Paths& paths, const Points& points, const Bucket& bucket,
                    const uint32_t* order);
  void shadeByLobes(Paths& paths, const Points& points, const Bucket& bucket,
                    const uint32_t* order);
  static constexpr decltype(&TileRenderer::shadeByShade) shadings[] = {&TileRenderer::shadeByShade,
                                                                       &TileRenderer::shadeByLobes};
  static_assert(std::size(shadings) == size_t(Shading::count));
  void addShading(const Points& points, const RtsShading& shaded, const uint32_t* order,
                  Paths& paths, const float* fog[4]);
  void storeFirstHit(const Points& points, uint32_t i, uint32_t path, float* const albedo[3],
                     Paths& paths);
  // scatter.cpp: shading of surfaces that are described by lobes (BSDFs).
  void scatterRange(Paths& paths, const Points& points, const Bucket& bucket,
                    const uint32_t* order);
  void addLights(RtsBatch& batch, const RtsHits& hits, float* const radiance[3]);
  struct NextRay { // a ray to be spawned at a hit
    float direction[3], weight[3], pdf;
    // twoSided: the lobes of the hit respond to light from both sides.
    bool deflected, split, twoSided;
    uint8_t channel;
    uint32_t branch;
    MediaStack media;
  };
  // Returns the sampler's first pair of dimensions at the current surface. Pair 0 is the position
  // in the pixel.
  uint32_t firstPair() const { return pairAtLevel(1, level_); }
  // Random decisions at the hits of a batch. Without path tracing every pointer is null.
  struct Sampling {
    RandomNumbers random;
    float* choices[2];                         // by hit: to select a sample, for Russian roulette
    const LobeSamples* samples[RTS_MAX_LOBES]; // by lobe; null for specular lobes
    // By lobe and hit: probability that the lobe's sample is followed. spawnRays() writes it, light
    // sampling reads it. Null if the lobe is specular or emitters are not sampled.
    float* selectionProbability[RTS_MAX_LOBES];
  };
  const LobeSamples* sampleLobe(const RtsBatch& batch, uint32_t l, const RandomNumbers& random);
  Sampling sampleLobes(const RtsBatch& batch, const Paths& paths, bool emitters);
  void continueAtOneLobe(const RtsBatch& batch, const Sampling& sampling, Paths& paths);
  void passThroughBoundary(const Points& points, uint32_t i, uint32_t lane,
                           const Crossing& crossing, Paths& paths);
  void spawnRays(const RtsBatch& batch, uint32_t i, const Sampling& sampling,
                 const Boundaries& boundaries, Paths& paths);
  // Returns whether the ray's hits on area lights are left to light tracing, so that only the sky
  // counts.
  bool canOnlyReachSky(PathFlags path) const {
    return scene_.lightSources && path.pathClass() == PathClass::caustic;
  }
  UnsampledLight& unsampledLightOf(PathFlags path) {
    return canOnlyReachSky(path) ? ledger_.unsampledSky : ledger_.unsampled;
  }
  double brightestFor(PathFlags path) const {
    return canOnlyReachSky(path) ? brightestSky_ : brightest_;
  }
  void push(const Points& points, uint32_t i, uint32_t lane, const NextRay& nextRay, Paths& paths);
  float emissionMisWeight(const PathStates& states, uint32_t lane, const Points& points,
                          uint32_t i) const;
  // emitted.cpp: light sampling of emissive surfaces and of the sky.
  LightSampleContext lightSampleContext(const Points& points, uint32_t i, bool twoSided) const;
  struct LightSamples; // the light samples of a batch
  LightSamples chooseLightSamples(const RtsBatch& batch, const Sampling& sampling);
  void weightLightSamples(const RtsBatch& batch, const Sampling& sampling, LightSamples& samples);
  void blockUncertain(const Rays& rays, const LightSample* lightSamples, uint8_t* blocked);
  template <class Add> void shadeSampledPoints(const Rays& rays, const LightSample* lightSamples,
                                               const uint32_t* lanes, uint32_t n, const Add& add);
  void sampleEmitters(const RtsBatch& batch, const Sampling& sampling, const Crossing* crossing,
                      float* const radiance[3]);
  void attenuate(const Points& points, const Paths& paths, const uint32_t* order, float* fog[4]);
  void addToPixels(const Paths& paths, uint32_t firstSample, uint32_t samples);

  const RenderScene& scene_;
  const uint32_t width_; // width of the picture
  const RequiredSums required_;
  // Largest radiance of all emitters, and of the sky alone, summed over the colours.
  const double brightest_, brightestSky_;
  const std::atomic<bool>* stop_ = nullptr;
  Arena arena_;
  RayCounters counters_;
  Ledger ledger_;
  Tile tile_;
  // pixels_: y * width + x, in blocks of 4x4; places_: index in the tile, row by row.
  std::vector<uint32_t> pixels_, places_;
  std::span<PixelSums> sums_;
  Replicates replicates_;
  uint32_t leaf_ = 0; // first sample of the current leaf
  bool centred_ = false;
  PathSamples samples_{}; // of the paths in flight; inside trace() those of the nested paths
  uint32_t nesting_ = 0;  // nesting depth of trace()
  RayQueue queue_, next_; // rays of the current wave, and of the next one
  uint32_t level_ = 0;    // depth of the current wave
};

} // namespace openrt
