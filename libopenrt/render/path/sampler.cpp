// sampler.cpp: vectorised sampling. It computes with integers only, so that all vector widths give
// the same numbers.
#include "render/path/sampler.h"

namespace openrt {

// target_clones is off under sanitizers, which cannot run in the ifunc resolver.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) &&    \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void samplePairs(uint32_t n, const uint32_t* __restrict key, const uint32_t* __restrict pair,
                 uint32_t draw, const uint32_t* __restrict index, float* __restrict x,
                 float* __restrict y) {
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t k = hash(key[i], pair[i] + draw);
    const uint32_t order = hash(k, 0x68bc21ebu), kx = hash(k, 0x02e5be93u),
                   ky = hash(k, 0x967a889bu);
    const uint32_t shuffled = reverseBits(scrambleReversed(reverseBits(index[i]), order));
    x[i] = toUnit(reverseBits(scrambleReversed(shuffled, kx)));
    y[i] = toUnit(reverseBits(scrambleReversed(sobol1Reversed(shuffled), ky)));
  }
}

} // namespace openrt
