// first_hits.h: finds the hits that the channels of the first hit describe (wave/first_hit.h),
// apart from the light that is followed. [render]
//
// With RT_FOLLOW_IMAGES they describe what is seen in smooth mirrors and through smooth glass.
// Where the lobes of a hit show an image (image_leads.h), a first-hit ray follows it, up to
// `mostSurfaces` times.
//
// In frames without any channel of light, this is all that is done.
#pragma once

#include <cstdint>
#include <vector>

#include "render/path/image_leads.h"
#include "render/wave/boundaries.h"
#include "render/wave/first_hit.h"
#include "render/wave/wave.h"

namespace openrt {

class FirstHits {
 public:
  FirstHits(const RenderScene& scene, Arena& arena, RayCounters& counters);

  // Begins with the camera rays of a wave, by path. They must keep their place until finish().
  void begin(const Rays& camera);
  // Describes the first hits of the camera rays, for frames and pixels without light. context: with
  // the renderer, because shaders may request something from it. The wave lists the rays that
  // missed until the arena is released.
  void describe(const StageContext& context, Wave& wave, PixelSamples& found);
  // Does the same for camera rays in a scene with media that scatter. The channels of first
  // surfaces show what is behind the medium, whether the light of the sample comes from there or
  // from the medium.
  void describeBehindMedia(const StageContext& context, const Wave& wave, PixelSamples& found);
  // Take over the first hit of a path if an image is to be followed there; else return false.
  // transmission: what `shade` has returned.
  bool takeSurface(const RtsBatch& batch, const Boundaries& boundaries, uint32_t i,
                   const ImageLead& lead);
  bool takeShading(const RtsBatch& batch, uint32_t i, const Vec3f& transmission);
  // Follows the paths that were taken over, and records what they see.
  void finish(PixelSamples& found);

  // Surfaces that a path passes straight on do not count.
  static constexpr uint32_t mostSurfaces = 8;

 private:
  // Says what a first-hit ray does at a hit: it passes a boundary that has no effect, or follows an
  // image.
  enum class Step : uint8_t { pass, image };
  void visit(const StageContext& context, Wave& wave, PixelSamples& found);
  void describeBucket(const StageContext& context, const Points& points, const Bucket& bucket,
                      const PathStates& states, PixelSamples& found);
  bool isLast(PathFlags path) const;
  void queue(const RtsBatch& batch, uint32_t i, const ImageLead& lead, const MediaStack& media,
             Step step);
  void reflect(const RtsBatch& batch, uint32_t i, const Vec3f& out, MirrorSpace& image) const;
  void store(const RtsBatch& batch, uint32_t i, float* const albedo[3], PixelSamples& found) const;
  bool has(uint32_t channel) const { return scene_.frame.channels & channel; }

  const RenderScene& scene_;
  Arena& arena_;
  RayCounters& counters_;
  // No renderer: shaders get the middle of every sequence of random points, and trace nothing.
  const StageContext context_{scene_, arena_, counters_};
  const bool follows_;
  const float* origin_[3] = {};    // origins of the camera rays, by path
  const float* direction_[3] = {}; // unit
  uint32_t paths_ = 0;
  uint32_t surface_ = 0; // number of surfaces that the rays of the wave have met before
  // By path. Those that follow an image, and only those, are valid; the rays of such paths count as
  // deflected (PathFlags).
  std::vector<MirrorSpace> images_;
  RayQueue queue_, next_;
};

} // namespace openrt
