// sampler.h: the sampler. Its low-discrepancy points are a pure function of (pixel, sample index,
// pair of dimensions, seed, samples per replicate). Each pair of dimensions is a (0,2)-sequence in
// base 2: Sobol's first two dimensions, Owen-scrambled by hashing as in B. Burley, "Practical
// Hash-based Owen Scrambling", JCGT 9(4), 2020 (hash constants: N. Vegdahl's search).
#pragma once

#include <cstdint>

namespace openrt {

[[gnu::always_inline]] inline uint32_t reverseBits(uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// Hashes an integer with full avalanche.
[[gnu::always_inline]] inline uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}
[[gnu::always_inline]] inline uint32_t hash(uint32_t a, uint32_t b) {
  return hash(a ^ (hash(b) + 0x9e3779b9u + (a << 6) + (a >> 2)));
}

// Owen-scrambles a number in reversed bit order: every bit is flipped by a hash of the bits below
// it.
[[gnu::always_inline]] inline uint32_t scrambleReversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// Returns the second Sobol dimension of an index in reversed bit order. Its direction numbers,
// reversed, are the polynomials (1+x)^i over GF(2). So the sum over the index's bits is the index
// as a polynomial evaluated at 1+x, which is computed by repeated halving.
[[gnu::always_inline]] inline uint32_t sobol1Reversed(uint32_t x) {
  x ^= x >> 16;
  x ^= (x & 0xff00ff00u) >> 8;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xaaaaaaaau) >> 1;
  return x;
}

// Maps sample numbers to points of the sequence. The samples of a pixel are divided into
// consecutive replicates of 2^shift samples. Each replicate is an independently randomised net with
// its own seed, so the spread of the replicates' means estimates the error. The first replicate
// uses the frame's seed.
struct Replicates {
  uint32_t seed = 0, shift = 31; // 31: a single net, no replicates
  bool operator==(const Replicates&) const = default;
  bool many() const { return shift < 31; }
  uint32_t size() const { return 1u << shift; }
  uint32_t indexOf(uint32_t sample) const { return sample & (size() - 1); }
  uint32_t seedOf(uint32_t sample) const {
    return sample >> shift ? hash(seed, sample >> shift) : seed;
  }
};

// Maps an integer to a float in [0, 1).
[[gnu::always_inline]] inline float toUnit(uint32_t x) { return float(x >> 8) * 0x1p-24f; }

// Samples one pair of dimensions in one pixel. The first 2^k samples are a (0,k,2)-net for every k.
class PairSampler {
 public:
  PairSampler(uint32_t pixel, uint32_t pair, uint32_t seed) {
    const uint32_t key = hash(hash(pixel, seed), pair);
    order_ = hash(key, 0x68bc21ebu);
    x_ = hash(key, 0x02e5be93u);
    y_ = hash(key, 0x967a889bu);
  }
  void operator()(uint32_t index, float& x, float& y) const {
    // Shuffling the index decorrelates the pairs of a pixel.
    const uint32_t shuffled = reverseBits(scrambleReversed(reverseBits(index), order_));
    x = toUnit(reverseBits(scrambleReversed(shuffled, x_)));
    y = toUnit(reverseBits(scrambleReversed(sobol1Reversed(shuffled), y_)));
  }

 private:
  uint32_t order_, x_, y_;
};

// Does the same with vector lanes: writes point index[i] of the pair pair[i] + draw, where key[i]
// is hash(pixel, seed). The arrays have n elements. x: null if nobody reads the first coordinates.
void samplePairs(uint32_t n, const uint32_t* key, const uint32_t* pair, uint32_t draw,
                 const uint32_t* index, float* x, float* y);

} // namespace openrt
