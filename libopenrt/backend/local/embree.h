// embree.h: the only place that knows which Embree this is. Packets of 16 rays; contexts and arguments of both major versions.
#pragma once

#if OPENRT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace openrt {

#if OPENRT_EMBREE_MAJOR >= 4
inline RTCIntersectArguments intersectArguments(bool coherent) {
  RTCIntersectArguments a;
  rtcInitIntersectArguments(&a);
  a.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return a;
}
inline RTCOccludedArguments occludedArguments(bool coherent) {
  RTCOccludedArguments a;
  rtcInitOccludedArguments(&a);
  a.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return a;
}
inline void intersect16(RTCScene scene, const int* valid, RTCRayHit16& rays, bool coherent) {
  auto a = intersectArguments(coherent);
  rtcIntersect16(valid, scene, &rays, &a);
}
inline void intersect8(RTCScene scene, const int* valid, RTCRayHit8& rays, bool coherent) {
  auto a = intersectArguments(coherent);
  rtcIntersect8(valid, scene, &rays, &a);
}
inline void occluded16(RTCScene scene, const int* valid, RTCRay16& rays, bool coherent) {
  auto a = occludedArguments(coherent);
  rtcOccluded16(valid, scene, &rays, &a);
}
inline void occluded8(RTCScene scene, const int* valid, RTCRay8& rays, bool coherent) {
  auto a = occludedArguments(coherent);
  rtcOccluded8(valid, scene, &rays, &a);
}
#else
inline RTCIntersectContext intersectContext(bool coherent) {
  RTCIntersectContext c;
  rtcInitIntersectContext(&c);
  c.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return c;
}
inline void intersect16(RTCScene scene, const int* valid, RTCRayHit16& rays, bool coherent) {
  auto c = intersectContext(coherent);
  rtcIntersect16(valid, scene, &c, &rays);
}
inline void intersect8(RTCScene scene, const int* valid, RTCRayHit8& rays, bool coherent) {
  auto c = intersectContext(coherent);
  rtcIntersect8(valid, scene, &c, &rays);
}
inline void occluded16(RTCScene scene, const int* valid, RTCRay16& rays, bool coherent) {
  auto c = intersectContext(coherent);
  rtcOccluded16(valid, scene, &c, &rays);
}
inline void occluded8(RTCScene scene, const int* valid, RTCRay8& rays, bool coherent) {
  auto c = intersectContext(coherent);
  rtcOccluded8(valid, scene, &c, &rays);
}
#endif

} // namespace openrt
