// motion.h: how particles move after their birth (ISO/IEC 19775-1 40.2.2): under forces that stay
// the same for the life of a particle, so that its way is a parabola, and off surfaces that turn it
// back. Any thread that owns the nodes.
#pragma once

#include "behaviour/particles/emitter.h"
#include "behaviour/particles/facets.h"

namespace xvrml {

struct Motion {
  V3d place, velocity;
};

class ParticlePhysics {
 public:
  explicit ParticlePhysics(const MFNode& models);

  // Returns the force on a particle in newtons.
  V3d force(uint64_t particle, double surfaceArea) const;
  // Returns where a particle is after these seconds. acceleration: that of its whole life.
  Motion after(const Motion& start, const V3d& acceleration, double seconds) const;
  uint64_t facets() const { return bounds_.size(); }

 private:
  struct Wind {
    V3d direction;
    double speed, gustiness, angle;
    uint64_t number; // place in `physics`
  };
  struct Hit {
    double seconds;
    const Facet* facet = nullptr;
  };
  Hit nextHit(const Motion& motion, const V3d& acceleration, double seconds) const;

  V3d constant_{0, 0, 0};
  std::vector<Wind> winds_;
  std::vector<Facet> bounds_;
};

} // namespace xvrml
