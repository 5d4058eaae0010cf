// many_lights.h: the lights of a set, for path tracing: a few are all asked; of many, one is chosen
// for each place through a light tree (render/lights/light_tree.h) and stands for all of them, its
// colour over its probability. Lights without extent, and those that shine everywhere the same, are
// always asked. Made between frames while lights change, read by all render threads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/lights/light_tree.h"

namespace openrt {

struct RenderScene;

class ManyLights {
 public:
  static constexpr uint32_t few = 16; // up to here all are asked

  // set: of RenderScene::lights.
  ManyLights(const RenderScene& scene, const std::vector<uint32_t>& set);
  const std::vector<uint32_t>& always() const { return always_; }
  bool chooses() const { return !tree_.empty(); }
  struct Choice {
    uint32_t light; // of RenderScene::lights
    float probability;
  };
  // normal: of the surface, only a hint.
  Choice choose(const float place[3], const float normal[3], double pick) const;

 private:
  std::vector<uint32_t> always_, chosen_;
  LightTree tree_;
};

// By light set; null where no set has many. before: the last snapshot, or null.
std::shared_ptr<const std::vector<ManyLights>> makeManyLights(const RenderScene& scene,
                                                              const RenderScene* before);

} // namespace openrt
