// user_geometry.h: helpers for Embree user geometries: reads the rays of a packet and stores hits.
// Called by render threads.
#pragma once

#include <limits>

#include "backend/local/accel/embree.h"
#include "scene/matrix.h"

namespace openrt {

// One ray of an Embree packet.
struct Lane {
  Vec3d origin, direction;
  float near, far;
  Lane(RTCRayN* ray, unsigned n, unsigned i)
      : origin{RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i)},
        direction{RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i)},
        near(RTCRayN_tnear(ray, n, i)), far(RTCRayN_tfar(ray, n, i)) {}
  bool reaches(double t) const { return float(t) >= near && float(t) <= far; }
};

// Writes a box to Embree's bounds.
inline void storeBounds(const Vec3f& low, const Vec3f& high, RTCBounds& out) {
  out.lower_x = low.x;
  out.lower_y = low.y;
  out.lower_z = low.z;
  out.upper_x = high.x;
  out.upper_y = high.y;
  out.upper_z = high.z;
}

// Returns whether the filter of the query, if any, accepts a hit of lane i at distance t. The
// filter gets the hit as a packet of one ray. Arguments: those of an intersection or of an
// occlusion callback.
template <class Arguments>
bool passesFilter(const Arguments* a, RTCRayN* rays, unsigned i, double t, const RTCHit& hit) {
  const auto* context = static_cast<const QueryContext*>(a->context);
  if (!context->queryFilter) return true;
  RTCRay ray{};
  ray.org_x = RTCRayN_org_x(rays, a->N, i);
  ray.org_y = RTCRayN_org_y(rays, a->N, i);
  ray.org_z = RTCRayN_org_z(rays, a->N, i);
  ray.dir_x = RTCRayN_dir_x(rays, a->N, i);
  ray.dir_y = RTCRayN_dir_y(rays, a->N, i);
  ray.dir_z = RTCRayN_dir_z(rays, a->N, i);
  ray.tnear = RTCRayN_tnear(rays, a->N, i);
  ray.tfar = float(t);
  ray.mask = RTCRayN_mask(rays, a->N, i);
  ray.id = RTCRayN_id(rays, a->N, i);
  RTCHit seen = hit;
  int valid = -1;
  const RTCFilterFunctionNArguments one{&valid,
                                        a->geometryUserPtr,
                                        a->context,
                                        reinterpret_cast<RTCRayN*>(&ray),
                                        reinterpret_cast<RTCHitN*>(&seen),
                                        1};
  context->queryFilter(&one);
  return valid == -1;
}

template <class Arguments>
RTCHit hitOf(const Arguments* a, double u, double v, const Vec3d& normal) {
  RTCHit hit{};
  hit.Ng_x = float(normal.x);
  hit.Ng_y = float(normal.y);
  hit.Ng_z = float(normal.z);
  hit.u = float(u);
  hit.v = float(v);
  hit.primID = a->primID;
  hit.geomID = a->geomID;
  hit.instID[0] = a->context->instID[0];
  return hit;
}

// Marks lane i as occluded by a hit, unless the filter of the query rejects it. Returns whether the
// lane was marked.
inline bool storeOcclusion(const RTCOccludedFunctionNArguments* a, unsigned i, double t,
                           const Vec3d& normal) {
  if (!passesFilter(a, a->ray, i, t, hitOf(a, 0, 0, normal))) return false;
  RTCRayN_tfar(a->ray, a->N, i) = -std::numeric_limits<float>::infinity();
  return true;
}

// Stores a hit of lane i, unless the filter of the query rejects it. Returns whether the hit was
// stored.
inline bool storeHit(const RTCIntersectFunctionNArguments* a, unsigned i, double t, double u,
                     double v, const Vec3d& normal) {
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  const RTCHit hit = hitOf(a, u, v, normal);
  if (!passesFilter(a, rays, i, t, hit)) return false;
  RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
  RTCRayN_tfar(rays, a->N, i) = float(t);
  RTCHitN_Ng_x(hits, a->N, i) = hit.Ng_x;
  RTCHitN_Ng_y(hits, a->N, i) = hit.Ng_y;
  RTCHitN_Ng_z(hits, a->N, i) = hit.Ng_z;
  RTCHitN_u(hits, a->N, i) = hit.u;
  RTCHitN_v(hits, a->N, i) = hit.v;
  RTCHitN_primID(hits, a->N, i) = hit.primID;
  RTCHitN_geomID(hits, a->N, i) = hit.geomID;
  RTCHitN_instID(hits, a->N, i, 0) = hit.instID[0];
  return true;
}

// Returns a geometry of `count` primitives. Its functions get `data`, which must outlive it.
inline RTCGeometry newUserGeometry(const EmbreeDevice& device, void* data, size_t count,
                                   RTCBoundsFunction bounds, RTCIntersectFunctionN intersect,
                                   RTCOccludedFunctionN occluded) {
  RTCGeometry geometry = rtcNewGeometry(device.device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(count));
  rtcSetGeometryUserData(geometry, data);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  return geometry;
}

} // namespace openrt
