// accel_passed.cpp: every surface along a ray, for queries. A filter that takes no hit sees them
// all; what is seen twice (in a tree that splits triangles) is dropped. Called by the threads of a
// query.
#include <algorithm>
#include <tuple>

#include "backend/local/accel/accel.h"
#include "backend/local/exact.h"

namespace openrt {

void Accel::collect(const RTCFilterFunctionNArguments* a) {
  const Filtered& self =
      *static_cast<const Filtered*>(static_cast<const QueryContext*>(a->context)->user);
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
                         {RTCHitN_Ng_x(a->hit, a->N, i), RTCHitN_Ng_y(a->hit, a->N, i),
                          RTCHitN_Ng_z(a->hit, a->N, i)}});
  }
}

// As of hits that shading sees: a triangle that the ray grazes is met again in double precision.
void Accel::settlePassed(const Rays& rays, Passed& p) const {
  const Record& r = records[p.record];
  const float d[3] = {rays.dir[0][p.ray], rays.dir[1][p.ray], rays.dir[2][p.ray]};
  float n[3] = {p.ng[0], p.ng[1], p.ng[2]};
  if (r.instanced) normalToRender(r, p.ng, n);
  if (r.primitive == edit::Primitive::Triangles && grazes(n, d))
    settle(r, p.primitive, {rays.org[0][p.ray], rays.org[1][p.ray], rays.org[2][p.ray]},
           {d[0], d[1], d[2]}, rays.tnear[p.ray], rays.tfar[p.ray], p.t, p.u, p.v);
}

void Accel::passed(const Rays& rays, std::vector<Passed>& out) const {
  out.clear();
  Arena arena;
  RayHits none; // what the filter leaves over: nothing
  none.allocate(arena, rays.count);
  intersectFiltered(rays, maskAll, collect, nullptr, none, &out);
  for (Passed& p : out) settlePassed(rays, p);
  const auto key = [](const Passed& p) { return std::tuple(p.ray, p.t, p.record, p.primitive); };
  std::sort(out.begin(), out.end(),
            [&](const Passed& a, const Passed& b) { return key(a) < key(b); });
  out.erase(std::unique(out.begin(), out.end(),
                        [&](const Passed& a, const Passed& b) { return key(a) == key(b); }),
            out.end());
}

} // namespace openrt
