// form.h: what one particle looks like (geometryType), and how its colour and texture coordinates
// go with its age. Any thread that owns the nodes.
#pragma once

#include <string_view>
#include <vector>

#include "base/particle_clock.h"
#include "behaviour/particles/life.h"
#include "geometry/builders.h"
#include "geometry/vector_math.h"

namespace xvrml {

// A mesh around the place of a particle.
struct ParticleForm {
  Mesh::Kind kind = Mesh::Kind::triangles; // or lines, or points
  std::vector<V3d> points;
  std::vector<Vec3f> normals; // empty: flat
  std::vector<Vec2f> texCoords;
  std::vector<Vec4f> texPlaces; // as those of a Mesh
  std::vector<float> fogCoords;
  std::vector<uint32_t> indices; // as those of a Mesh
  bool solid = false, ccw = true;
  bool isQuad = false;  // its corners take those of texCoordRamp
  bool isAlong = false; // its z axis is the direction in which the particle moves
};
ParticleForm formOf(const nodes::ParticleSystem& system, const ParticleClock& clock);

// Returns whether geometryType is one of the standard's.
bool isKnownForm(std::string_view geometryType);

// The colours and texture coordinates of particles by age (40.4.5).
class ParticleRamps {
 public:
  explicit ParticleRamps(const nodes::ParticleSystem& system);

  bool hasColors() const { return !colorKeys_.empty(); }
  bool hasAlphas() const { return !colors_.alphas.empty(); }
  Color4 color(const LivingParticle& particle) const;
  // Returns the corners of a quad: counter-clockwise, from the lower left one.
  std::span<const Vec2f> corners(const LivingParticle& particle) const;

 private:
  ColorValues colors_;
  std::span<const float> colorKeys_, cornerKeys_;
  TexCoordValues corners_;
};

} // namespace xvrml
