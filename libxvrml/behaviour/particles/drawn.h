// drawn.h: a ParticleSystem as the Shape that is drawn for it. [the thread that owns the node]
#pragma once

#include <string>

#include "base/particle_clock.h"

namespace xvrml {

// The number of particles that a system has room for.
struct ParticleRoom {
  uint32_t count = 0;
  uint64_t bytes = 0; // what one of them takes
  std::string limit;  // what bounds it if that is not maxParticles; else empty
};
ParticleRoom roomOf(const nodes::ParticleSystem& system);

} // namespace xvrml
