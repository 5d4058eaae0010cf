// particle_clock.h: the time of a ParticleSystem. A running world sets it; the expansion of the
// node, which is what is drawn, is a function of the fields and of this alone. [the thread that
// owns the node]
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "xvrml/nodes.h"

namespace xvrml {

// A time in which particles are born.
struct Emission {
  // -infinity: since before the system's time 0, so that all particles that it can have are there.
  double from = -std::numeric_limits<double>::infinity();
  double until = std::numeric_limits<double>::infinity();
  uint64_t number = 0; // counts the emissions of a system
  double phase = 0;    // in [0,1): part of the places before the one that is filled first
};

// Times are seconds since the system became part of the world. One that is not part of a running
// world is at time 0.
struct ParticleClock {
  double now = 0;
  std::vector<Emission> emissions{{}}; // in their order
  uint32_t most = 10'000;              // particles that the world's budget has room for
  // Where SPRITEs face: the viewer's right and up in the system's coordinates.
  Vec3f right{1, 0, 0}, up{0, 1, 0};
};

struct TimedParticleSystem : nodes::ParticleSystem {
  using nodes::ParticleSystem::ParticleSystem;
  NodeRef* expansion() override { return &drawn_; }
  ParticleClock clock;

 private:
  NodeRef drawn_;
};

} // namespace xvrml
