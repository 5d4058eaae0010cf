// light_samples.h: samples emitters for many shading points at once, with vector lanes. It does
// what Emitters::choose() does for one point; rare cases that need double precision are left to
// that. [render]
#pragma once

#include <cstdint>

namespace openrt {

struct LightNode;

// Triangles and spheres that emit, as structure of arrays by the number of the shape.
struct ShapeArrays {
  const float* corner[3][3]; // [corner][axis], render space
  // EmissiveShapes::Shape::sides, and one of the following values.
  const uint32_t* sides;
  static constexpr uint32_t sphere = 4, instanced = 8;
};

// The points that light is sampled for. Arrays are padded to 16 elements.
struct LightPoints {
  uint32_t count;
  const float *position[3], *normal[3]; // on the side that the light counts from; unit
  const float* error;                   // error bound of the position along the normal
  const uint32_t* twoSided;             // not 0: light counts from both sides
  const float *pick, *u, *v;            // random numbers in [0, 1)
  const uint8_t* wanted;                // not 0: a sample is wanted
};

struct ChosenLights { // by point; arrays are padded
  float* skyShare;    // selection probability of the sky
  uint32_t* shape;    // number of the shape; ~0: none
  float* probability; // selection probability of the shape, if the sky is not selected
};

// Returns the selection probability of the sky for a point. skyIrradiance: mean irradiance by the
// sky, 0 if there is none. shapes: sum of the importances of the shapes, which bounds theirs. Both
// keep a share, because a part of either may be hidden.
inline float skyShareOf(float skyIrradiance, float shapes) {
  if (!(shapes > 0)) return skyIrradiance > 0 ? 1 : 0;
  if (!(skyIrradiance > 0)) return 0;
  const float share = skyIrradiance / (skyIrradiance + shapes);
  return share < 0.0625f ? 0.0625f : share > 0.9375f ? 0.9375f : share;
}

// A direction towards a shape, sampled for each point that has one.
struct SampledLights {
  float *direction[3], *distance;
  // Where a shadow ray from the point ends, so that the shape does not block it; -1 for instances.
  float* end;
  float* pdf;      // solid-angle pdf for the selected shape; 0: no sample
  uint32_t* exact; // not 0: the sample is left to double precision
};

// Computes the share of the sky for each point. If the root of the tree is its only node, a shape
// is selected as well; `pick` selects first between sky and shapes, then the shape.
void chooseFromRoot(const LightNode& root, const LightPoints& points, float skyIrradiance,
                    const ChosenLights& out);
// Samples a direction towards the chosen shapes.
void sampleShapes(const ShapeArrays& shapes, const LightPoints& points, const ChosenLights& chosen,
                  const SampledLights& out);

} // namespace openrt
