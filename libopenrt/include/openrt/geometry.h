/* geometry.h: primitives, arrays, matrices, objects and instances (OpenRT, C99). openrt.h states
 * the conventions.
 */
#ifndef OPENRT_GEOMETRY_H
#define OPENRT_GEOMETRY_H

#include "openrt/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Primitives: inside rtBeginObject ... rtEndObject --------------------------------------------- */

/* The modes have OpenGL's numbers. An RT_POLYGON is convex. */
enum {
  RT_POINTS = 0x0000,
  RT_LINES = 0x0001,
  RT_LINE_STRIP = 0x0003,
  RT_TRIANGLES = 0x0004,
  RT_TRIANGLE_STRIP = 0x0005,
  RT_TRIANGLE_FAN = 0x0006,
  RT_QUADS = 0x0007,
  RT_QUAD_STRIP = 0x0008,
  RT_POLYGON = 0x0009
};

/* rtBegin opens a list of vertices of one mode, rtEnd closes it. rtBegin latches the bound shader,
 * the name and the current matrix. Each vertex latches normal, texture coordinate, colour and
 * fog coordinate. An object begins without any of them: its vertices have those that were set since
 * rtBeginObject. A normal of 0 0 0 stands for the normal of the face. Positions given in
 * double keep their precision wherever they lie (up to 1e38). Degenerate primitives are dropped and
 * counted (RTstats.rejected.primitives). [context-thread] */
RT_API void rtBegin(RTenum mode);
RT_API void rtEnd(void);
RT_API void rtVertex2f(float x, float y);
RT_API void rtVertex3f(float x, float y, float z);
RT_API void rtVertex3fv(const float* v);
RT_API void rtVertex3d(double x, double y, double z);
RT_API void rtVertex3dv(const double* v);
RT_API void rtNormal3f(float x, float y, float z);
RT_API void rtNormal3fv(const float* v);
RT_API void rtTexCoord2f(float s, float t);
RT_API void rtTexCoord2fv(const float* v);
RT_API void rtColor3f(float r, float g, float b);
RT_API void rtColor3fv(const float* v);
RT_API void rtColor4f(float r, float g, float b, float a);
RT_API void rtColor4fv(const float* v);

/* Sets the fog coordinate: the share of the fog in front of a place, in place of the share that
 * follows from the distance. 0: none; 1: as much as at the end of an endless way. Between vertices
 * it is interpolated and then held in 0..1. It has no effect where there is no fog (rtInstanceFog,
 * rtUseEnvironment), nor on spheres and other surfaces that are equations. [context-thread] */
RT_API void rtFogCoordf(float share);

/* Set the width of lines and the diameter of points, in pixels as seen by the camera (default 1,
 * range > 0). rtBegin latches them. [context-thread] */
RT_API void rtLineWidth(float pixels);
RT_API void rtPointSize(float pixels);
/* Sets the dashes of lines: 16 cells of `factor` pixels each (1 to 256) along the line as the
 * camera sees it, of which those are drawn whose bit is 1, beginning with bit 0. The pattern goes
 * on from a line to the next one in the list if they share a vertex, and begins anew elsewhere.
 * Default 1, 0xffff: solid. Beyond 32,768 pixels from the middle of the picture lines are solid.
 * rtBegin latches it. [context-thread] */
RT_API void rtLineStipple(int factor, uint16_t pattern);

/* Texture coordinates in the camera's frame, in place of those of vertices: x is right, y up, the
 * viewer at the origin. The camera is that of the frame, also in mirrors and through glass. */
enum {
  RT_TEX_GEN_OFF = 0,          /* the coordinates of the vertices (default) */
  RT_TEX_GEN_POSITION,         /* x and y of the place */
  RT_TEX_GEN_NORMAL,           /* x and y of the unit normal on the viewer's side */
  RT_TEX_GEN_REFLECTION,       /* x and y of the direction from the viewer, reflected; unit */
  RT_TEX_GEN_SPHERE_NORMAL,    /* (x / 2 + 1/2, y / 2 + 1/2) of the normal */
  RT_TEX_GEN_SPHERE_REFLECTION /* the same of the reflected direction */
};
/* Sets how texture coordinates are made. rtBegin and the other calls that draw latch it; lines and
 * points have none. [context-thread] */
RT_API void rtTexGen(RTenum mode);

/* RT_CULL_FACE: back faces do not exist, for rays of any kind but shadow rays (default off).
 * RT_CW_FRONT: vertices that are clockwise for the viewer make a front face (default off:
 * counter-clockwise ones do). */
