// embree.h: hides the differences between Embree 3 and 4: contexts, arguments and calls for one ray
// and for packets of 8 and 16 rays. No other file depends on the major version.
#pragma once

// The library's build defines the major version. Other includers (tests) find the same one, because
// this order is that of cmake/Dependencies.cmake.
#ifndef OPENRT_EMBREE_MAJOR
#if __has_include(<embree3/rtcore.h>)
#define OPENRT_EMBREE_MAJOR 3
#else
#define OPENRT_EMBREE_MAJOR 4
#endif
#endif

#if OPENRT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace openrt {

// Options of an intersection or occlusion query. `filter` is called for every candidate hit, with
// `user` in its context.
struct QueryOptions {
  bool coherent = false;
  RTCFilterFunctionN filter = nullptr;
  const void* user = nullptr;
};

#if OPENRT_EMBREE_MAJOR >= 4
inline const RTCSceneFlags sceneFlags =
    RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS);
struct QueryContext : RTCRayQueryContext {
  const void* user;
  RTCFilterFunctionN queryFilter; // the query's filter, for geometries of our own
};
struct Query {
  QueryContext context;
  RTCIntersectArguments arguments;
  explicit Query(const QueryOptions& options) {
    rtcInitRayQueryContext(&context);
    context.user = options.user;
    context.queryFilter = options.filter;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    arguments.filter = options.filter;
    arguments.flags = RTCRayQueryFlags(
        (options.coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) |
        (options.filter ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : 0));
  }
};
struct OcclusionQuery {
  QueryContext context;
  RTCOccludedArguments arguments;
  explicit OcclusionQuery(const QueryOptions& options) {
    rtcInitRayQueryContext(&context);
    context.user = options.user;
    context.queryFilter = options.filter;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    arguments.filter = options.filter;
    arguments.flags = RTCRayQueryFlags(
        (options.coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) |
        (options.filter ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : 0));
  }
};
inline void intersect1(RTCScene scene, RTCRayHit& ray, Query& query) {
  rtcIntersect1(scene, &ray, &query.arguments);
}
inline void intersect16(RTCScene scene, const int* valid, RTCRayHit16& rays, Query& query) {
  rtcIntersect16(valid, scene, &rays, &query.arguments);
}
inline void intersect8(RTCScene scene, const int* valid, RTCRayHit8& rays, Query& query) {
  rtcIntersect8(valid, scene, &rays, &query.arguments);
}
inline void occluded16(RTCScene scene, const int* valid, RTCRay16& rays, OcclusionQuery& query) {
  rtcOccluded16(valid, scene, &rays, &query.arguments);
}
inline void occluded8(RTCScene scene, const int* valid, RTCRay8& rays, OcclusionQuery& query) {
  rtcOccluded8(valid, scene, &rays, &query.arguments);
}
#else
inline const RTCSceneFlags sceneFlags =
    RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
struct QueryContext : RTCIntersectContext {
  const void* user;
  RTCFilterFunctionN queryFilter; // the query's filter, for geometries of our own
};
struct Query {
  QueryContext context;
  explicit Query(const QueryOptions& options) {
    rtcInitIntersectContext(&context);
    context.user = options.user;
    context.queryFilter = options.filter;
    context.filter = options.filter;
    context.flags = options.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                     : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
};
inline void intersect1(RTCScene scene, RTCRayHit& ray, Query& query) {
  rtcIntersect1(scene, &query.context, &ray);
}
inline void intersect16(RTCScene scene, const int* valid, RTCRayHit16& rays, Query& query) {
  rtcIntersect16(valid, scene, &query.context, &rays);
}
inline void intersect8(RTCScene scene, const int* valid, RTCRayHit8& rays, Query& query) {
  rtcIntersect8(valid, scene, &query.context, &rays);
}
using OcclusionQuery = Query;
inline void occluded16(RTCScene scene, const int* valid, RTCRay16& rays, OcclusionQuery& query) {
  rtcOccluded16(valid, scene, &query.context, &rays);
}
inline void occluded8(RTCScene scene, const int* valid, RTCRay8& rays, OcclusionQuery& query) {
  rtcOccluded8(valid, scene, &query.context, &rays);
}
#endif

} // namespace openrt
