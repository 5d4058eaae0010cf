// light_sources.h: where paths from lamps begin: on shapes that emit and at lights whose class says
// where they are. Only what may meet a mirror or a lens first is wanted, so directions are aimed at
// these. Made between frames, read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

#include "render/lights/emissive_shapes.h"
#include "render/render_scene.h"

namespace openrt {

class LightSources {
 public:
  // Empty where nothing sends out light, or nothing mirrors or refracts it. before: a scene with
  // everything in the same places, or null.
  LightSources(const RenderScene& scene, const RenderScene* before);
  bool empty() const { return cumulative_.empty(); }

  struct Start {
    float origin[3], direction[3];
    // Of a shape: flux over radiance. Of a light: flux over (irradiance times the square of the way
    // to what is met), or, where it is parallel, over irradiance.
    double weight = 0; // 0: nothing starts
    uint32_t light = none, shape = none;
    EmissiveShapes::Place place; // of a shape
    bool parallel = false;
    bool endless = true; // nothing says that it lights nothing beyond some radius
  };
  static constexpr uint32_t none = ~0u;
  // Numbers of [0, 1): which, the place on it, the direction.
  Start begin(const RenderScene& scene, double pick, const float place[2],
              const float direction[2]) const;

 private:
  struct Source {
    uint32_t light, shape;
    RtsExtent extent; // of a light, in render space
  };
  void aimAtMirrors(const RenderScene& scene);
  void standBack(const RenderScene& scene);
  double coneTo(const float from[3], float axis[3]) const;
  std::vector<Source> sources_;
  std::vector<double> cumulative_;    // of power
  float centre_[3] = {}, radius_ = 0; // of a ball around all that mirrors or refracts
  float far_ = 0;                     // from there everything lies in front of parallel light
};

} // namespace openrt
