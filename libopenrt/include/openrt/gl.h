/* gl.h: OpenGL 1.1 and its utilities on top of openrt/openrt.h (library librtgl, C99).
 *
 * A program for OpenGL's fixed functions is compiled with this header instead of OpenGL's and
 * GLU's, as it is or with rt and RT_ in place of gl and GL_. docs/from-opengl.md tells about
 * each name.
 *
 * How it works
 *  - Calls are recorded until the frame ends (rtglEndFrame, or openrt/rtut.h). Primitives become
 *    objects, their matrices become matrices of instances, and what is current of lights,
 *    materials and textures becomes shaders.
 *  - World space is the space of the eye: the matrix of an instance is the modelview matrix.
 *  - A frame that has the same geometry again, from display lists or with equal bytes, builds
 *    nothing: instances are moved, and parameters of shaders are set.
 *  - Names that OpenGL and openrt/openrt.h share, but with other parameters, are OpenGL's after
 *    this header, as are the values RT_RGBA, RT_DEPTH, RT_POSITION and RT_CLAMP. Where
 *    OPENRT_GL_NO_RT_NAMES is defined, only names with gl and GL_ are OpenGL's, and those with rt
 *    and RT_ stay as they are.
 *
 * The functions use the context that is current on the thread. Without one, the first call makes
 * one by rtInit. State, lists and textures are those of the thread and this context: a call under
 * another context forgets them. All functions: [context-thread].
 */
#ifndef OPENRT_GL_H
#define OPENRT_GL_H

#if defined(__gl_h_) || defined(__GL_H__)
#error "openrt/gl.h stands in place of GL/gl.h: include only one of them"
#endif

#include "openrt/gl_functions.h"
#include "openrt/gl_types.h"
#include "openrt/gl_values.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Frames and pictures -------------------------------------------------------------------------- */

/* How light is computed. */
enum {
  /* OpenGL's equation, without shadows, in colours of the screen (default). The environment
   * variable OPENRT_GL_LIGHT=opengl, shadows or linear sets another default. */
  RTGL_OPENGL = 0,
  /* The same, and lights cast shadows. */
  RTGL_SHADOWS = 1,
  /* Light is added linearly and followed from surface to surface. Lights cast shadows, and
   * surfaces with a specular colour reflect what is around them. Noise goes as samples come. */
  RTGL_LINEAR = 2
};
/* Sets how light is computed, from the next frame on. */
RT_API void rtglLight(int light);
/* Sets the samples per pixel of a frame (1 .. 65536, default 4). */
RT_API void rtglSamples(int samples);
/* Ends the frame: commits what was recorded since the last frame, and renders it. Returns 1, or 0
 * if there is an error or no viewport. glReadPixels and rtglPicture then read this picture. */
RT_API int rtglEndFrame(void);
/* Renders the same frame with other samples and adds them to the picture. Returns the samples per
 * pixel that it has now, or 0 if there is no picture. */
RT_API int rtglRefine(void);
/* Writes the size of the picture and returns its 8-bit colours for screens: rgb, rows from the top
 * down, tightly packed. They are valid until the next call of rtglEndFrame or rtglRefine. Returns
 * NULL if there is no picture. */
RT_API const unsigned char* rtglPicture(int* width, int* height);
/* Tells whether glFlush and glFinish end a frame in which something was drawn, as programs with
 * one buffer expect. Default 0. */
RT_API void rtglSingleBuffer(int single);
/* Sets a function that is called on every error. It also gets what is refused, once by each name:
 * the message says what to use instead. NULL removes it. Errors of openrt/openrt.h go to
 * rtErrorCallback. */
RT_API void rtglErrorCallback(RTerrorCallback callback, void* user);
/* Returns the text of the error that the last glGetError returned. */
RT_API const char* rtglGetErrorMessage(void);
/* Forgets lists, textures, state and what is retained of the scene. Call it before the context is
 * deleted. */
RT_API void rtglReset(void);

/* Utilities (GLU 1.3) -------------------------------------------------------------------------- */

RT_API void rtuPerspective(GLdouble fovy, GLdouble aspect, GLdouble zNear, GLdouble zFar);
RT_API void rtuLookAt(GLdouble eyeX, GLdouble eyeY, GLdouble eyeZ, GLdouble centerX,
                      GLdouble centerY, GLdouble centerZ, GLdouble upX, GLdouble upY, GLdouble upZ);
