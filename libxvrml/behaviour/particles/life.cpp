// life.cpp: births and ends of particles, as a closed form of the time.
#include "behaviour/particles/life.h"

#include <algorithm>
#include <bit>

#include "behaviour/particles/draws.h"

namespace xvrml {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// The births at one place during one emission.
struct Births {
  double first;
  double last; // none is later
};

Births birthsOf(const Emission& emission, uint32_t place, double free, double now,
                const LifeOfParticles& life) {
  const bool always = std::isinf(emission.from);
  // The first ones follow each other evenly, so that all places are filled after a mean life.
  const double part = double(place) / life.most - emission.phase;
  const double delay = life.explodes ? 0 : (part < 0 ? part + 1 : part) * life.seconds;
  const double from = !always         ? emission.from
                      : life.explodes ? 0
                                      : -life.seconds * (1 + life.variation);
  const bool misses = life.explodes && free > from; // the place is taken at the time of the bang
  const double first = misses ? never : std::max(from + delay, free);
  return {first, life.explodes ? first : std::min(now, emission.until)};
}

} // namespace

double phaseAfter(const Emission& last, double seconds) {
  if (!(seconds > 0) || !std::isfinite(last.until)) return 0;
  // One without a beginning counts from time 0: birthsOf has it begin a life earlier.
  const double from = std::isinf(last.from) ? 0 : last.from;
  const double rounds = last.phase + (last.until - from) / seconds;
  const double phase = rounds - std::floor(rounds);
  return phase < 1 ? phase : 0; // not a number, or rounded up
}

std::vector<LivingParticle> livingParticles(const LifeOfParticles& life,
                                            const ParticleClock& clock) {
  std::vector<LivingParticle> all;
  for (uint32_t place = 0; place < life.most; ++place) {
    const uint64_t at = mixed(life.seed, place);
    const double length = Draws(at, Stream::life).around(life.seconds, life.variation);
    if (!(length > 0)) continue;
    double free = -std::numeric_limits<double>::infinity(); // when the last particle ends
    for (const Emission& emission : clock.emissions) {
      const Births births = birthsOf(emission, place, free, clock.now, life);
      if (births.first > std::min({births.last, clock.now, emission.until})) continue;
      const double number = std::floor((births.last - births.first) / length);
      const double birth = births.first + number * length;
      const double age = std::clamp(clock.now - birth, 0.0, length);
      free = birth + length;
      // While births go on there is always one, whatever the division has rounded.
      if (age < length || (births.last == clock.now && !life.explodes))
        all.push_back(
            {mixed(at, mixed(emission.number, std::bit_cast<uint64_t>(number))), age, length});
    }
  }
  return all;
}

} // namespace xvrml
