// life.h: which particles of a system there are at a time. Each of maxParticles places holds one
// after another: the next one is born when the one before it ends. All have the same length of life
// at one place, so that a division finds the present one. Any thread.
#pragma once

#include <vector>

#include "base/particle_clock.h"

namespace xvrml {

struct LifeOfParticles {
  uint32_t most = 0;     // particles at a time
  double seconds = 0;    // mean length of a life
  double variation = 0;  // part by which lives differ, in [0,1]
  bool explodes = false; // those of an emission are born at once, where places are free
  uint64_t seed = 0;
};

struct LivingParticle {
  uint64_t key; // names the particle, for Draws
  double age;   // in seconds
  double life;  // its length in seconds
};

// Returns the phase of an emission that goes on where `last` has ended, for a mean life of this
// length.
double phaseAfter(const Emission& last, double seconds);

// Returns the particles at the clock's time, in the order of their places.
std::vector<LivingParticle> livingParticles(const LifeOfParticles& life,
                                            const ParticleClock& clock);

} // namespace xvrml
