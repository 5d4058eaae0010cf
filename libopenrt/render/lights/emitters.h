// emitters.h: light sampling of everything that emits besides the light shaders: emissive surfaces
// and the environment. At every non-specular path vertex the path tracer takes one light sample and
// combines it with BSDF sampling (multiple importance sampling: E. Veach, L. Guibas, SIGGRAPH 1995,
// balance heuristic). Built between frames; tables are shared between snapshots while their inputs
// stay the same. Read by all render threads.
#pragma once

#include <cstdint>
#include <memory>

#include "render/lights/emissive_shapes.h"
#include "render/lights/sky_sampler.h"
#include "render/wave/path_states.h"

namespace openrt {

struct RenderScene;

// A sampled direction towards an emitter.
struct LightSample {
  uint32_t shape = EmissiveShapes::none; // number of the shape; none: the sky was sampled
  Vec3f direction;                       // unit, render space
  float distance = 0;                    // to the sampled point; infinite for the sky
  float pdf = 0; // solid-angle pdf including the selection of the emitter; 0: no sample
};

class Emitters {
 public:
  // Builds the sampling tables; they are empty if the scene's transport does not sample emitters.
  // before: the last snapshot, or null. samePlaces: its records and their transforms equal those of
  // this scene.
  void build(const RenderScene& scene, const RenderScene* before, bool samePlaces);
  // Tabulates the sky ahead of build(), which then takes the table. The environment must have
  // `miss`. before: as for build().
  const SkySampler& tabulateSky(const RenderScene& scene, const RenderScene* before);
  bool any() const { return hasSky() || hasShapes(); }
  // Returns whether the sky has a sun, from which light paths start (SkySampler::hasSun).
  bool hasSun() const;
  // Samples a direction to the sun as SkySampler::sampleSun does, in render space. Returns its
  // solid-angle pdf; 0: no sample.
  double sampleSun(double pick, float u, float v, Vec3f& direction) const;
  // Return the largest mean radiance, summed over the colours. brightestSky(): of the cells of the
  // sky. brightestShape(): of the sides of shapes.
  double brightestSky() const;
  double brightestShape() const;
  // Samples an emitter as seen from each point that wants a sample. fine: low digits of the random
  // numbers `pick`, by point, which matter with many emitters. No sample is left to other code.
  void choose(const LightPoints& points, const float* fine, Arena& arena,
              const SampledLights& out) const;
  // Computes the solid-angle pdf of choose() for the direction of each found shape; 0 if choose()
  // cannot sample it.
  void pdf(const FoundShapes& found, float* out) const;
  // Returns the solid-angle pdf of choose() for a direction to the sky, given in the environment's
  // local space.
  float skyPdf(const LightSampleContext& from, const Vec3f& local) const;

  // Returns whether light paths start on the surface hit along a direction
  // (render/lights/light_sources.h).
  bool startsLightPaths(uint32_t record, uint32_t primitive, const Vec3f& direction) const;
  // Access for light_sources.h, tests and statistics.
  const EmissiveShapes* shapes() const { return shapes_.get(); }
  const SkySampler* sky() const { return sky_.get(); }

 private:
  bool hasSky() const { return skyIrradiance_ > 0; }
  bool hasShapes() const { return shapes_ && !shapes_->empty(); }
  // Returns the selection probability of the sky.
  float skyShare(const LightSampleContext& from) const;
  LightSample chooseSky(double share, float u, float v) const;
  LightSample sampleChosen(const LightSampleContext& from, uint32_t number, double probability,
                           float u, float v) const;
  // Selects an emitter for each point and samples most of the shapes; returns whether some samples
  // are left to other code (SampledLights::left).
  bool sampleMost(const LightPoints& points, const float* fine, Arena& arena,
                  const SampledLights& out) const;
  // Does pdf() for one shape, in double precision.
  float pdfOf(const LightSampleContext& from, uint32_t shape, const Vec3f& direction) const;
  double sampleShape(const EmissiveShapes::Shape& shape, const LightSampleContext& from, double u,
                     double v, Vec3d& direction, double& distance) const;
  float skyJacobian(const Vec3f& local) const;
  const RenderScene* scene_ = nullptr;
  std::shared_ptr<const SkySampler> sky_;
  std::shared_ptr<const EmissiveShapes> shapes_;
  float skyIrradiance_ = 0; // SkySampler::irradiance(); 0: the sky is not sampled
  // Absolute determinant of the map from render space into the environment's space.
  float determinant_ = 1;
};

} // namespace openrt
