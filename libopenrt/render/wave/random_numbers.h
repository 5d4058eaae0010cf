// random_numbers.h: the random numbers of the paths of a wave. Path tracing and light tracing draw
// them in the same way; they differ in the sequences that their paths belong to. [render]
#pragma once

#include <cstdint>

#include "render/wave/path_states.h"
#include "render/wave/sampler.h"

namespace openrt {

// Facts about a path's random decisions, as bits.
namespace RandomPath {
inline constexpr uint8_t decided = 1; // it has taken one
inline constexpr uint8_t inVain = 2;  // none of its random rays is known to have found light
inline constexpr uint8_t all = decided | inVain;
} // namespace RandomPath

// The samples that the paths of a wave are, by path.
struct PathSamples {
  uint32_t *key, *index;     // the sequence: hash(pixel, seed); the number of the point in it
  uint8_t* random = nullptr; // RandomPath bits; null: nobody asks

  void allocate(Arena& arena, uint32_t n) {
    key = arena.take<uint32_t>(n);
    index = arena.take<uint32_t>(n);
  }
  void set(uint32_t path, uint32_t pixel, uint32_t seed, uint32_t point) const {
    key[path] = hash(pixel, seed);
    index[path] = point;
  }
  void markRandom(uint32_t path) const { random[path] = RandomPath::all; }
};

// The random decisions at a surface. Each has a pair of dimensions of the sampler.
enum class Decision : uint32_t {
  direction, // the BSDF sample
  choice,    // which of several BSDF samples; Russian roulette
  emitter,   // camera paths: which emitter gets the light sample
  place,     // camera paths: the point on the emitter
  lens = 2,  // light paths: the point on the lens that they are connected to
  count = 4
};

// Returns the pair of dimensions of Decision::direction at a surface. first: the pairs before it
// are for the start of the path. level: number of surfaces that the path has hit before.
constexpr uint32_t pairAtLevel(uint32_t first, uint32_t level) {
  return first + uint32_t(Decision::count) * level;
}

// Returns the distance of the pairs of the lobe's decisions from those of lobe 0.
inline uint32_t pairOfLobe(uint32_t lobe) { return lobe ? hash(lobe, 0x6c6f6265u) : 0; }

// The points of the sampler that n paths are at. Each draw() returns a point of another pair of
// dimensions.
struct RandomNumbers {
  uint32_t count = 0;
  // PathSamples; the pair of Decision::direction
  const uint32_t *key = nullptr, *index = nullptr, *pair = nullptr;

  // Draws a point of the unit square for each path. The arrays are padded with zeros.
  void draw(Decision what, Arena& arena, float* square[2], uint32_t offset = 0) const {
    drawPair(uint32_t(what) + offset, arena, square);
  }
  void drawPair(uint32_t offset, Arena& arena, float* square[2]) const;
  // Draws only the second coordinates of the points of draw().
  float* drawSecond(Decision what, Arena& arena) const;
};

// Returns the random numbers at n hits. pair: pairAtLevel() for branch 0. order: lane in `states`
// of each hit.
RandomNumbers randomNumbersAt(const PathSamples& samples, const PathStates& states,
                              const uint32_t* order, uint32_t n, uint32_t pair, Arena& arena);

// Returns the random numbers for the starts of paths 0 to n - 1: pair 0, the first one.
RandomNumbers randomNumbersAtStart(const PathSamples& samples, uint32_t n, Arena& arena);

} // namespace openrt
