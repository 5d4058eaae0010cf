// tile.h: renders one tile of the picture on one thread: takes the samples of its pixels and adds
// them up. A path tracer (path_tracer.h) follows their paths. [render]
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "render/film/sums.h"
#include "render/path/first_hits.h"
#include "render/path/path_tracer.h"
#include "render/wave/light_stride.h"
#include "render/wave/tiles.h"
#include "scene/quality.h"

namespace openrt {

struct FilmSamples;

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
  RayCounters& counters() { return paths_.counters; }
  // Energy left out by the last render().
  const Ledger& ledger() const { return paths_.ledger; }
  // Tell trials about all guided rays of camera paths, and about all connections of light paths,
  // from now on.
  void observe(GuideTrial* trial) { tracer_.observe(trial); }
  void observe(LightPathGain* gain) { tracer_.observe(gain); }

 private:
  void begin(const Tile& tile);
  void listPixels(const Tile& tile);
  bool stopped() const { return paths_.stop->load(std::memory_order_relaxed); }

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
  void addToPixels(const PixelRange& range, const FilmSamples& film, const PixelSamples& found);
  // Adds the values of a path's channels. first: the path is that of sample 0.
  void addValues(const PixelSamples& found, uint32_t path, bool first, PixelSums& sums) const;

  const RenderScene& scene_;
  const uint32_t width_; // width of the picture
  const RequiredSums required_;
  std::vector<uint32_t> firstPlaces_, meanPlaces_; // ChannelInfo::place of all values of the frame
  const bool showsNoLight_{showsNoLight(scene_.frame)};
  // 1 where there is no light to save, or a plug-in follows it
  const uint32_t lightStride_{
      showsNoLight_ || scene_.transport.shaderClass ? 1 : lightStrideOf(scene_.frame)};
  TilePaths paths_{scene_};
  PathTracer tracer_{paths_};
  FirstHits firstHits_{scene_, paths_.arena, paths_.counters};
  Tile tile_;
  // pixels_: y * width + x, in blocks of 4x4; places_: index in the tile, row by row. The first
  // `lit_` of them get light, the others do not (RT_LIGHT_STRIDE).
  std::vector<uint32_t> pixels_, places_;
  uint32_t lit_ = 0;
  std::span<PixelSums> sums_;
  HitCounts* hits_ = nullptr; // null if names are not counted
  Replicates replicates_;
  uint32_t leaf_ = 0; // first sample of the current leaf
};

} // namespace openrt
