// sampler.cpp: the sampler with vector lanes. The functions are those of sampler.h; they compute
// with integers, so that all instruction sets give the same numbers.
#include "render/wave/sampler.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/wave/sampler.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/hash-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Bits reverseBits(Bits x) { return bitsOf(openrt::reverseBits(hn::GetLane(x))); }
#else
// Reverses the order of the bytes, and the bits of each byte by a table for its halves.
Bits reverseBits(Bits x) {
  const hn::Repartition<uint8_t, BitsTag> tag;
  alignas(16) static constexpr uint8_t bytes[] = {3,  2,  1, 0, 7,  6,  5,  4,
                                                  11, 10, 9, 8, 15, 14, 13, 12};
  alignas(16) static constexpr uint8_t reversed[] = {0, 8, 4, 12, 2, 10, 6, 14,
                                                     1, 9, 5, 13, 3, 11, 7, 15};
  alignas(16) static constexpr uint8_t shifted[] = {0x00, 0x80, 0x40, 0xc0, 0x20, 0xa0, 0x60, 0xe0,
                                                    0x10, 0x90, 0x50, 0xd0, 0x30, 0xb0, 0x70, 0xf0};
  const Bits half = bitsOf(0x0f0f0f0fu);
  const Bits swapped =
      hn::BitCast(BitsTag(), hn::TableLookupBytes(hn::BitCast(tag, x), hn::LoadDup128(tag, bytes)));
  const auto low = hn::BitCast(tag, hn::And(swapped, half)),
             high = hn::BitCast(tag, hn::And(hn::ShiftRight<4>(swapped), half));
  return hn::BitCast(BitsTag(), hn::Or(hn::TableLookupBytes(hn::LoadDup128(tag, shifted), low),
                                       hn::TableLookupBytes(hn::LoadDup128(tag, reversed), high)));
}
#endif

Bits scrambleReversed(Bits x, Bits seed) {
  x = hn::Xor(x, x * bitsOf(0x3d20adeau)) + seed;
  x = x * hn::Or(hn::ShiftRight<16>(seed), bitsOf(1));
  x = hn::Xor(x, x * bitsOf(0x05526c56u));
  return hn::Xor(x, x * bitsOf(0x53a22864u));
}

Bits sobol1Reversed(Bits x) {
  x = hn::Xor(x, hn::ShiftRight<16>(x));
  x = hn::Xor(x, hn::ShiftRight<8>(hn::And(x, bitsOf(0xff00ff00u))));
  x = hn::Xor(x, hn::ShiftRight<4>(hn::And(x, bitsOf(0xf0f0f0f0u))));
  x = hn::Xor(x, hn::ShiftRight<2>(hn::And(x, bitsOf(0xccccccccu))));
  return hn::Xor(x, hn::ShiftRight<1>(hn::And(x, bitsOf(0xaaaaaaaau))));
}

Lanes toUnit(Bits x) {
  const hn::RebindToSigned<BitsTag> tag;
  return hn::ConvertTo(LanesTag(), hn::BitCast(tag, hn::ShiftRight<8>(x))) * lanesOf(0x1p-24f);
}

} // namespace

void samplePairs(uint32_t n, const uint32_t* key, const uint32_t* pair, uint32_t draw,
                 const uint32_t* index, float* x, float* y) {
  const Bits order = hash(bitsOf(0x68bc21ebu)), first = hash(bitsOf(0x02e5be93u)),
             second = hash(bitsOf(0x967a889bu));
  for (uint32_t i = 0; i < n; i += width()) {
    const Bits k = hash(loadSome(key + i, n - i), hash(loadSome(pair + i, n - i) + bitsOf(draw)));
    const Bits number = reverseBits(loadSome(index + i, n - i));
    const Bits shuffled = reverseBits(scrambleReversed(number, hash(k, order)));
    const Bits other = sobol1Reversed(shuffled);
    if (x) storeSome(toUnit(reverseBits(scrambleReversed(shuffled, hash(k, first)))), x + i, n - i);
    storeSome(toUnit(reverseBits(scrambleReversed(other, hash(k, second)))), y + i, n - i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {
HWY_EXPORT(samplePairs);
void samplePairs(uint32_t n, const uint32_t* key, const uint32_t* pair, uint32_t draw,
                 const uint32_t* index, float* x, float* y) {
  HWY_DYNAMIC_DISPATCH(samplePairs)(n, key, pair, draw, index, x, y);
}
} // namespace openrt
#endif