enum { RT_CULL_FACE = 0x0B44, RT_CW_FRONT = 0x0B46 };
/* Turn a capability on or off. rtBegin, arrays and analytic shapes latch it. [context-thread] */
RT_API void rtEnable(RTenum capability);
RT_API void rtDisable(RTenum capability);

/* Sets the name of the primitives that follow, which the name channel and ray queries report (as
 * OpenGL's selection names). Default 0. Instances latch it, too: a primitive whose own name is 0
 * has the name of the innermost instance that has one. [context-thread] */
RT_API void rtLoadName(uint32_t name);

/* Adds an exact sphere of the given radius (> 0) about the current origin. Its texture coordinates
 * run as on VRML's Sphere (ISO/IEC 14772-1 6.43): s from the back (-z) counter-clockwise seen from
 * above, t from the bottom to the top. [context-thread] */
RT_API void rtSphere(float radius);

/* Surfaces that are equations, without facets. Rays meet them where double precision does, their
 * normals are exact, and their edges leave no gap to another surface with the same edge in the same
 * object. Every shader works on them. A number that is not finite or out of its range is
 * RT_INVALID_VALUE, and nothing is added. Lengths are in units of the current matrix; nothing is
 * kept of the arrays. Like spheres they latch shader, name, matrix and capabilities; RT_CW_FRONT
 * exchanges front and back. Quadrics that emit, but are not of revolution about an axis of their
 * frame, are found by chance alone. rtClosestPoints refuses scenes that have any of these. */

/* Adds the part of a quadric that lies in a box: the points between `low` and `high`, within 1e12
 * of the origin, where
 *   c[0] x^2 + c[1] y^2 + c[2] z^2 + c[3] x y + c[4] y z + c[5] z x + c[6] x + c[7] y + c[8] z +
 * c[9] is 0. The front is the side on which it is positive. Texture coordinates run as on VRML's
 * Cylinder: s around the y axis from the back (-z), t from the lower to the upper side of the box.
 * [context-thread] */
RT_API void rtQuadric(const double coefficients[10], const double low[3], const double high[3]);
/* Add the side of a cylinder or of a truncated cone about the y axis, from y = low to y = high,
 * without its ends. Radii: from 0, not both 0. The front is outside. They are quadrics.
 * [context-thread] */
RT_API void rtCylinder(double radius, double low, double high);
RT_API void rtCone(double lowRadius, double highRadius, double low, double high);
/* Adds a surface of revolution about the z axis, as lenses and reflectors have it (ISO 10110-12):
 *   z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + terms[0] r^4 + terms[1] r^6 + ...
 * for innerRadius <= r <= semiAperture (1e-12 to 1e12), where r is the distance from the axis.
 *  - curvature: c, 1 / the radius at the vertex; > 0 bends towards +z, 0 is a plane.
 *  - conic: k. 0: sphere; -1: paraboloid; < -1: hyperboloid; otherwise an ellipsoid.
 *  - terms: termCount numbers (0 to 8); NULL if there are none.
 * The semi-aperture must not be beyond the edge, where the root is 0; with terms it must be inside.
 * The front faces +z. Texture coordinates are those of a square about the aperture: s along x, t
 * along y. [context-thread] */
RT_API void rtAsphere(double curvature, double conic, size_t termCount, const double* terms,
                      double innerRadius, double semiAperture);

/* Arrays: the bulk path ------------------------------------------------------------------------ */

enum { RT_FLOAT = 0x1406, RT_DOUBLE = 0x140A, RT_UNSIGNED_BYTE = 0x1401, RT_UNSIGNED_INT = 0x1405 };

/* Set the source of an attribute for rtDrawArrays and rtDrawElements. [context-thread]
 *  - size: components of an element (vertex 3, normal 3, texture 2, colour 3 or 4, fog 1).
 *  - type: RT_FLOAT; for vertices also RT_DOUBLE.
 *  - stride: bytes from one element to the next; 0 means tightly packed.
 *  - pointer: NULL turns the array off. The draw calls read it, so it must stay valid until the
 * last of them has returned. */
