// path_tracer.h: the wavefront path tracer: follows paths until they end. Rays are processed in
// batches through intersection, sorting by shader, shading and shadow rays. Rays that continue a
// path are queued and form the next wave. [render]
//
// A tile (tile.h) has one path tracer. Where a shader traces rays (requests.h), a second one
// follows them, nested in the stage that runs the shader. Paths start in one of these ways:
//   PathTracer::trace   with rays of the camera or of a shader
//   measureIlluminance  at sensors (measure.h)
// A transport shader (transport_shader.h) and pixels without light (first_hits.h) use the context
// of the tracer alone.
#pragma once

#include <atomic>

#include "render/film/ledger.h"
#include "render/lights/unsampled_lights.h"
#include "render/path/guided_rays.h"
#include "render/path/light_connections.h"
#include "render/path/light_path_bound.h"
#include "render/path/spawn_rays.h"
#include "render/surface/sent_light.h"
#include "render/wave/pixel_samples.h"
#include "render/wave/random_numbers.h"
#include "render/wave/wave.h"
#include "scene/transports.h"

namespace openrt {

// Holds what the path tracers of one tile share. A render thread has one.
struct TilePaths {
  explicit TilePaths(const RenderScene& renderScene) : scene(renderScene) {}

  const RenderScene& scene;
  Arena arena;
  RayCounters counters;
  Ledger ledger;
  UnsampledLights unsampled{scene, ledger};
  TileFootprint footprint{}; // footprint of the tile; if light paths tell what it may lack
  const std::atomic<bool>* stop = nullptr;
  bool centred = false; // the paths are one sample in the middle of each pixel
};

class PathTracer {
 public:
  explicit PathTracer(TilePaths& tile) : tile_(tile) {}
  // Makes a tracer for rays that a shader traces while the outer tracer runs it. samples: of the
  // paths of these rays. level: number of surfaces that they have hit before.
  PathTracer(const PathTracer& outer, const PathSamples& samples, uint32_t level);
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  // Tell trials about all guided rays, and about all connections of light paths, from now on.
  void observe(GuideTrial* trial) { guided_.observe(trial); }
  void observe(LightPathGain* gain) { connections_.observe(gain); }
  // Begins with the samples of other paths, which have hit no surface.
  void begin(const PathSamples& samples);
  // Traces the rays of a wave, and then those that they spawn.
  void trace(Wave& wave, PixelSamples& found);
  // Traces the queued rays and those that they spawn, bounce by bounce, in portions of at most the
  // size of the wave.
  void follow(Wave& wave, PixelSamples& found);
  // Adds the light of emitters that the lobes of a batch send back, and spawns the rays that find
  // the rest. The lamps are not among the emitters.
  void continueFromLobes(const RtsBatch& batch, const Boundaries& boundaries,
                         const SentLight& sent);
  // Draws points of the unit square at the hits or camera rays of a batch, for a shader or for the
  // choice of a lamp.
  void randomPoints(const RtsBatch& batch, uint32_t pair, float* const square[2]) const;

  const StageContext& context() const { return context_; }
  const PathSamples& samples() const { return samples_; }
  // Returns the depth of the wave: the number of surfaces that its paths have hit before.
  uint32_t level() const { return level_; }
  // Returns the number of tracers around this one.
  uint32_t nesting() const { return nesting_; }
  // Returns the sampler's first pair of dimensions at the current surface. Pair 0 is the position
  // in the pixel.
  uint32_t firstPair() const { return pairAtLevel(1, level_); }

 private:
  bool stopped() const { return tile_.stop->load(std::memory_order_relaxed); }
  bool has(uint32_t channel) const { return scene_.frame.channels & channel; }
  CameraPaths pathsOf(const RtsBatch& batch) {
    return {batch, level_, samples_, tile_.unsampled, tile_.ledger, next_};
  }
  void traceWave(Wave& wave, PixelSamples& found);

  // Shade the hits of a bucket, each as its row of OPENRT_SHADINGS says. A transport that shades in
  // a way of its own has its function in a file of its own.
#define OPENRT_DECLARE_SHADING(name, function)                                                     \
  void function(const Points& points, const Bucket& bucket, const PathStates& states,              \
                PixelSamples& found);
  OPENRT_SHADINGS(OPENRT_DECLARE_SHADING)
#undef OPENRT_DECLARE_SHADING
#define OPENRT_LIST_SHADING(name, function) &PathTracer::function,
  static constexpr decltype(&PathTracer::shadeByShade) shadings[] = {
      OPENRT_SHADINGS(OPENRT_LIST_SHADING)};
#undef OPENRT_LIST_SHADING
  void scatter(const Points& points, const Bucket& bucket, const PathStates& states,
               PixelSamples& found);
  SentLight sentLight(const RtsBatch& batch, const RtsSurface& surface) const;
  bool goesOn(const RtsBatch& batch, uint32_t i) const;
  bool samplesEmitters(const RtsBatch& batch) const;

  TilePaths& tile_;
  const RenderScene& scene_{tile_.scene};
  const StageContext context_{tile_.scene, tile_.arena, tile_.counters, this, &tile_.ledger};
  PathSamples samples_{}; // samples of the paths in flight
  uint32_t level_ = 0;    // depth of the current wave
  uint32_t nesting_ = 0;
  RayQueue queue_, next_; // rays of the current wave, and of the next one
  GuidedRays guided_{context_};
  LightConnections connections_{context_};
};

} // namespace openrt
