// light_sampler.h: the light sampler for the light shaders of a light set in path tracing. If a set
// has few lights, all are evaluated. If it has many, one is sampled per hit through a light tree
// (render/lights/light_tree.h) and represents all of them: its colour is divided by its selection
// probability. Parallel lights and lights whose class does not declare an extent are always
// evaluated. Built between frames when lights change, read by all render threads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/lights/light_tree.h"

namespace openrt {

struct RenderScene;

class LightSampler {
 public:
  // in sets of at most this many lights, every light is evaluated
  static constexpr uint32_t few = 16;

  // Builds a sampler for the lights in `set` (indices into RenderScene::lights).
  LightSampler(const RenderScene& scene, const std::vector<uint32_t>& set);
  const std::vector<uint32_t>& always() const { return always_; }
  bool chooses() const { return !tree_.empty(); }
  struct Choice {
    uint32_t light; // index into RenderScene::lights
    float probability;
  };
  // Samples a light for a point. normal: the surface normal, used only as a hint.
  Choice choose(const Vec3f& place, const Vec3f& normal, double pick) const;

 private:
  std::vector<uint32_t> always_, chosen_;
  LightTree tree_;
};

// Builds the samplers by light set. Returns null if no set has many lights. before: the last
// snapshot, or null.
std::shared_ptr<const std::vector<LightSampler>> makeLightSamplers(const RenderScene& scene,
                                                                   const RenderScene* before);

} // namespace openrt
