// accel_passed.cpp: every surface along a ray, for queries. A filter that takes no hit sees them all; what is seen twice (in a
// tree that splits triangles) is dropped. Called by the threads of a query.
#include <algorithm>
#include <tuple>

#include "backend/local/accel.h"

namespace openrt {

void Accel::collect(const RTCFilterFunctionNArguments* a) {
  const Filtered& self = *static_cast<const Filtered*>(static_cast<const QueryContext*>(a->context)->user);
  for (unsigned i = 0; i < a->N; i++) {
    if (a->valid[i] != -1) continue;
    a->valid[i] = 0;
    const Found found = foundBy(a, i);
    const edit::Primitive kind = self.accel->records[found.record].primitive;
    if (kind != edit::Primitive::Triangles && kind != edit::Primitive::Sphere) continue;
    self.all->push_back({RTCRayN_id(a->ray, a->N, i),
                         found.record,
                         found.primitive,
                         RTCRayN_tfar(a->ray, a->N, i) / self.accel->scale_,
                         RTCHitN_u(a->hit, a->N, i),
                         RTCHitN_v(a->hit, a->N, i),
                         {RTCHitN_Ng_x(a->hit, a->N, i), RTCHitN_Ng_y(a->hit, a->N, i), RTCHitN_Ng_z(a->hit, a->N, i)}});
  }
}

void Accel::passed(const Rays& rays, std::vector<Passed>& out) const {
  out.clear();
  Arena arena;
  RayHits none; // what the filter leaves over: nothing
  none.allocate(arena, rays.count);
  intersectFiltered(rays, maskAll, collect, nullptr, none, &out);
  const auto key = [](const Passed& p) { return std::tuple(p.ray, p.t, p.record, p.primitive); };
  std::sort(out.begin(), out.end(), [&](const Passed& a, const Passed& b) { return key(a) < key(b); });
  out.erase(std::unique(out.begin(), out.end(), [&](const Passed& a, const Passed& b) { return key(a) == key(b); }), out.end());
}

} // namespace openrt
