// accel_all_hits.cpp: finds all hits along a ray, for queries. A filter that rejects every hit sees
// them all. Hits that are reported twice, because the BVH splits triangles, are dropped. Called by
// the threads of a query.
#include <algorithm>
#include <tuple>

#include "backend/local/accel/accel.h"
#include "backend/local/exact.h"

namespace openrt {

void Accel::collectHit(const RTCFilterFunctionNArguments* a) {
  const FilterContext& self =
      *static_cast<const FilterContext*>(static_cast<const QueryContext*>(a->context)->user);
  for (unsigned i = 0; i < a->N; i++) {
    if (a->valid[i] != -1) continue;
    a->valid[i] = 0;
    const PrimitiveId found = primitiveOfHit(a, i);
    const edit::Primitive kind = self.accel->records[found.record].primitive;
    if (kind == edit::Primitive::Lines || kind == edit::Primitive::Points) continue;
    self.all->push_back({RTCRayN_id(a->ray, a->N, i),
                         found.record,
                         found.primitive,
                         RTCRayN_tfar(a->ray, a->N, i) / self.accel->scale_,
                         RTCHitN_u(a->hit, a->N, i),
                         RTCHitN_v(a->hit, a->N, i),
                         {RTCHitN_Ng_x(a->hit, a->N, i), RTCHitN_Ng_y(a->hit, a->N, i),
                          RTCHitN_Ng_z(a->hit, a->N, i)}});
  }
}

// Recomputes hits at grazing angles in double precision, as is done for hits that are shaded.
void Accel::refineMultiHit(const Rays& rays, MultiHit& p) const {
  const Record& r = records[p.record];
  const Vec3f d = load(rays.dir, p.ray), n = r.instanced ? r.kernelNormal * p.ng : p.ng;
  if (r.primitive != edit::Primitive::Triangles || !grazes(n, d)) return;
  const RaySegment ray{Vec3d(load(rays.org, p.ray)), Vec3d(d), rays.tnear[p.ray], rays.tfar[p.ray]};
  if (const auto hit = refineHit(r, p.primitive, ray)) {
    p.t = float(hit->t);
    p.u = float(hit->u);
    p.v = float(hit->v);
  }
}

void Accel::allHits(const Rays& rays, std::vector<MultiHit>& out) const {
  out.clear();
  Arena arena;
  RayHits none; // stays empty, because the filter rejects every hit
  none.allocate(arena, rays.count);
  intersectFiltered(rays, maskAll, collectHit, nullptr, none, &out);
  for (MultiHit& p : out) refineMultiHit(rays, p);
  const auto key = [](const MultiHit& p) { return std::tuple(p.ray, p.t, p.record, p.primitive); };
  std::sort(out.begin(), out.end(),
            [&](const MultiHit& a, const MultiHit& b) { return key(a) < key(b); });
  out.erase(std::unique(out.begin(), out.end(),
                        [&](const MultiHit& a, const MultiHit& b) { return key(a) == key(b); }),
            out.end());
}

} // namespace openrt
