// emitters.h: what sends out light besides the lights: triangles of surfaces that emit, and the environment. Path tracing
// chooses a place on them for every diffuse answer and weighs it against directions chosen by the surface (multiple importance
// sampling: E. Veach, L. Guibas, SIGGRAPH 1995, balance heuristic). Made between frames, read by all render threads.
#pragma once

#include <cstdint>
#include <vector>

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

class Emitters {
 public:
  struct Triangle {
    uint32_t record, primitive;
    float area, probability; // in render space; of being chosen
  };

  // Empty where the scene's transport does not ask for them.
  void build(const RenderScene& scene);
  bool any() const { return !triangles_.empty() || sky.usable(); }
  // Share of the choices that goes to the sky.
  float skyShare() const { return !sky.usable() ? 0.0f : triangles_.empty() ? 1.0f : 0.5f; }
  const Triangle& pick(float u) const;
  // The triangle that a hit belongs to; null if it is not among the emitters.
  const Triangle* find(uint32_t record, uint32_t primitive) const;

  SkySampler sky;

 private:
  std::vector<Triangle> triangles_;
  std::vector<double> cumulative_;
  std::vector<uint32_t> firstOf_; // by record: its first triangle, or none
};

// Corners of a record's triangle in render space.
void cornersOf(const struct Record& record, uint32_t primitive, float out[3][3]);

} // namespace openrt
