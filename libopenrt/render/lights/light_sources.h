// light_sources.h: samples the first rays of light paths. They start on emissive shapes, in the sun
// of the sky (SkySampler::hasSun) and at lights whose class declares its extent. Only paths that
// hit a specular surface first are wanted, or a glossy one (Kind::glossy), so directions are aimed
// at the bounding sphere of all such surfaces. Built between frames, read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

#include "render/lights/emissive_shapes.h"
#include "render/render_scene.h"

namespace openrt {

class LightSources {
 public:
  // emitters: no lights without extent. glossy: emissive shapes alone, which aim at glossy
  // surfaces.
  enum class Kind : uint8_t { all, emitters, glossy };
  // Stays empty if nothing emits, or if there is nothing to aim at. before: a snapshot with
  // everything in the same places, or null.
  LightSources(const RenderScene& scene, const RenderScene* before, Kind kind = Kind::all);
  bool empty() const { return cumulative_.empty(); }
  Kind kind() const { return kind_; }
  // Returns whether light paths of a kind aim at a record.
  static bool isTarget(const RenderScene& scene, const Record& record, Kind kind);

  struct LightRay {
    Vec3f origin, direction;
    // Where the ray is traced from, and how far that is from the origin: not 0 only for a light
    // that is far outside of the scene.
    Vec3f from;
    double skipped = 0;
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

  // Returns about the pdf with which a path starts at a point of a shape and in the direction of a
  // surface that is aimed at, by area and solid angle; infinite where that is not known.
  double startPdf(const RenderScene& scene, uint32_t shape, const Vec3f& place) const;

 private:
  struct Source { // the sun of the sky, if it is neither a light nor a shape
    uint32_t light, shape;
    RtsExtent extent; // extent of the light in render space
  };
  void boundTargets(const RenderScene& scene);
  void addGlossySources(const RenderScene& scene);
  void measureSceneExtent(const RenderScene& scene);
  double placePdf(const RenderScene& scene, uint32_t shape) const;
  double coneToTargets(const Vec3f& from, Vec3f& axis) const;
  void aimFromAfar(const float direction[2], LightRay& start) const;
  Vec3f startOfParallel(const Vec3f& towards, const float place[2]) const;
  Kind kind_;
  std::vector<Source> sources_;
  std::vector<double> cumulative_; // cumulative power of the sources
  // Kind::glossy: by shape, pdf of a place by area; and whether one side alone emits.
  std::vector<double> placePdf_;
  std::vector<bool> oneSided_;
  Vec3f center_; // center_, radius_: bounding sphere of all targets
  float radius_ = 0;
  float far_ = 0; // distance at which light from afar starts: the whole scene lies in front of it
};

} // namespace openrt
