#include "backend/local/accel/packet_lanes.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backend/local/accel/packet_lanes.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

// The functions work with 8 lanes for packets of 8 rays, with 16 for the others.
template <uint32_t size> struct Of {
  using Tag = hn::CappedTag<float, size>;
  using Integers = hn::RebindToUnsigned<Tag>;
  using V = hn::Vec<Tag>;
  using M = hn::Mask<Tag>;
  static uint32_t width() { return uint32_t(hn::Lanes(Tag())); }
  static V value(float v) { return hn::Set(Tag(), v); }
  static V load(const float* from) { return hn::LoadU(Tag(), from); }
  static Vec3<V> load(const float* const from[3], size_t i) {
    return {load(from[0] + i), load(from[1] + i), load(from[2] + i)};
  }
  static void store(V v, float* to) { hn::StoreU(v, Tag(), to); }
  static void store(const Vec3<V>& v, float* const to[3], size_t i) {
    store(v.x, to[0] + i);
    store(v.y, to[1] + i);
    store(v.z, to[2] + i);
  }
  template <class T> static void store(hn::Vec<Integers> v, T* to) {
    hn::StoreU(v, Integers(), reinterpret_cast<uint32_t*>(to));
  }
  // Returns where the numbers differ from `value`.
  template <class T> static M differs(const T* from, uint32_t value) {
    const auto v = hn::LoadU(Integers(), reinterpret_cast<const uint32_t*>(from));
    return hn::RebindMask(Tag(), hn::Ne(v, hn::Set(Integers(), value)));
  }
  // Returns a bit for each lane, from bit 0 on.
  static uint32_t bits(M mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(Tag(), mask, bytes);
    return uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8;
  }

  static uint32_t loadPacket(const Rays& rays, const float* ends, uint32_t first, float scale,
                             float most, uint32_t mask, int* valid, const PacketRays& to) {
    const V zero = value(0), one = value(1), largest = value(most), limit = value(most / scale),
            unit = value(scale), last = value(std::numeric_limits<float>::max());
    const Vec3<V> none{zero, zero, zero}, forward{zero, zero, one};
    uint32_t refused = 0;
    for (uint32_t i = 0; i < size; i += width()) {
      const Vec3<V> org = load(rays.org, first + i), dir = load(rays.dir, first + i);
      const V near = load(rays.tnear + first + i), far = load(ends + i);
      const Vec3<V> distance = abs(org);
      const V length = abs(dir.x) + abs(dir.y) + abs(dir.z);
      // Comparisons with NaN are false, so NaN is rejected.
      const M inside =
          hn::And(distance.x <= limit, hn::And(distance.y <= limit, distance.z <= limit));
      const M directed = hn::And(length > zero, length <= largest);
      const M interval = hn::And(hn::And(near >= zero, near <= far), near <= last);
      const M good = hn::And(inside, hn::And(directed, interval));
      const auto number = hn::Iota(Integers(), first + i);
      const M present = hn::RebindMask(Tag(), number < hn::Set(Integers(), rays.count));
      refused += uint32_t(std::popcount(bits(hn::AndNot(good, present))));
      const auto traced = hn::RebindMask(Integers(), hn::And(present, good));
      store(hn::IfThenElseZero(traced, hn::Set(Integers(), ~0u)), valid + i);
      store(select(good, org * unit, none), to.org, i);
      store(select(good, dir, forward), to.dir, i);
      store(select(good, near * unit, zero), to.tnear + i);
      store(select(good, far * unit, zero), to.tfar + i);
      store(zero, to.time + i);
      store(hn::Set(Integers(), mask), to.mask + i);
      store(number, to.id + i);
      store(hn::Zero(Integers()), to.flags + i);
    }
    return refused;
  }

  static PacketMet storePacket(const PacketHits& packet, const Rays& rays, const int* valid,
                               uint32_t first, float unscale, const RayHits& hits) {
    PacketMet met{0, 0};
    const V infinite = value(std::numeric_limits<float>::infinity());
    for (uint32_t i = 0; i < size; i += width()) {
      const M hit = hn::And(differs(valid + i, 0), differs(packet.geometry + i, ~0u));
      const Vec3<V> ng = load(packet.ng, i), dir = load(rays.dir, first + i);
      store(select(hit, load(packet.tfar + i) * value(unscale), infinite), hits.t + first + i);
      store(load(packet.u + i), hits.u + first + i);
      store(load(packet.v + i), hits.v + first + i);
      store(ng, hits.ng, first + i);
      // The formula of grazes() in ray_triangle.h.
      const V along = dot(ng, dir);
      const M steep = along * along > value(0x1p-12f) * dot(ng, ng) * dot(dir, dir);
      met.hit |= bits(hit) << i;
      met.grazing |= bits(hn::AndNot(steep, hit)) << i;
    }
    return met;
  }
};

} // namespace

uint32_t loadPacket(const Rays& rays, const float* ends, uint32_t first, uint32_t size, float scale,
                    float limit, uint32_t mask, int* valid, const PacketRays& to) {
  return (size == 8 ? Of<8>::loadPacket : Of<16>::loadPacket)(rays, ends, first, scale, limit, mask,
                                                              valid, to);
}

PacketMet storePacket(const PacketHits& packet, const Rays& rays, const int* valid, uint32_t first,
                      uint32_t size, float unscale, const RayHits& hits) {
  return (size == 8 ? Of<8>::storePacket : Of<16>::storePacket)(packet, rays, valid, first, unscale,
                                                                hits);
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {
HWY_EXPORT(loadPacket);
HWY_EXPORT(storePacket);
uint32_t loadPacket(const Rays& rays, const float* ends, uint32_t first, uint32_t size, float scale,
                    float limit, uint32_t mask, int* valid, const PacketRays& to) {
  return HWY_DYNAMIC_DISPATCH(loadPacket)(rays, ends, first, size, scale, limit, mask, valid, to);
}
PacketMet storePacket(const PacketHits& packet, const Rays& rays, const int* valid, uint32_t first,
                      uint32_t size, float unscale, const RayHits& hits) {
  return HWY_DYNAMIC_DISPATCH(storePacket)(packet, rays, valid, first, size, unscale, hits);
}
} // namespace openrt
#endif