RT_API void rtVertexPointer(int size, RTenum type, size_t stride, const void* pointer);
RT_API void rtNormalPointer(RTenum type, size_t stride, const void* pointer);
RT_API void rtTexCoordPointer(int size, RTenum type, size_t stride, const void* pointer);
RT_API void rtColorPointer(int size, RTenum type, size_t stride, const void* pointer);
RT_API void rtFogCoordPointer(RTenum type, size_t stride, const void* pointer);
/* Draws count vertices, beginning with element first. [context-thread] */
RT_API void rtDrawArrays(RTenum mode, size_t first, size_t count);
/* Draws the vertices that count 32-bit indices name. vertexCount is the number of elements in the
 * arrays; an index beyond it is RT_INVALID_VALUE. [context-thread] */
RT_API void rtDrawElements(RTenum mode, size_t count, const uint32_t* indices, size_t vertexCount);

/* Matrices: composed in double ----------------------------------------------------------------- */

/* The matrix stack holds 4096 matrices. An object's definition has a stack of its own. Matrices are
 * affine: their bottom row is 0 0 0 1. rtRotate* turns by an angle in degrees about an axis, which
 * need not have unit length. rtGetMatrixd writes the current matrix. [context-thread] */
RT_API void rtPushMatrix(void);
RT_API void rtPopMatrix(void);
RT_API void rtLoadIdentity(void);
RT_API void rtLoadMatrixf(const float m[16]);
RT_API void rtLoadMatrixd(const double m[16]);
RT_API void rtMultMatrixf(const float m[16]);
RT_API void rtMultMatrixd(const double m[16]);
RT_API void rtTranslatef(float x, float y, float z);
RT_API void rtTranslated(double x, double y, double z);
RT_API void rtRotatef(float degrees, float x, float y, float z);
RT_API void rtRotated(double degrees, double x, double y, double z);
RT_API void rtScalef(float x, float y, float z);
RT_API void rtScaled(double x, double y, double z);
RT_API void rtGetMatrixd(double m[16]);

/* Objects and instances ------------------------------------------------------------------------ */

/* Makes count empty objects and writes their ids. [context-thread] */
RT_API void rtGenObjects(size_t count, RTid* ids);
/* Opens the definition of an object and returns its id; an id of 0 makes a new object. The matrix
 * stack starts at the identity. A new definition replaces the old one in every instance.
 * Definitions do not nest; objects instantiate each other. [context-thread] */
RT_API RTid rtBeginObject(RTid id);
RT_API void rtEndObject(void);
/* Deletes an object and all of its instances. [context-thread] */
RT_API void rtDeleteObject(RTid object);

/* Places an object under the current matrix, in the scene or in the object that is being defined.
 * Returns the instance's id. An object that would contain itself is RT_INVALID_OPERATION. A
 * singular matrix is allowed and draws nothing. [context-thread] */
RT_API RTid rtInstantiateObject(RTid object);
/* Delete an instance, move it, and show or hide it. [context-thread] */
RT_API void rtDeleteInstance(RTid instance);
RT_API void rtInstanceMatrix(RTid instance, const double m[16]);
RT_API void rtInstanceVisible(RTid instance, int visible);
/* Overrides the shaders of everything below this instance; 0 removes the override.
 * [context-thread] */
RT_API void rtInstanceShader(RTid instance, RTid shader);
/* Sets the fog in front of everything below this instance: a shader of an environment class, of
 * which only the fog counts (`attenuate`), in the axes of the world. It replaces the fog of
 * rtUseEnvironment; the fog of the innermost instance counts. A class without fog is clear air.
 * 0: the fog around the instance. [context-thread] */
RT_API void rtInstanceFog(RTid instance, RTid shader);

/* Hints tell how often an instance's matrix and visibility, or an object's definition, will change.
 * Pictures differ between the two hints in the last bits alone.
 *  - RT_STATIC (default): it stays as it is. A change may cost as much as building the scene.
 *  - RT_DYNAMIC: it changes often. A change costs that instance or object and the top level of the
 *    acceleration structure; rays cost a little more.
 * The first rtInstanceMatrix, rtInstanceVisible or new definition of something that has been
 * rendered makes it dynamic without a hint. */
enum { RT_STATIC = 0x88E4, RT_DYNAMIC = 0x88E8 };
/* Sets the hint of an instance. [context-thread] */
RT_API void rtInstanceHint(RTid instance, RTenum hint);
/* Sets the hint of an object, which holds from its next definition on. [context-thread] */
RT_API void rtObjectHint(RTid object, RTenum hint);
/* Sets a number that ray queries report for hits below this instance. The innermost instance that
 * has one counts. Default 0. [context-thread] */
RT_API void rtInstanceUserData(RTid instance, uint64_t data);

#ifdef __cplusplus
}
#endif
#endif
