/* query.h: ray queries and picking (OpenRT, C99). openrt.h states the conventions. Queries see the
 * last committed scene. Backends that do not render find nothing.
 */
#ifndef OPENRT_QUERY_H
#define OPENRT_QUERY_H

#include "openrt/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Queries on the last committed scene ---------------------------------------------------------- */

/* A ray in world coordinates. t is measured along direction as it is given, of any length. */
typedef struct RTray {
  float origin[3];
  float tnear;
  float direction[3];
  float tfar;
} RTray;
typedef struct RThit {
  float t;         /* along the ray's direction as given; infinite if nothing is hit */
  float u, v;      /* barycentric coordinates; 0 for spheres, quadrics and aspheres */
  float normal[3]; /* unit geometric normal, not turned towards the ray */
  RTid instance;   /* the outermost instance; 0 if nothing is hit */
  uint32_t name;   /* see rtLoadName */
  /* The triangle, segment or point, counted within its draw call, or within the run of rtBegin ...
   * rtEnd lists of one state that it belongs to. Degenerate primitives do not count. */
  uint32_t primitive;
  uint64_t userData; /* see rtInstanceUserData */
} RThit;
/* Finds what the camera sees at x, y (pixels from the top left corner of the frame buffer) through
 * the middle of its lens. Fills hit as rtCastRays does, with t in world units from the origin of
 * the camera ray. Returns 1, or 0 if nothing is hit. Needs a frame buffer and a camera (else
 * RT_INVALID_OPERATION). [context-thread] */
RT_API int rtPick(double x, double y, RThit* hit);
/* Finds the nearest hits of count rays. Rays are traced in single precision, and decided again as
 * rtCountHits does if that may be wrong: if a ray from within the bounds of the scene hits nothing,
 * or if it hits near an edge, at a grazing angle or near its ends. One error is not noticed: a ray
 * exactly through a vertex may pass that surface and hit the middle of a triangle behind it or,
 * from outside of the bounds, nothing. rtListHits has the right first hit there. A ray that is not
 * finite hits nothing and is counted (RTstats.rejectedRays). [context-thread] */
RT_API void rtCastRays(size_t count, const RTray* rays, RThit* hits);
/* Writes occluded[i] = 1 if anything lies between tnear and tfar of ray i, else 0. Decides as
 * rtCastRays does. [context-thread] */
RT_API void rtOccludedRays(size_t count, const RTray* rays, uint8_t* occluded);

/* Counts the surfaces that each ray crosses behind tnear, up to and including tfar. Lines and
 * points do not count. Every crossing counts once: a ray exactly through an edge or a vertex
 * crosses what it crosses with its origin moved by (e, e^2, e^3), e smaller than any number. So the
 * number is odd exactly if the ray's ends lie on different sides of a closed mesh. Spheres,
 * quadrics and aspheres are intersected in double precision: a ray that only touches one does not
 * cross it, and one within 1e-10 of the rim of a quadric or an asphere may cross the next surface,
 * too. [context-thread] */
RT_API void rtCountHits(size_t count, const RTray* rays, uint32_t* counts);
/* Lists the surfaces that the rays pass, nearest first. first holds count + 1 numbers that never
 * fall (else RT_INVALID_VALUE); hits has room for first[count] hits. The hits of ray i begin at
 * hits[first[i]]; there are at most first[i + 1] - first[i] of them, the nearest ones. Unused
 * places get an infinite t. [context-thread] */
RT_API void rtListHits(size_t count, const RTray* rays, const size_t* first, RThit* hits);

typedef struct RTclosest {
  float distance;  /* in world units; infinite if nothing lies within the radius */
  float point[3];  /* the nearest place on the surface */
  float u, v;      /* barycentric coordinates there */
  float normal[3]; /* unit geometric normal there, as in RThit */
  RTid instance;   /* this and the following as in RThit */
  uint32_t name;
  uint32_t primitive;
  uint64_t userData;
} RTclosest;
/* Finds the place on a surface that is nearest to each of count points (3 floats each, in world
 * coordinates), up to a distance of radius (> 0; infinity is allowed). Triangles and spheres count,
 * lines and points do not. A point that is not finite has no nearest place. [context-thread] */
RT_API void rtClosestPoints(size_t count, const float* points, float radius, RTclosest* closest);

#ifdef __cplusplus
}
#endif
#endif
