// raw_embree.h: traces one ray at a time with Embree 3 or 4 and default settings. The benchmarks
// compare the project with this.
#pragma once

#if __has_include(<embree3/rtcore.h>) // the order of cmake/Dependencies.cmake
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace raw {

#if RTC_VERSION_MAJOR >= 4
inline void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
inline void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }
#else
inline void intersect(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
inline void occluded(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
#endif

} // namespace raw
