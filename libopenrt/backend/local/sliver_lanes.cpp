#include "backend/local/sliver_lanes.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/local/sliver_lanes.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

template <uint32_t size> struct RaysOf {
  using Tag = hn::CappedTag<float, size>;
  using Integers = hn::RebindToSigned<Tag>;
  using V = hn::Vec<Tag>;
  using M = hn::Mask<Tag>;
  static V value(float v) { return hn::Set(Tag(), v); }
  static Vec3<V> value(const float v[3]) { return {value(v[0]), value(v[1]), value(v[2])}; }
  static Vec3<V> loadAt(const float* const from[3], uint32_t i) {
    return {hn::LoadU(Tag(), from[0] + i), hn::LoadU(Tag(), from[1] + i),
            hn::LoadU(Tag(), from[2] + i)};
  }
  static V largestOf(const Vec3<V>& v) {
    return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
  }

  // A ray misses if it passes two edges clearly on different sides.
  static uint32_t mayHit(const SliverOutline& s, const PacketLines& rays) {
    uint32_t found = 0;
    const Vec3<V> center = value(s.center);
    for (uint32_t i = 0; i < size; i += uint32_t(hn::Lanes(Tag()))) {
      const Vec3<V> origin = loadAt(rays.origin, i) - center, d = loadAt(rays.direction, i);
      const V reach = (value(s.extent) + largestOf(origin)) * largestOf(d),
              slack = value(s.doubt) * reach;
      const Vec3<V> twice = cross(d, origin) * value(2);
      const auto side = [&](int k) {
        return dot(value(s.moment[k]), d) + dot(value(s.edge[k]), twice);
      };
      const V p = side(0), q = side(1), r = side(2);
      const V most = hn::Max(hn::Max(p, q), r), least = hn::Min(hn::Min(p, q), r);
      const M apart = hn::And(most > slack, least < hn::Neg(slack)),
              inRange = hn::And(reach > value(1e-20f), reach < value(1e20f)),
              traced = hn::RebindMask(Tag(),
                                      hn::LoadU(Integers(), rays.valid + i) < hn::Zero(Integers()));
      uint8_t bits[8] = {};
      hn::StoreMaskBits(Tag(), hn::AndNot(hn::And(apart, inRange), traced), bits);
      found |= (uint32_t(bits[0]) | uint32_t(bits[1]) << 8) << i;
    }
    return found;
  }
};

} // namespace

uint32_t mayHit(const SliverOutline& sliver, const PacketLines& rays) {
  switch (rays.size) {
  case 1: return RaysOf<1>::mayHit(sliver, rays);
  case 4: return RaysOf<4>::mayHit(sliver, rays);
  case 8: return RaysOf<8>::mayHit(sliver, rays);
  default: return RaysOf<16>::mayHit(sliver, rays);
  }
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {
HWY_EXPORT(mayHit);

uint32_t mayHit(const SliverOutline& sliver, const PacketLines& rays) {
  return HWY_DYNAMIC_DISPATCH(mayHit)(sliver, rays);
}

SliverOutline::SliverOutline(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3f middle((min(min(a, b), c) + max(max(a, b), c)) * 0.5);
  store(middle, center);
  const Vec3d corner[3] = {a - Vec3d(middle), b - Vec3d(middle), c - Vec3d(middle)};
  constexpr int from[3] = {0, 1, 2}, to[3] = {2, 0, 1};
  double longest = 0, most = 0;
  for (int k = 0; k < 3; k++) {
    const Vec3d &p = corner[from[k]], &q = corner[to[k]], e = q - p;
    store(Vec3f(e), edge[k]);
    store(Vec3f(cross(e, q + p)), moment[k]);
    longest = std::max(longest, largest(abs(e)));
    most = std::max(most, largest(abs(p)));
  }
  extent = float(most);
  // With E the longest edge and R the ray's `reach`, the kernels' rounding and the tolerance at
  // open edges change a side by less than 2^-18 E R. A side is a sum of 6 products of at most 4 E R
  // with at most 7 roundings: it errs by less than 2^-17.4 E R.
  const bool inRange = longest > 1e-13 && longest < 1e13;
  doubt = inRange ? 0x1p-16f * float(longest) : std::numeric_limits<float>::infinity();
}

} // namespace openrt
#endif
