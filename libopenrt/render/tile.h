// tile.h: the wavefront: renders one tile of the picture on one thread. A tile's samples go through intersection, sorting by
// shader, shading and shadow rays in batches; paths that go on are compacted and make the next wave. [render]
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "render/batch.h"
#include "render/ledger.h"
#include "render/lobes.h"
#include "render/ray_queue.h"
#include "render/sums.h"
#include "render/tiles.h"

namespace openrt {

struct Boundaries;

class TileRenderer {
 public:
  explicit TileRenderer(const RenderScene& scene);
  // Adds a leaf's samples (sums.h) to the sums of a tile's pixels, row by row. centred: one sample, in the middle of each pixel.
  // False: the flag was set meanwhile, and nothing of the sums is of use.
  bool render(const Tile& tile, const Replicates& replicates, bool centred, uint32_t first, uint32_t samples,
              std::span<PixelSums> sums, const std::atomic<bool>& stop);
  // Samples of a wave, at most.
  static constexpr uint32_t largestWave = 32;
  // Since they were emptied.
  RayCounters& counters() { return counters_; }
  // Of the samples that the last render() has taken.
  const Ledger& ledger() const { return ledger_; }
  uint32_t level() const { return level_; } // surfaces that the rays of the wave have met before
  // trace.cpp: what shaders ask of the renderer (RtsHost).
  void randomPoints(const RtsBatch& batch, uint32_t pair, float* const square[2]);
  void trace(RtsBatch& batch, const RtsRequest& request, float* const rgba[4]);
  void findHit(const RtsBatch& batch, const RtsRequest& request, RtsFound& out);
  void occluded(const RtsBatch& batch, const RtsRequest& request, float* const transmission[3]);

 private:
  struct Paths; // structure of arrays, one entry a path
  void begin(const Tile& tile);
  bool stopped() const { return stop_->load(std::memory_order_relaxed); }
  bool has(uint32_t channel) const { return scene_.frame.channels & channel; }
  void askTransport(Paths& paths);
  void noteRandom(uint32_t path);

  void loadRays(Paths& paths, size_t begin, uint32_t n);
  void traceWave(Paths& paths);
  void wave(uint32_t firstSample, uint32_t samples);
  void allocate(Paths& paths, uint32_t n, bool film);
  void follow(Paths& paths, uint32_t n);
  RtsBatch makeBatch();
  RtsBatch makeBatch(const Paths& paths, const Points& points, const uint32_t* order);
  void makeCameraRays(Paths& paths, uint32_t firstSample);
  void skyAt(const Rays& rays, const uint32_t* lanes, uint32_t n, float* direction[3], float* rgba[4]);
  void background(Paths& paths, const uint32_t* missed, uint32_t n);
  void shadeRange(Paths& paths, const RayHits& hits, const BucketRange& range, const uint32_t* order);
  void gather(const Points& points, const RtsShading& shaded, const uint32_t* order, Paths& paths, const float* fog[4]);
  void noteFirst(const Points& points, uint32_t i, uint32_t path, float* const albedo[3], Paths& paths);
  // scatter.cpp: surfaces that are described by lobes.
  void scatterRange(Paths& paths, const Points& points, const Bucket& bucket, const uint32_t* order);
  void addLights(RtsBatch& batch, const RtsHits& hits, float* const radiance[3]);
  struct Step { // how a ray goes on
    float direction[3], weight[3], density;
    bool bent, split, through; // through: the lobes of the hit answer to light from both sides
    uint8_t channel;
    uint32_t branch;
    MediaStack media;
  };
  enum class Draw : uint32_t { direction, choice, emitter, place, count };
  // Pair of dimensions of a random choice at this surface of a path; pair 0 is the place in the pixel.
  uint32_t pairOf(const RayState& ray, Draw draw) const {
    return 1 + uint32_t(Draw::count) * level_ + uint32_t(draw) + ray.branch;
  }
  void sampleAt(uint32_t path, uint32_t pair, float& u, float& v) const;
  // Random numbers of the hits of a batch: a point of the unit square for each draw.
  struct Random {
    uint32_t count, *key, *index, *pair;
  };
  Random randomOf(const Paths& paths, const uint32_t* order, uint32_t n);
  void draw(const Random& random, Draw what, uint32_t apart, float* square[2]);
  const LobeSamples* sampleLobe(const RtsBatch& batch, uint32_t l, const RtsHits& hits, const Random& random);
  void passOn(const Points& points, uint32_t i, uint32_t lane, const Crossing& crossing, Paths& paths);
  void sendOn(const RtsBatch& batch, const Points& points, uint32_t i, uint32_t lane, Paths& paths,
              const LobeSamples* const samples[], const Boundaries& boundaries, float* const choices[2], float* const chance[]);
  // Of a ray that meets emitters by chance: whether light tracing leaves those that have a place to it.
  bool skyAlone(const RayState& ray) const { return scene_.lightSources && ray.course == Course::through; }
  ChanceLight& chanceOf(const RayState& ray) { return skyAlone(ray) ? ledger_.chanceSky : ledger_.chance; }
  double brightestFor(const RayState& ray) const { return skyAlone(ray) ? brightestSky_ : brightest_; }
  void push(const Points& points, uint32_t i, uint32_t lane, const Step& step, Paths& paths);
  float chanceMet(const RayState& ray, const Points& points, uint32_t i) const;
  // emitted.cpp: the light of emitters and of the sky, by choosing places on them.
  Receiver receiverOf(const Points& points, uint32_t i, bool through) const;
  uint32_t weigh(const RtsBatch& batch, const RtsHits& hits, float* const chance[], Rays& rays, Sight* sights, uint32_t* hitOf,
                 uint32_t n, float* response[3]);
  void addEmitters(const RtsBatch& batch, const Points& points, const uint32_t* order, const Paths& paths, const Random& random,
                   float* const chance[], const Crossing* crossing, float* const radiance[3]);
  void attenuate(const Points& points, const Paths& paths, const uint32_t* order, float* fog[4]);
  void addToPixels(const Paths& paths, uint32_t firstSample, uint32_t samples);

  const RenderScene& scene_;
  const uint32_t width_; // of the picture
  const Gathering gathering_;
  const double brightest_, brightestSky_; // radiance of emitters, colours summed
  const std::atomic<bool>* stop_ = nullptr;
  Arena arena_;
  RayCounters counters_;
  Ledger ledger_;
  Tile tile_;
  std::vector<uint32_t> counts_, pixels_, places_; // pixels_: y * width + x, in blocks of 4x4; places_: in the tile's rows
  std::vector<BucketRange> ranges_;
  std::span<PixelSums> sums_;
  Replicates replicates_;
  uint32_t leaf_ = 0; // first sample of the leaf
  bool centred_ = false;
  uint8_t* random_ = nullptr;                          // by sample of the wave: its path has taken a random decision
  const uint32_t* root_ = nullptr;                     // within trace(): the sample of the wave that each path belongs to
  uint32_t nesting_ = 0;                               // of trace()
  RayQueue queue_, next_;                              // rays of the wave being traced, and of the one after it
  uint32_t level_ = 0, firstSample_ = 0, samples_ = 0; // of the wave
};

} // namespace openrt
