// emitters.h: what sends out light besides the lights: surfaces that emit, and the environment. Path tracing chooses a place on
// them for every answer of a surface that scatters and weighs it against directions chosen by the surface (multiple importance
// sampling: E. Veach, L. Guibas, SIGGRAPH 1995, balance heuristic). Made between frames, its tables kept from snapshot to
// snapshot while what they are made of stays; read by all render threads.
#pragma once

#include <cstdint>
#include <memory>

#include "render/emissive_shapes.h"
#include "render/rays.h"
#include "render/sky_sampler.h"

namespace openrt {

struct RenderScene;

// Who asks for light: where its rays begin.
struct Receiver {
  float position[3];
  float normal[3] = {0, 0, 0}; // unit, if light counts from its side only; 0 0 0: from everywhere
};

// A direction in which an emitter may be seen.
struct Sight {
  uint32_t record = noHit, primitive = 0; // noHit: the sky
  float direction[3];                     // unit, render space
  float distance = 0;                     // infinite: the sky
  float density = 0;                      // by solid angle, of this direction among all that might be chosen; 0: there is none
  bool rim = false;                       // so near to the emitter's edge that the ray may meet its neighbour
};

class Emitters {
 public:
  // Empty where the scene's transport does not ask for them. before: the last snapshot, or null; samePlaces: its records and
  // their places are those of this one.
  void build(const RenderScene& scene, const RenderScene* before, bool samePlaces);
  bool any() const { return share_ >= 0; }
  // Largest mean radiance, colours summed, of a cell of the sky; of such a cell or a shape's side.
  double brightestSky() const;
  double brightest() const;
  // pick chooses the emitter, (u, v) the place on it: numbers of [0, 1). Of pick every digit counts where emitters are many.
  Sight choose(const Receiver& from, double pick, float u, float v) const;
  // Whether what the ray of a sight has met is what it was sent for.
  bool sees(const Sight& sight, uint32_t record, uint32_t primitive, float distance) const;
  // Density of what choose() would answer for a surface that was met along a direction; 0 if it could not be.
  float density(const Receiver& from, uint32_t record, uint32_t primitive, const float direction[3], float distance) const;
  // The same of the sky in a direction in the environment's local space.
  float skyDensity(const Receiver& from, const float local[3]) const;

  // Whether paths from lamps begin on a surface that is met along a direction (render/light_sources.h).
  bool sends(uint32_t record, uint32_t primitive, const float direction[3]) const;
  // For light sources, tests and statistics.
  const EmissiveShapes* shapes() const { return shapes_.get(); }
  const SkySampler* sky() const { return sky_.get(); }

 private:
  double densityOf(const EmissiveShapes::Shape& shape, const Receiver& from, double u, double v, double direction[3],
                   double& distance, bool& rim) const;
  float skyStretch(const float local[3]) const;
  const RenderScene* scene_ = nullptr;
  std::shared_ptr<const SkySampler> sky_;
  std::shared_ptr<const EmissiveShapes> shapes_;
  float share_ = -1;      // of the choices, that goes to the sky; -1: nothing emits
  float determinant_ = 1; // of the environment's map into its local space
};

} // namespace openrt
