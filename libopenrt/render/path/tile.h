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
#include "render/lights/unsampled_lights.h"
#include "render/path/first_hits.h"
#include "render/path/guided_rays.h"
#include "render/path/light_path_bound.h"
#include "render/path/spawn_rays.h"
#include "render/surface/sent_light.h"
#include "render/wave/light_stride.h"
#include "render/wave/pixel_samples.h"
#include "render/wave/random_numbers.h"
#include "render/wave/tiles.h"
#include "render/wave/wave.h"
#include "scene/quality.h"
#include "scene/transports.h"

namespace openrt {

struct RayPlaces;

class TileRenderer {
 public:
  explicit TileRenderer(const RenderScene& scene);
  // Adds the samples of one leaf (sums.h) to the sums of the tile's pixels, row by row. centred:
  // takes one sample in the middle of each pixel. Returns false if `stop` was set meanwhile; the
  // sums must then be discarded. hits: is given the names that the samples hit, if the frame needs
  // them; may be null.
  bool render(const Tile& tile, const Replicates& replicates, bool centred, uint32_t first,
              uint32_t samples, std::span<PixelSums> sums, const std::atomic<bool>& stop,
              HitCounts* hits = nullptr);
  // Maximum number of samples per pixel in a wave.
  static constexpr uint32_t largestWave = 32;
  // Ray counts since the last reset.
  RayCounters& counters() { return counters_; }
  // Energy left out by the last render().
  const Ledger& ledger() const { return ledger_; }
  // Tells a trial about all guided rays of camera paths from now on.
  void observe(GuideTrial* trial) { guided_.observe(trial); }
  // Returns the depth of the wave: the number of surfaces that its paths have hit before.
  uint32_t level() const { return level_; }
  // trace.cpp: services that shaders request from the renderer (RtsHost).
  void randomPoints(const RtsBatch& batch, uint32_t pair, float* const square[2]);
  void trace(RtsBatch& batch, const RtsRequest& request, float* const rgba[4]);
  void findHit(const RtsBatch& batch, const RtsRequest& request, RtsFound& out);
  void occluded(const RtsBatch& batch, const RtsRequest& request, float* const transmission[3]);

 private:
  void begin(const Tile& tile);
  void listPixels(const Tile& tile);
  bool stopped() const { return stop_->load(std::memory_order_relaxed); }
  bool has(uint32_t channel) const { return scene_.frame.channels & channel; }

  // Pixels of the tile with or without light, as positions in pixels_.
  struct PixelRange {
    uint32_t begin, end;
    bool light;
    uint32_t count() const { return end - begin; }
  };
  bool renderPixels(const PixelRange& range, uint32_t first, uint32_t samples);
  void renderWave(const PixelRange& range, uint32_t firstSample, uint32_t samples);
  void renderPaths(bool light, Wave& wave, PixelSamples& found);
  void describe(Wave& wave, PixelSamples& found);
  void follow(Wave& wave, PixelSamples& found);
  void traceWave(Wave& wave, PixelSamples& found);
  // measure.cpp: the first wave of RT_MEASURE_ILLUMINANCE.
  void measureIlluminance(const Wave& wave, PixelSamples& found);
  void noteFoundLight(uint32_t n, const PixelSamples& found);
  // tile_media.cpp: scenes with media that scatter.
  bool scattersInMedia() const { return !scene_.mediumLights.empty(); }
  void startInMedia(const Wave& wave);
  void describeBehindMedia(const Wave& wave, PixelSamples& found);
  void scatterInMedia(Wave& wave, PixelSamples& found);
  void addPhaseLobe(uint16_t medium, RtsBatch& batch) const;
  void gatherLamps(uint16_t medium, const Wave& wave, std::span<const uint32_t> flights,
                   PixelSamples& found);
  void scatterInMedium(uint16_t medium, const Wave& wave, const RayPlaces& collisions,
                       PixelSamples& found);
  void runTransportShader(const Rays& rays, PixelSamples& found);
  void addToPixels(const PixelRange& range, const PixelSamples& found, uint32_t firstSample,
                   uint32_t samples);
  // Add what a path has found first: of any sample, of sample 0.
  void addSurfaces(const PixelSamples& found, uint32_t path, PixelSums& sums);
  void addFirst(const PixelSamples& found, uint32_t path, PixelSums& sums);
  CameraPaths pathsOf(const RtsBatch& batch) {
    return {batch, level_, samples_, unsampled_, ledger_, next_};
  }
  // Returns the sampler's first pair of dimensions at the current surface. Pair 0 is the position
  // in the pixel.
  uint32_t firstPair() const { return pairAtLevel(1, level_); }

  // Shade the hits of a bucket, each as the value of Shading with its name says. A transport that
  // shades in a way of its own has a function here, in a file of its own.
  void shadeByShade(const Points& points, const Bucket& bucket, const PathStates& states,
                    PixelSamples& found);
  void shadeByLobes(const Points& points, const Bucket& bucket, const PathStates& states,
                    PixelSamples& found);
  static constexpr decltype(&TileRenderer::shadeByShade) shadings[] = {&TileRenderer::shadeByShade,
                                                                       &TileRenderer::shadeByLobes};
  static_assert(std::size(shadings) == size_t(Shading::count));
  void scatter(const Points& points, const Bucket& bucket, const PathStates& states,
               PixelSamples& found);
  SentLight sentLight(const RtsBatch& batch, const RtsSurface& surface);
  void gatherLight(RtsBatch& batch, const Boundaries& boundaries, const SentLight& sent);
  void continueFromLobes(RtsBatch& batch, const Boundaries& boundaries, const SentLight& sent);
  bool goesOn(const RtsBatch& batch, uint32_t i) const;
  bool samplesEmitters(const RtsBatch& batch) const;

  const RenderScene& scene_;
  const uint32_t width_; // width of the picture
  const RequiredSums required_;
  const std::atomic<bool>* stop_ = nullptr;
  Arena arena_;
  RayCounters counters_;
  Ledger ledger_;
  const StageContext context_{scene_, arena_, counters_, this, &ledger_};
  const bool showsNoLight_{showsNoLight(scene_.frame)};
  // 1 where there is no light to save, or a plug-in follows it
  const uint32_t lightStride_{
      showsNoLight_ || scene_.transport.shaderClass ? 1 : lightStrideOf(scene_.frame)};
  FirstHits firstHits_{scene_, arena_, counters_};
  UnsampledLights unsampled_{scene_, ledger_};
  Tile tile_;
  TileFootprint footprint_{}; // footprint of the tile; if light paths tell what it may lack
  // pixels_: y * width + x, in blocks of 4x4; places_: index in the tile, row by row. The first
  // `lit_` of them get light, the others do not (RT_LIGHT_STRIDE).
  std::vector<uint32_t> pixels_, places_;
  uint32_t lit_ = 0;
  std::span<PixelSums> sums_;
  HitCounts* hits_ = nullptr; // null if names are not counted
  Replicates replicates_;
  uint32_t leaf_ = 0; // first sample of the current leaf
  bool centred_ = false;
  PathSamples samples_{};    // samples of the paths in flight; inside trace() of the nested paths
  uint32_t nesting_ = 0;     // nesting depth of trace()
  float* lampLight_[3] = {}; // RT_MEASURE_ILLUMINANCE: what lamps without extent give, by path
  RayQueue queue_, next_;    // rays of the current wave, and of the next one
  GuidedRays guided_{context_};
  uint32_t level_ = 0; // depth of the current wave
};

} // namespace openrt
