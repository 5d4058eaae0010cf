// compress-inl.h: compaction with vector lanes: appends the lanes where a condition holds to
// arrays.

#if defined(OPENRT_LANES_COMPRESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OPENRT_LANES_COMPRESS_INL_H
#undef OPENRT_LANES_COMPRESS_INL_H
#else
#define OPENRT_LANES_COMPRESS_INL_H
#endif

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

// Writes the lanes where the condition holds to the elements from `at` on. The elements after them,
// up to the width of a vector, may be overwritten.
struct Compressed {
  Mask condition;
  size_t at;
  void operator()(Lanes v, float* to) const {
    hn::CompressStore(v, condition, LanesTag(), to + at);
  }
  void operator()(Bits v, uint32_t* to) const {
    hn::CompressStore(v, maskOf(condition), BitsTag(), to + at);
  }
  void operator()(const LaneVec& v, float* const to[3]) const {
    (*this)(v.x, to[0]);
    (*this)(v.y, to[1]);
    (*this)(v.z, to[2]);
  }
};

// Returns the number of lanes where the condition holds.
inline uint32_t countTrue(Mask condition) { return uint32_t(hn::CountTrue(LanesTag(), condition)); }

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#endif