RT_API void rtuOrtho2D(GLdouble left, GLdouble right, GLdouble bottom, GLdouble top);
/* Narrows the view to width x height pixels around x, y (from the lower left corner), for the
 * selection mode of glRenderMode. viewport: that of glGetIntegerv. */
RT_API void rtuPickMatrix(GLdouble x, GLdouble y, GLdouble width, GLdouble height,
                          const GLint* viewport);
/* Both return 1, or 0 if a matrix is singular. */
RT_API GLint rtuProject(GLdouble x, GLdouble y, GLdouble z, const GLdouble* model,
                        const GLdouble* projection, const GLint* viewport, GLdouble* windowX,
                        GLdouble* windowY, GLdouble* windowZ);
RT_API GLint rtuUnProject(GLdouble windowX, GLdouble windowY, GLdouble windowZ,
                          const GLdouble* model, const GLdouble* projection, const GLint* viewport,
                          GLdouble* x, GLdouble* y, GLdouble* z);
/* Sets the image of the bound texture; there is one level. Returns 0, or the error. */
RT_API GLint rtuBuild2DMipmaps(GLenum target, GLint components, GLsizei width, GLsizei height,
                               GLenum format, GLenum type, const void* data);
RT_API const GLubyte* rtuErrorString(GLenum error);

typedef struct RTUquadric_ RTUquadric;
RT_API RTUquadric* rtuNewQuadric(void);
RT_API void rtuDeleteQuadric(RTUquadric* quadric);
RT_API void rtuQuadricDrawStyle(RTUquadric* quadric, GLenum style);
RT_API void rtuQuadricNormals(RTUquadric* quadric, GLenum normals);
RT_API void rtuQuadricOrientation(RTUquadric* quadric, GLenum orientation);
RT_API void rtuQuadricTexture(RTUquadric* quadric, GLboolean texture);
RT_API void rtuSphere(RTUquadric* quadric, GLdouble radius, GLint slices, GLint stacks);
RT_API void rtuCylinder(RTUquadric* quadric, GLdouble base, GLdouble top, GLdouble height,
                        GLint slices, GLint stacks);
RT_API void rtuDisk(RTUquadric* quadric, GLdouble inner, GLdouble outer, GLint slices, GLint loops);
RT_API void rtuPartialDisk(RTUquadric* quadric, GLdouble inner, GLdouble outer, GLint slices,
                           GLint loops, GLdouble start, GLdouble sweep);

#ifdef __cplusplus
}
#endif

#define RTU_POINT 100010
#define RTU_LINE 100011
#define RTU_FILL 100012
#define RTU_SILHOUETTE 100013
#define RTU_SMOOTH 100000
#define RTU_FLAT 100001
#define RTU_NONE 100002
#define RTU_OUTSIDE 100020
#define RTU_INSIDE 100021

#define GLU_POINT RTU_POINT
#define GLU_LINE RTU_LINE
#define GLU_FILL RTU_FILL
#define GLU_SILHOUETTE RTU_SILHOUETTE
#define GLU_SMOOTH RTU_SMOOTH
#define GLU_FLAT RTU_FLAT
#define GLU_NONE RTU_NONE
#define GLU_OUTSIDE RTU_OUTSIDE
#define GLU_INSIDE RTU_INSIDE
#define GLU_TRUE GL_TRUE
#define GLU_FALSE GL_FALSE

typedef RTUquadric GLUquadric;
typedef RTUquadric GLUquadricObj;
typedef RTUquadric RTUquadricObj;

#define gluPerspective rtuPerspective
#define gluLookAt rtuLookAt
#define gluOrtho2D rtuOrtho2D
#define gluPickMatrix rtuPickMatrix
#define gluProject rtuProject
#define gluUnProject rtuUnProject
#define gluBuild2DMipmaps rtuBuild2DMipmaps
#define gluErrorString rtuErrorString
#define gluNewQuadric rtuNewQuadric
#define gluDeleteQuadric rtuDeleteQuadric
#define gluQuadricDrawStyle rtuQuadricDrawStyle
#define gluQuadricNormals rtuQuadricNormals
#define gluQuadricOrientation rtuQuadricOrientation
#define gluQuadricTexture rtuQuadricTexture
#define gluSphere rtuSphere
#define gluCylinder rtuCylinder
#define gluDisk rtuDisk
#define gluPartialDisk rtuPartialDisk

#include "openrt/gl_names.h"

#endif
