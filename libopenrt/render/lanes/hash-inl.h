// hash-inl.h: the hash functions of render/wave/sampler.h in vector lanes, with the same results.

#if defined(OPENRT_LANES_HASH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OPENRT_LANES_HASH_INL_H
#undef OPENRT_LANES_HASH_INL_H
#else
#define OPENRT_LANES_HASH_INL_H
#endif

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

inline Bits hash(Bits x) {
  x = hn::Xor(x, hn::ShiftRight<16>(x)) * bitsOf(0x7feb352du);
  x = hn::Xor(x, hn::ShiftRight<15>(x)) * bitsOf(0x846ca68bu);
  return hn::Xor(x, hn::ShiftRight<16>(x));
}
// Returns hash(a, b). hashOfB: hash(b)
inline Bits hash(Bits a, Bits hashOfB) {
  const Bits mixed = hn::ShiftLeft<6>(a) + hn::ShiftRight<2>(a);
  return hash(hn::Xor(a, hashOfB + bitsOf(0x9e3779b9u) + mixed));
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#endif
