/* queries.h: queries of the OpenRT API beyond nearest hits (C99): every surface along a ray, and
 * the surface point nearest to a place. What openrt.h says of arrays, errors and threads holds
 * here; like rtCastRays they see the last committed scene. Backends that do not render find
 * nothing.
 */
#ifndef OPENRT_QUERIES_H
#define OPENRT_QUERIES_H

#include "openrt/openrt.h"

#ifdef __cplusplus
extern "C" {
#endif

/* counts[i]: how many surfaces ray i passes between tnear and tfar. Lines and points are none; a
 * ray through the edge of two triangles may pass both. */
RT_API void rtCountHits(size_t count, const RTray* rays, uint32_t* counts);
/* The surfaces that the rays pass, nearest first: those of ray i from hits[first[i]] on, the
 * first[i + 1] - first[i] nearest of them; places that are left over get t = infinity. first: count
 * + 1 numbers that do not fall (else RT_INVALID_VALUE); hits has room for first[count]. */
RT_API void rtListHits(size_t count, const RTray* rays, const size_t* first, RThit* hits);

typedef struct RTclosest {
  float distance;  /* in world units; infinity: nothing within the radius */
  float point[3];  /* on the surface */
  float u, v;      /* barycentrics there */
  float normal[3]; /* unit geometric normal there, as RThit's */
  RTid instance;   /* the rest as in RThit */
  uint32_t name;
  uint32_t primitive;
  uint64_t userData;
} RTclosest;
/* The surface point that is nearest to each of count points (3 floats each, world coordinates), not
 * farther than radius (> 0, infinity is allowed). Triangles and spheres count, lines and points do
 * not. A point that is not finite has none. */
RT_API void rtClosestPoints(size_t count, const float* points, float radius, RTclosest* closest);

#ifdef __cplusplus
}
#endif
#endif
