// tile.h: the wavefront: renders one tile of the picture on one thread. A tile's samples go through intersection, sorting by
// shader, shading and shadow rays in batches; paths that go on are compacted and make the next wave. [render]
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

#include "render/batch.h"
#include "render/error.h"
#include "render/film.h"
#include "render/ledger.h"
#include "render/lobes.h"
#include "render/ray_queue.h"

namespace openrt {

// Edge of the square tiles of a picture: a few thousand paths are in flight, and small pictures have tiles for many threads, too.
uint32_t tileEdge(uint32_t samplesPerPixel, uint32_t width, uint32_t height);

struct Boundaries;
class LightImage;

class TileRenderer {
 public:
  // filmLock: held while pixels are stored, if other threads may read them meanwhile; else null
  TileRenderer(const RenderScene& scene, Film& film, std::mutex* filmLock = nullptr);
  // What paths from lamps have made, for the tiles that follow; null: nothing, as at first.
  void useLight(const LightImage* light) { light_ = light; }
  // Tiles are given up, and not stored, once the flag is set.
  void stopAt(const std::atomic<bool>& flag) { stop_ = &flag; }
  // The whole of a tile: a pilot if the frame has a target error, then its samples, then its pixels.
  void render(const Tile& tile);
  // Samples of a wave, at most.
  static constexpr uint32_t largestWave = 32;
  // Frames of so many samples are taken in waves that grow, and may be made in rounds; of fewer, small waves would cost too much.
  static constexpr uint32_t fewestOfRounds = 32;
  static constexpr uint32_t pilotSamples = 32;
  static bool needsPilot(const edit::FrameSettingsT& frame) { return frame.targetError > 0 && frame.samples > pilotSamples; }
  // Some samples more for a tile whose sums are kept from round to round; the first time there are none. May be 0 samples: the
  // tile is stored again. last: nothing needs to be kept.
  void renderRound(const Tile& tile, std::vector<std::byte>& kept, const Replicates& replicates, uint32_t first, uint32_t samples,
                   bool last);
  // A tile of samples that do not count; how many it needs. Its pixels are stored, to be replaced.
  uint32_t pilot(const Tile& tile, uint32_t samples);
  // The same in rounds; the answer holds after the last one, of pilotSamples altogether.
  uint32_t pilotRound(const Tile& tile, std::vector<std::byte>& kept, uint32_t first, uint32_t samples);
  const RayCounters& counters() const { return counters_; }
  // Of the samples that the last render() or renderRound() has taken.
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
  bool takeSamples(uint32_t first, uint32_t samples); // false: stopped
  bool stopped() const { return stop_ && stop_->load(std::memory_order_relaxed); }
  void store(const Tile& tile);
  void keep(std::vector<std::byte>& kept) const;
  void takeUp(const std::vector<std::byte>& kept);
  uint32_t wantedAfter(uint32_t samples) const; // the tile that was stored last
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
  Film& film_;
  std::mutex* filmLock_;
  const std::atomic<bool>* stop_ = nullptr;
  const LightImage* light_ = nullptr;
  Arena arena_;
  RayCounters counters_;
  Ledger ledger_;
  std::vector<uint32_t> counts_, pixels_; // pixels_: y * width + x, in blocks of 4x4
  std::vector<BucketRange> ranges_;
  std::vector<PixelSums> sums_;
  std::vector<PixelError> errors_; // of the tile that is stored
  Replicates replicates_;
  const bool wantsError_;
  const size_t keptBytes_;                             // of each pixel's sums, from round to round
  bool single_ = false;                                // single_: one sample a pixel, at its centre
  double halfWidth_ = 0;                               // relative, mean over the tile that was stored last
  uint8_t* random_ = nullptr;                          // by sample of the wave: its path has taken a random decision
  const uint32_t* root_ = nullptr;                     // within trace(): the sample of the wave that each path belongs to
  uint32_t nesting_ = 0;                               // of trace()
  RayQueue queue_, next_;                              // rays of the wave being traced, and of the one after it
  uint32_t level_ = 0, firstSample_ = 0, samples_ = 0; // of the wave
};

} // namespace openrt
