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
 * finite hits nothing and is counted (RTstats.rejected.rays). [context-thread] */
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

/* Double precision ----------------------------------------------------------------------------- */

/* A ray in world coordinates. t is measured along direction as it is given, of any length up to
 * 1e18; origins lie within 1e18. */
typedef struct RTrayd {
  double origin[3];
  double tnear;
  double direction[3];
  double tfar;
} RTrayd;
/* No answer is farther from the truth than its error says: t, u and v, and each component of the
 * position. The truth is that of the ray as it is given and of these surfaces:
 *  - triangles: vertices are the floats that were given. Those of rtVertex3d and of RT_DOUBLE
 *    arrays are floats relative to the middle of their draw call. The matrices of all instances are
 *    multiplied in double; that product is taken as it is.
 *  - spheres: likewise.
 *  - quadrics and aspheres: crossings are found in double, and bounded by signs of the equation;
 *    the error is infinite where there are none. Which of them are within the interval, or within
 *    the limits of the surface, is decided in double.
 * Which triangles and spheres are crossed is decided exactly, with the ties of rtCountHits. If
 * surfaces are nearer together than the errors say, another of them may be the first. The normal
 * has no bound. */
typedef struct RThitd {
  double t;    /* infinite if nothing is hit */
  double u, v; /* barycentric coordinates; 0 for spheres, quadrics and aspheres */
  double position[3];
  double normal[3]; /* unit geometric normal, not turned towards the ray */
  double tError, uvError, positionError;
  uint64_t userData; /* this and the following as in RThit */
  RTid instance;
  uint32_t name;
  uint32_t primitive;
  uint32_t unused; /* 0 */
} RThitd;
/* These answer as rtCastRays, rtOccludedRays, rtCountHits and rtListHits, for rays in double
 * precision. Every ray is decided exactly; nearest hits take two to nine times as long, rays
 * exactly through vertices twice that, and rays in the planes of many faces fifty times. The first
 * query after a change makes boxes of the meshes that are new, which take about 100 bytes a
 * triangle. Queries in single precision neither make nor use them. [context-thread] */
RT_API void rtCastRaysd(size_t count, const RTrayd* rays, RThitd* hits);
RT_API void rtOccludedRaysd(size_t count, const RTrayd* rays, uint8_t* occluded);
RT_API void rtCountHitsd(size_t count, const RTrayd* rays, uint32_t* counts);
RT_API void rtListHitsd(size_t count, const RTrayd* rays, const size_t* first, RThitd* hits);

/* Nearest places ------------------------------------------------------------------------------- */

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
 * coordinates), up to a distance of radius (> 0; infinity is allowed), on triangles and spheres.
 * Points not finite have none. Quadrics and aspheres: RT_INVALID_OPERATION. [context-thread] */
RT_API void rtClosestPoints(size_t count, const float* points, float radius, RTclosest* closest);
/* The same in double precision, for points (3 doubles each) within 1e18 and the surfaces of
 * rtCastRaysd. t is the distance, and tError its error, which includes that another place may truly
 * be the nearest. uvError and positionError are those of the given place, as the nearest one of its
 * triangle or sphere. A sphere whose matrix scales its axes differently, by more than 1e-9:
 * RT_INVALID_OPERATION. [context-thread] */
RT_API void rtClosestPointsd(size_t count, const double* points, double radius, RThitd* closest);

#ifdef __cplusplus
}
#endif
#endif
