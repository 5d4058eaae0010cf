// accel_trace.cpp: traces rays through both Embree scenes. Every ray is checked first, because an
// Embree build with assertions aborts the process on a ray that is not finite. Called by render
// threads and the threads of queries.
#include <algorithm>
#include <limits>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/packet_lanes.h"
#include "backend/local/ray_triangle.h"

namespace openrt {
namespace {

struct Packet16 {
  static constexpr uint32_t width = 16;
  using RayHit = RTCRayHit16;
  using Ray = RTCRay16;
  static void intersect(RTCScene s, const int* v, RayHit& r, Query& q) { intersect16(s, v, r, q); }
  static void occluded(RTCScene s, const int* v, Ray& r, OcclusionQuery& q) {
    occluded16(s, v, r, q);
  }
};
struct Packet8 {
  static constexpr uint32_t width = 8;
  using RayHit = RTCRayHit8;
  using Ray = RTCRay8;
  static void intersect(RTCScene s, const int* v, RayHit& r, Query& q) { intersect8(s, v, r, q); }
  static void occluded(RTCScene s, const int* v, Ray& r, OcclusionQuery& q) {
    occluded8(s, v, r, q);
  }
};

// Recomputes a hit at a grazing angle in double precision.
void refineGrazingHit(const Record& r, const Rays& rays, float far, RayHits& hits, uint32_t lane) {
  if (r.primitive != edit::Primitive::Triangles) return;
  const Vec3f kernel = load(hits.ng, lane),
              n = r.instanced ? r.frames->kernelNormal * kernel : kernel, d = load(rays.dir, lane);
  if (!grazes(n, d)) return;
  const RaySegment ray{Vec3d(load(rays.org, lane)), Vec3d(d), rays.tnear[lane], far};
  if (const auto hit = refineHit(r, hits.primitive[lane], ray)) {
    hits.t[lane] = float(hit->t);
    hits.u[lane] = float(hit->u);
    hits.v[lane] = float(hit->v);
  }
}

// Returns the arrays of a packet of rays.
template <class Ray> PacketRays arraysOf(Ray& to) {
  return {{to.org_x, to.org_y, to.org_z},
          {to.dir_x, to.dir_y, to.dir_z},
          to.tnear,
          to.tfar,
          to.mask,
          to.id,
          to.flags,
          to.time};
}

} // namespace

PrimitiveId Accel::find(const PartScene& root, uint32_t instance, uint32_t geometry,
                        uint32_t primitive) {
  uint32_t base = 0;
  const PartScene* scene = &root;
  if (instance != RTC_INVALID_GEOMETRY_ID) {
    const PartSlot& placed = root.parts[instance];
    base = placed.record;
    scene = placed.object.get();
  }
  PrimitiveId found = scene->parts[geometry].part->primitives.find(primitive);
  found.record += base;
  return found;
}

float Accel::placeOnLine(const PartScene& scene, uint32_t geometry, uint32_t primitive, float u) {
  const std::vector<Part::Span>& spans = scene.parts[geometry].part->spans;
  if (spans.empty()) return u;
  const Part::Span& span = spans[primitive];
  return span.from + std::clamp(u, 0.0f, 1.0f) * (span.to - span.from);
}

PrimitiveId Accel::primitiveOfHit(const RTCFilterFunctionNArguments* a, unsigned i) {
  const FilterContext& self =
      *static_cast<const FilterContext*>(static_cast<const QueryContext*>(a->context)->user);
  return find(*self.level->scene, RTCHitN_instID(a->hit, a->N, i, 0),
              RTCHitN_geomID(a->hit, a->N, i), RTCHitN_primID(a->hit, a->N, i));
}

// Ray and normal are both in the frame of the instance, if any; the sign of their dot product is
// the same in every frame.
void Accel::rejectBacks(const RTCFilterFunctionNArguments* a) {
  const FilterContext& self =
      *static_cast<const FilterContext*>(static_cast<const QueryContext*>(a->context)->user);
  for (unsigned i = 0; i < a->N; i++) {
    if (a->valid[i] != -1) continue;
    const PrimitiveId hit = primitiveOfHit(a, i);
    const Record& r = self.accel->records[hit.record];
    if (!r.cull) continue;
    if (r.stippled &&
        r.isGap(hit.primitive,
                placeOnLine(*self.level->scene, RTCHitN_geomID(a->hit, a->N, i),
                            RTCHitN_primID(a->hit, a->N, i), RTCHitN_u(a->hit, a->N, i)))) {
      a->valid[i] = 0;
      continue;
    }
    const float along = RTCHitN_Ng_x(a->hit, a->N, i) * RTCRayN_dir_x(a->ray, a->N, i) +
                        RTCHitN_Ng_y(a->hit, a->N, i) * RTCRayN_dir_y(a->ray, a->N, i) +
                        RTCHitN_Ng_z(a->hit, a->N, i) * RTCRayN_dir_z(a->ray, a->N, i);
    if (r.flip ? along < 0 : along > 0) a->valid[i] = 0;
  }
}

void Accel::rejectRecord(const RTCFilterFunctionNArguments* a) {
  const FilterContext& self =
      *static_cast<const FilterContext*>(static_cast<const QueryContext*>(a->context)->user);
  for (unsigned i = 0; i < a->N; i++)
    if (a->valid[i] == -1 &&
        primitiveOfHit(a, i).record == self.record[RTCRayN_id(a->ray, a->N, i)])
      a->valid[i] = 0;
}

// first: whether this level is traced first, so that `hits` is overwritten. Otherwise `hits` holds
// the hits of the other level, which shorten the rays.
template <class Packet> void Accel::intersectPackets(const Level& level, const Rays& rays,
                                                     uint32_t mask, const QueryOptions& options,
                                                     bool first, RayHits& hits) const {
  constexpr uint32_t W = Packet::width;
  alignas(64) int valid[W];
  alignas(64) typename Packet::RayHit packet;
  alignas(64) float ends[W] = {};
  const float unscale = 1 / scale_;
  uint64_t refused = 0;
  for (uint32_t begin = 0; begin < rays.count; begin += W) {
    const uint32_t n = std::min(W, rays.count - begin);
    if (!first)
      for (uint32_t i = 0; i < n; i++) ends[i] = std::min(rays.tfar[begin + i], hits.t[begin + i]);
    const PacketRays to = arraysOf(packet.ray);
    const float* const until = first ? rays.tfar + begin : ends;
    FarRays far;
    uint32_t bad = loadPacket(rays, until, begin, W, scale_, level.limit, mask, valid, to);
    if (bad) bad = moveNear(rays, until, begin, W, valid, to, far);
    if (first) refused += bad;
    for (uint32_t i = 0; i < W; i++)
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    Query query(options);
    Packet::intersect(level.scene->scene, valid, packet, query);
    if (first) {
      const PacketMet met = storePacket({packet.ray.tfar,
                                         packet.hit.u,
                                         packet.hit.v,
                                         {packet.hit.Ng_x, packet.hit.Ng_y, packet.hit.Ng_z},
                                         packet.hit.geomID},
                                        rays, valid, begin, W, unscale, hits);
      for (uint32_t i = 0; i < n; i++) {
        const uint32_t lane = begin + i;
        if (!(met.hit >> i & 1)) {
          hits.record[lane] = noHit;
          continue;
        }
        const PrimitiveId found =
            find(*level.scene, packet.hit.instID[0][i], packet.hit.geomID[i], packet.hit.primID[i]);
        hits.record[lane] = found.record;
        hits.primitive[lane] = found.primitive;
        if (far.lanes >> i & 1) hits.t[lane] = float(far.distance(i, packet.ray.tfar[i]));
        const Record& record = records[found.record];
        if (record.primitive == edit::Primitive::Lines)
          hits.u[lane] =
              placeOnLine(*level.scene, packet.hit.geomID[i], packet.hit.primID[i], hits.u[lane]);
        if (record.instanced || met.grazing >> i & 1)
          refineGrazingHit(record, rays, rays.tfar[lane], hits, lane);
      }
      continue;
    }
    for (uint32_t i = 0; i < n; i++) {
      const uint32_t lane = begin + i;
      if (!valid[i] || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const PrimitiveId found =
          find(*level.scene, packet.hit.instID[0][i], packet.hit.geomID[i], packet.hit.primID[i]);
      hits.record[lane] = found.record;
      hits.primitive[lane] = found.primitive;
      hits.t[lane] = far.lanes >> i & 1 ? float(far.distance(i, packet.ray.tfar[i]))
                                        : packet.ray.tfar[i] * unscale;
      hits.u[lane] = packet.hit.u[i];
      if (records[found.record].primitive == edit::Primitive::Lines)
        hits.u[lane] =
            placeOnLine(*level.scene, packet.hit.geomID[i], packet.hit.primID[i], packet.hit.u[i]);
      hits.v[lane] = packet.hit.v[i];
      hits.ng[0][lane] = packet.hit.Ng_x[i];
      hits.ng[1][lane] = packet.hit.Ng_y[i];
      hits.ng[2][lane] = packet.hit.Ng_z[i];
      refineGrazingHit(records[found.record], rays, ends[i], hits, lane);
    }
  }
  if (refused) rejectedRays += refused;
}

template <class Packet> void Accel::occludedPackets(const Level& level, const Rays& rays,
                                                    uint32_t mask, const QueryOptions& options,
                                                    bool first, uint8_t* blocked) const {
  constexpr uint32_t W = Packet::width;
  alignas(64) int valid[W];
  alignas(64) typename Packet::Ray packet;
  uint64_t refused = 0;
  for (uint32_t begin = 0; begin < rays.count; begin += W) {
    const uint32_t n = std::min(W, rays.count - begin);
    const PacketRays to = arraysOf(packet);
    FarRays far;
    uint32_t bad =
        loadPacket(rays, rays.tfar + begin, begin, W, scale_, level.limit, mask, valid, to);
    if (bad) bad = moveNear(rays, rays.tfar + begin, begin, W, valid, to, far);
    if (first)
      refused += bad;
    else
      for (uint32_t i = 0; i < n; i++) valid[i] = blocked[begin + i] ? 0 : valid[i];
    OcclusionQuery query(options);
    Packet::occluded(level.scene->scene, valid, packet, query);
    for (uint32_t i = 0; i < n; i++) {
      const bool met = valid[i] && packet.tfar[i] < 0; // Embree writes -infinity
      blocked[begin + i] = first ? met : blocked[begin + i] | met;
    }
  }
  if (refused) rejectedRays += refused;
}

void Accel::intersectLevel(const Level& level, const Rays& rays, uint32_t mask, bool coherent,
                           bool first, RayHits& hits) const {
  if (device_->hasNativePackets16 && !level.instances)
    intersectPackets<Packet16>(level, rays, mask, {coherent}, first, hits);
  else
    intersectPackets<Packet8>(level, rays, mask, {coherent && !level.instances}, first, hits);
}

void Accel::occludedLevel(const Level& level, const Rays& rays, uint32_t mask, bool coherent,
                          bool first, uint8_t* blocked) const {
  if (device_->hasNativePackets16 && !level.instances)
    occludedPackets<Packet16>(level, rays, mask, {coherent}, first, blocked);
  else
    occludedPackets<Packet8>(level, rays, mask, {coherent && !level.instances}, first, blocked);
}

void Accel::intersectInSinglePrecision(const Rays& rays, uint32_t mask, Coherence coherence,
                                       RayHits& hits) const {
  const bool coherent = coherence == Coherence::coherent, top = topLevel_.masks & mask;
  const bool first = staticLevel_.masks || !top;
  if (first) intersectLevel(staticLevel_, rays, mask, coherent, true, hits);
  if (top) intersectLevel(topLevel_, rays, mask, coherent, !first, hits);
}

void Accel::intersectFiltered(const Rays& rays, uint32_t mask, RTCFilterFunctionN filter,
                              const uint32_t* record, RayHits& hits) const {
  bool first = true;
  for (const Level* level : {&staticLevel_, &topLevel_}) {
    if (level == &topLevel_ && !(level->masks & mask)) continue;
    const FilterContext filtered{this, level, record};
    intersectPackets<Packet8>(*level, rays, mask, {false, filter, &filtered}, first, hits);
    first = false;
  }
}

void Accel::intersect(const Rays& rays, uint32_t mask, Coherence coherence, RayHits& hits) const {
  intersectInSinglePrecision(rays, mask, coherence, hits);
  if (coherence == Coherence::incoherent) return;
  findLostHits(
      rays, nullptr,
      [&](const Rays& again, RayHits& found) {
        intersectInSinglePrecision(again, mask, coherence, found);
      },
      hits);
}

void Accel::intersectFronts(const Rays& rays, uint32_t mask, RayHits& hits) const {
  const auto trace = [&](const Rays& some, RayHits& found) {
    intersectFiltered(some, mask, rejectBacks, nullptr, found);
  };
  trace(rays, hits);
  findLostHits(rays, nullptr, trace, hits);
}

void Accel::intersectOthers(const Rays& rays, const uint32_t* record, RayHits& hits) const {
  intersectFiltered(rays, maskAll, rejectRecord, record, hits);
}

void Accel::occluded(const Rays& rays, uint32_t mask, Coherence coherence, uint8_t* blocked) const {
  const bool coherent = coherence == Coherence::coherent, top = topLevel_.masks & mask;
  const bool first = staticLevel_.masks || !top;
  if (first) occludedLevel(staticLevel_, rays, mask, coherent, true, blocked);
  if (top) occludedLevel(topLevel_, rays, mask, coherent, !first, blocked);
  if (!coherent) return;
  findLostBlockers(
      rays,
      [&](const Rays& again, RayHits& found) {
        intersectInSinglePrecision(again, mask, coherence, found);
      },
      blocked);
}

void Accel::occludedByFronts(const Rays& rays, uint32_t mask, uint8_t* blocked) const {
  bool first = true;
  for (const Level* level : {&staticLevel_, &topLevel_}) {
    if (level == &topLevel_ && !(level->masks & mask)) continue;
    const FilterContext filtered{this, level};
    occludedPackets<Packet8>(*level, rays, mask, {false, rejectBacks, &filtered}, first, blocked);
    first = false;
  }
}

void Accel::bounds(float low[3], float high[3]) const {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  Vec3f lowest{infinite, infinite, infinite}, highest = -lowest;
  for (const Level* level : {&staticLevel_, &topLevel_}) {
    if (!level->masks) continue;
    RTCBounds b;
    rtcGetSceneBounds(level->scene->scene, &b);
    lowest = min(lowest, Vec3f{b.lower_x, b.lower_y, b.lower_z} / scale_);
    highest = max(highest, Vec3f{b.upper_x, b.upper_y, b.upper_z} / scale_);
  }
  store(lowest, low);
  store(highest, high);
}

} // namespace openrt
