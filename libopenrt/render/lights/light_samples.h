// light_samples.h: samples emitters for many shading points at once, with vector lanes. Rare cases
// that need double precision, and the sky, are left to Emitters (emitters.h). [render]
#pragma once

#include <algorithm>
#include <cstdint>

namespace openrt {

class Arena;
struct LightNode;

// Triangles and spheres that emit, as structure of arrays by the number of the shape.
struct ShapeArrays {
  const float* corner[3][3]; // [corner][axis], render space
  // EmissiveShapes::Shape::sides, and the following bits.
  const uint32_t* sides;
  static constexpr uint32_t front = 1, back = 2, sphere = 4, instanced = 8;
  // Every point that emits emits `radiance` in all directions.
  static constexpr uint32_t oneRadiance = 16;
  const float* radiance[3];
};

// The points that light is sampled for. Arrays are padded to 16 elements.
struct LightPoints {
  uint32_t count;
  const float *position[3], *normal[3]; // on the side that the light counts from; unit
  const float* error;                   // error bound of the position along the normal
  const uint32_t* twoSided;  // not 0: light counts from both sides. Null: it does so nowhere.
  const float *pick, *u, *v; // random numbers in [0, 1)
  const float* wanted;       // above 0: a sample is wanted
};

struct ChosenLights { // by point; arrays are padded
  float* skyShare;    // selection probability of the sky
  uint32_t* shape;    // number of the shape; ~0: none
  float* probability; // selection probability of the shape, if the sky is not selected
};

// Where both the sky and shapes may illuminate a point, each is selected with at least this
// probability.
constexpr float leastEmitterShare = 0.0625f;

// Returns the selection probability of the sky for a point. skyIrradiance: mean irradiance by the
// sky, 0 if there is none. shapes: sum of the importances of the shapes, which bounds theirs. Both
// keep a share, because a part of either may be hidden.
inline float skyShareOf(float skyIrradiance, float shapes) {
  if (!(shapes > 0)) return skyIrradiance > 0 ? 1 : 0;
  if (!(skyIrradiance > 0)) return 0;
  const float share = skyIrradiance / (skyIrradiance + shapes);
  return std::clamp(share, leastEmitterShare, 1 - leastEmitterShare);
}

// One light sample at most for each point; arrays are padded.
struct SampledLights {
  float *direction[3], *distance;
  // Where a shadow ray from the point ends, so that the shape does not block it; below 0: the bound
  // is left to shadowRayEnd() (sampled_points.h).
  float* end;
  // Solid-angle pdf including the selection of the emitter; 0: no sample. Selection probability of
  // the emitter where the sample is left to other code.
  float* pdf;
  uint32_t* shape; // number of the shape; ~0: the sky
  // 0, or which sample is left to other code:
  uint32_t* left;
  static constexpr uint32_t inDouble = 1; // `shape`, in double precision
  static constexpr uint32_t sky = 2;

  void allocate(Arena& arena, uint32_t capacity);
};

// Shapes that rays have found, seen from the points where the rays start. Arrays are padded.
struct FoundShapes {
  uint32_t count;
  float *position[3], *normal[3]; // LightSampleContext
  float* direction[3];            // the direction of the ray; unit
  uint32_t* shape;

  void allocate(Arena& arena, uint32_t capacity);
};

// Computes the share of the sky for each point. If the root of the tree is its only node, a shape
// is selected as well; `pick` selects first between sky and shapes, then the shape.
void chooseFromRoot(const LightNode& root, const LightPoints& points, float skyIrradiance,
                    const ChosenLights& out);
// Samples a direction towards the chosen shapes. Returns whether some samples are left to other
// code.
bool sampleShapes(const ShapeArrays& shapes, const LightPoints& points, const ChosenLights& chosen,
                  const SampledLights& out);
// Does both at once, for a tree whose root is its only node.
bool sampleFromRoot(const LightNode& root, const ShapeArrays& shapes, const LightPoints& points,
                    float skyIrradiance, const SampledLights& out);
// Computes the pdf with which sampleFromRoot() samples the direction of each found shape; -1: that
// is left to double precision.
void pdfFromRoot(const LightNode& root, const ShapeArrays& shapes, const FoundShapes& found,
                 float skyIrradiance, float* pdf);

} // namespace openrt
