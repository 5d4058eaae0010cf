// emitters.h: what sends out light besides the lights: surfaces that emit, and the environment. Path tracing chooses a place on
// them for every answer of a surface that scatters and weighs it against directions chosen by the surface (multiple importance
// sampling: E. Veach, L. Guibas, SIGGRAPH 1995, balance heuristic). Made between frames, read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

#include "render/rays.h"

namespace openrt {

struct RenderScene;

// Piecewise constant over cells of equal latitude and longitude in the environment's local space.
class SkySampler {
 public:
  void build(const RenderScene& scene);
  bool usable() const { return total_ > 0; }
  // A local unit direction and its density by solid angle, from a point of the unit square.
  float sample(float u, float v, float direction[3]) const;
  float density(const float direction[3]) const;

 private:
  static constexpr uint32_t columns = 64, rows = 32;
  double solidAngle(uint32_t row) const;
  std::vector<double> cumulative_; // over cells, row by row, of radiance times solid angle
  double total_ = 0;
};

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
  // Empty where the scene's transport does not ask for them.
  void build(const RenderScene& scene);
  bool any() const { return !triangles_.empty() || sky_.usable(); }
  // pick chooses the emitter, (u, v) the place on it: numbers of [0, 1).
  Sight choose(const Receiver& from, float pick, float u, float v) const;
  // Whether what the ray of a sight has met is what it was sent for.
  bool sees(const Sight& sight, uint32_t record, uint32_t primitive, float distance) const;
  // Density of what choose() would answer for a surface that was met along a direction; 0 if it could not be.
  float density(const Receiver& from, uint32_t record, uint32_t primitive, const float direction[3], float distance) const;
  // The same of the sky in a direction in the environment's local space.
  float skyDensity(const Receiver& from, const float local[3]) const;

 private:
  struct Triangle {
    uint32_t record, primitive;
    float area, probability; // in render space; of being chosen
  };
  // Share of the choices that goes to the sky.
  float skyShare() const { return !sky_.usable() ? 0.0f : triangles_.empty() ? 1.0f : 0.5f; }

  const RenderScene* scene_ = nullptr;
  SkySampler sky_;
  std::vector<Triangle> triangles_;
  std::vector<double> cumulative_;
  std::vector<uint32_t> firstOf_; // by record: its first triangle, or none
};

// Corners of a record's triangle in render space.
void cornersOf(const struct Record& record, uint32_t primitive, float out[3][3]);

} // namespace openrt
