// light_sources.h: samples the first rays of light paths. They start on emissive shapes, in the sun
// of the sky (SkySampler::hasSun) and at lights whose class declares its extent. Only paths that
// hit a specular surface first are wanted, so directions are aimed at the bounding sphere of all
// specular surfaces. Built between frames, read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

#include "render/lights/emissive_shapes.h"
#include "render/render_scene.h"

namespace openrt {

class LightSources {
 public:
  enum class Kind : uint8_t { all, emitters }; // emitters: no lights without extent
  // Stays empty if nothing emits, or if nothing mirrors or refracts. before: a snapshot with
  // everything in the same places, or null.
  LightSources(const RenderScene& scene, const RenderScene* before, Kind kind = Kind::all);
  bool empty() const { return cumulative_.empty(); }

  struct LightRay {
    Vec3f origin, direction;
    // For a shape and for the sun: flux over radiance. For a light: flux over (irradiance times the
    // squared distance to the hit); for a parallel light: flux over irradiance.
    double weight = 0; // 0: no ray was sampled
    uint32_t light = none, shape = none;
    EmissiveShapes::Place place; // the sampled point, if `shape` is set
    bool parallel = false;
    bool endless = true; // the light has no finite radius of influence
    bool sun = false;    // it comes from the sun of the sky
  };
  static constexpr uint32_t none = ~0u;
  // Samples a ray. The numbers in [0, 1) select the source, the point on it, and the direction.
  LightRay sampleRay(const RenderScene& scene, double pick, const float place[2],
                     const float direction[2]) const;

 private:
  struct Source { // the sun of the sky, if it is neither a light nor a shape
    uint32_t light, shape;
    RtsExtent extent; // extent of the light in render space
  };
  void boundSpecularSurfaces(const RenderScene& scene);
  void measureSceneExtent(const RenderScene& scene);
  double coneToSpecular(const Vec3f& from, Vec3f& axis) const;
  Vec3f startOfParallel(const Vec3f& towards, const float place[2]) const;
  std::vector<Source> sources_;
  std::vector<double> cumulative_; // cumulative power of the sources
  Vec3f center_;                   // center_, radius_: bounding sphere of all specular surfaces
  float radius_ = 0;
  float far_ = 0; // distance at which light from afar starts: the whole scene lies in front of it
};

} // namespace openrt
