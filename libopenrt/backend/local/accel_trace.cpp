// accel_trace.cpp: rays in, hits out. Every ray is checked before Embree sees it: a build with assertions would end the
// process on one that is not finite.
#include <cmath>
#include <limits>

#include "backend/local/accel.h"

namespace openrt {
namespace {

struct Packet16 {
  static constexpr uint32_t width = 16;
  using RayHit = RTCRayHit16;
  using Ray = RTCRay16;
  static void intersect(RTCScene s, const int* v, RayHit& r, Query& q) { intersect16(s, v, r, q); }
  static void occluded(RTCScene s, const int* v, Ray& r, bool c) { occluded16(s, v, r, c); }
};
struct Packet8 {
  static constexpr uint32_t width = 8;
  using RayHit = RTCRayHit8;
  using Ray = RTCRay8;
  static void intersect(RTCScene s, const int* v, RayHit& r, Query& q) { intersect8(s, v, r, q); }
  static void occluded(RTCScene s, const int* v, Ray& r, bool c) { occluded8(s, v, r, c); }
};

// Fills a packet from lane `first` on; returns how many of its rays were refused. Refused and absent rays are made harmless.
template <uint32_t W, class Ray>
uint32_t load(const Rays& rays, uint32_t first, float scale, uint32_t mask, int* valid, Ray& to) {
  const float limit = 1e18f / scale;
  uint32_t refused = 0;
  for (uint32_t i = 0; i < W; i++) {
    const uint32_t lane = first + i;
    const float ox = rays.org[0][lane], oy = rays.org[1][lane], oz = rays.org[2][lane];
    const float dx = rays.dir[0][lane], dy = rays.dir[1][lane], dz = rays.dir[2][lane];
    const float near = rays.tnear[lane], far = rays.tfar[lane];
    const float d = std::fabs(dx) + std::fabs(dy) + std::fabs(dz);
    // Comparisons are false for NaN: whatever is not a number is refused.
    const bool good = (std::fabs(ox) <= limit) & (std::fabs(oy) <= limit) & (std::fabs(oz) <= limit) & (d > 0) & (d <= 1e18f) &
                      (near >= 0) & (near <= far) & (near < std::numeric_limits<float>::infinity());
    const bool present = lane < rays.count;
    refused += present & !good;
    valid[i] = present & good ? -1 : 0;
    to.org_x[i] = good ? ox * scale : 0, to.org_y[i] = good ? oy * scale : 0, to.org_z[i] = good ? oz * scale : 0;
    to.dir_x[i] = good ? dx : 0, to.dir_y[i] = good ? dy : 0, to.dir_z[i] = good ? dz : 1;
    to.tnear[i] = good ? near * scale : 0;
    to.tfar[i] = good ? far * scale : 0;
    to.time[i] = 0;
    to.mask[i] = mask;
    to.id[i] = lane;
    to.flags[i] = 0;
  }
  return refused;
}

} // namespace

Accel::Found Accel::find(uint32_t instance, uint32_t geometry, uint32_t primitive) const {
  uint32_t base = 0;
  const PartScene* scene = &root_;
  if (instance != RTC_INVALID_GEOMETRY_ID) {
    const Part& placed = *root_.parts[instance];
    base = placed.record;
    scene = objectScenes_[placed.objectScene].get();
  }
  const Part& part = *scene->parts[geometry];
  if (part.recordOf.empty()) return {base + part.record, primitive};
  return {base + part.recordOf[primitive], part.primitiveOf[primitive]};
}

// Ray and normal are both in the frame of the instance that is being met, if any: the sign of their product is the same in all.
void Accel::rejectBacks(const RTCFilterFunctionNArguments* a) {
  const Accel& self = *static_cast<const Accel*>(static_cast<const QueryContext*>(a->context)->user);
  for (unsigned i = 0; i < a->N; i++) {
    if (a->valid[i] != -1) continue;
    const Found found =
        self.find(RTCHitN_instID(a->hit, a->N, i, 0), RTCHitN_geomID(a->hit, a->N, i), RTCHitN_primID(a->hit, a->N, i));
    const Record& r = self.records[found.record];
    if (!r.cull) continue;
    const float along = RTCHitN_Ng_x(a->hit, a->N, i) * RTCRayN_dir_x(a->ray, a->N, i) +
                        RTCHitN_Ng_y(a->hit, a->N, i) * RTCRayN_dir_y(a->ray, a->N, i) +
                        RTCHitN_Ng_z(a->hit, a->N, i) * RTCRayN_dir_z(a->ray, a->N, i);
    if (r.flip ? along < 0 : along > 0) a->valid[i] = 0;
  }
}

template <class Packet>
void Accel::intersectPackets(const Rays& rays, uint32_t mask, const QueryOptions& options, RayHits& hits) const {
  constexpr uint32_t W = Packet::width;
  alignas(64) int valid[W];
  alignas(64) typename Packet::RayHit packet;
  const float unscale = 1 / scale_;
  uint64_t refused = 0;
  for (uint32_t first = 0; first < rays.count; first += W) {
    refused += load<W>(rays, first, scale_, mask, valid, packet.ray);
    for (uint32_t i = 0; i < W; i++) packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    Query query(options);
    Packet::intersect(root_.scene, valid, packet, query);
    const uint32_t n = std::min(W, rays.count - first);
    for (uint32_t i = 0; i < n; i++) {
      const uint32_t lane = first + i;
      if (!valid[i] || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
        hits.record[lane] = noHit;
        hits.t[lane] = std::numeric_limits<float>::infinity();
        continue;
      }
      const Found found = find(packet.hit.instID[0][i], packet.hit.geomID[i], packet.hit.primID[i]);
      hits.record[lane] = found.record;
      hits.primitive[lane] = found.primitive;
      hits.t[lane] = packet.ray.tfar[i] * unscale;
      hits.u[lane] = packet.hit.u[i];
      hits.v[lane] = packet.hit.v[i];
      hits.ng[0][lane] = packet.hit.Ng_x[i], hits.ng[1][lane] = packet.hit.Ng_y[i], hits.ng[2][lane] = packet.hit.Ng_z[i];
    }
  }
  if (refused) rejectedRays += refused;
}

template <class Packet> void Accel::occludedPackets(const Rays& rays, uint32_t mask, bool coherent, uint8_t* blocked) const {
  constexpr uint32_t W = Packet::width;
  alignas(64) int valid[W];
  alignas(64) typename Packet::Ray packet;
  uint64_t refused = 0;
  for (uint32_t first = 0; first < rays.count; first += W) {
    refused += load<W>(rays, first, scale_, mask, valid, packet);
    Packet::occluded(root_.scene, valid, packet, coherent);
    const uint32_t n = std::min(W, rays.count - first);
    for (uint32_t i = 0; i < n; i++) blocked[first + i] = valid[i] && packet.tfar[i] < 0; // Embree writes -infinity
  }
  if (refused) rejectedRays += refused;
}

void Accel::intersect(const Rays& rays, uint32_t mask, Coherence coherence, RayHits& hits) const {
  const bool coherent = coherence == Coherence::coherent;
  if (device_->wide && !hasInstances)
    intersectPackets<Packet16>(rays, mask, {coherent}, hits);
  else
    intersectPackets<Packet8>(rays, mask, {coherent && !hasInstances}, hits);
}

void Accel::intersectFronts(const Rays& rays, uint32_t mask, RayHits& hits) const {
  intersectPackets<Packet8>(rays, mask, {false, rejectBacks, this}, hits);
}

void Accel::occluded(const Rays& rays, uint32_t mask, Coherence coherence, uint8_t* blocked) const {
  const bool coherent = coherence == Coherence::coherent;
  if (device_->wide && !hasInstances)
    occludedPackets<Packet16>(rays, mask, coherent, blocked);
  else
    occludedPackets<Packet8>(rays, mask, coherent && !hasInstances, blocked);
}

} // namespace openrt
