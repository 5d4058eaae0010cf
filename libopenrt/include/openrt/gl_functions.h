/* gl_functions.h: the functions of OpenGL 1.1 (ISO C declarations). openrt/gl.h includes it and
 * says how they differ from OpenGL's. The OpenGL Graphics System, version 1.1, defines them; the
 * comments here only name the groups. All of them: [context-thread].
 */
#ifndef OPENRT_GL_FUNCTIONS_H
#define OPENRT_GL_FUNCTIONS_H

#include "openrt/gl_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Vertices, between rtBegin and rtEnd ---------------------------------------------------------- */

RT_API void rtglEdgeFlag(GLboolean flag);
RT_API void rtglEdgeFlagv(const GLboolean* flag);
RT_API void rtglBegin(GLenum mode);
RT_API void rtglEnd(void);
RT_API void rtglVertex2d(GLdouble x, GLdouble y);
RT_API void rtglVertex2f(GLfloat x, GLfloat y);
RT_API void rtglVertex2i(GLint x, GLint y);
RT_API void rtglVertex2s(GLshort x, GLshort y);
RT_API void rtglVertex3d(GLdouble x, GLdouble y, GLdouble z);
RT_API void rtglVertex3f(GLfloat x, GLfloat y, GLfloat z);
RT_API void rtglVertex3i(GLint x, GLint y, GLint z);
RT_API void rtglVertex3s(GLshort x, GLshort y, GLshort z);
RT_API void rtglVertex4d(GLdouble x, GLdouble y, GLdouble z, GLdouble w);
RT_API void rtglVertex4f(GLfloat x, GLfloat y, GLfloat z, GLfloat w);
RT_API void rtglVertex4i(GLint x, GLint y, GLint z, GLint w);
RT_API void rtglVertex4s(GLshort x, GLshort y, GLshort z, GLshort w);
RT_API void rtglVertex2dv(const GLdouble* v);
RT_API void rtglVertex2fv(const GLfloat* v);
RT_API void rtglVertex2iv(const GLint* v);
RT_API void rtglVertex2sv(const GLshort* v);
RT_API void rtglVertex3dv(const GLdouble* v);
RT_API void rtglVertex3fv(const GLfloat* v);
RT_API void rtglVertex3iv(const GLint* v);
RT_API void rtglVertex3sv(const GLshort* v);
RT_API void rtglVertex4dv(const GLdouble* v);
RT_API void rtglVertex4fv(const GLfloat* v);
RT_API void rtglVertex4iv(const GLint* v);
RT_API void rtglVertex4sv(const GLshort* v);
RT_API void rtglNormal3b(GLbyte nx, GLbyte ny, GLbyte nz);
RT_API void rtglNormal3d(GLdouble nx, GLdouble ny, GLdouble nz);
RT_API void rtglNormal3f(GLfloat nx, GLfloat ny, GLfloat nz);
RT_API void rtglNormal3i(GLint nx, GLint ny, GLint nz);
RT_API void rtglNormal3s(GLshort nx, GLshort ny, GLshort nz);
RT_API void rtglNormal3bv(const GLbyte* v);
RT_API void rtglNormal3dv(const GLdouble* v);
RT_API void rtglNormal3fv(const GLfloat* v);
RT_API void rtglNormal3iv(const GLint* v);
RT_API void rtglNormal3sv(const GLshort* v);
RT_API void rtglColor3b(GLbyte red, GLbyte green, GLbyte blue);
RT_API void rtglColor3d(GLdouble red, GLdouble green, GLdouble blue);
RT_API void rtglColor3f(GLfloat red, GLfloat green, GLfloat blue);
RT_API void rtglColor3i(GLint red, GLint green, GLint blue);
RT_API void rtglColor3s(GLshort red, GLshort green, GLshort blue);
RT_API void rtglColor3ub(GLubyte red, GLubyte green, GLubyte blue);
RT_API void rtglColor3ui(GLuint red, GLuint green, GLuint blue);
RT_API void rtglColor3us(GLushort red, GLushort green, GLushort blue);
RT_API void rtglColor4b(GLbyte red, GLbyte green, GLbyte blue, GLbyte alpha);
RT_API void rtglColor4d(GLdouble red, GLdouble green, GLdouble blue, GLdouble alpha);
RT_API void rtglColor4f(GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha);
RT_API void rtglColor4i(GLint red, GLint green, GLint blue, GLint alpha);
RT_API void rtglColor4s(GLshort red, GLshort green, GLshort blue, GLshort alpha);
RT_API void rtglColor4ub(GLubyte red, GLubyte green, GLubyte blue, GLubyte alpha);
RT_API void rtglColor4ui(GLuint red, GLuint green, GLuint blue, GLuint alpha);
RT_API void rtglColor4us(GLushort red, GLushort green, GLushort blue, GLushort alpha);
RT_API void rtglColor3bv(const GLbyte* v);
RT_API void rtglColor3dv(const GLdouble* v);
RT_API void rtglColor3fv(const GLfloat* v);
RT_API void rtglColor3iv(const GLint* v);
RT_API void rtglColor3sv(const GLshort* v);
RT_API void rtglColor3ubv(const GLubyte* v);
RT_API void rtglColor3uiv(const GLuint* v);
RT_API void rtglColor3usv(const GLushort* v);
RT_API void rtglColor4bv(const GLbyte* v);
RT_API void rtglColor4dv(const GLdouble* v);
RT_API void rtglColor4fv(const GLfloat* v);
RT_API void rtglColor4iv(const GLint* v);
RT_API void rtglColor4sv(const GLshort* v);
RT_API void rtglColor4ubv(const GLubyte* v);
RT_API void rtglColor4uiv(const GLuint* v);
RT_API void rtglColor4usv(const GLushort* v);
RT_API void rtglTexCoord1d(GLdouble s);
RT_API void rtglTexCoord1f(GLfloat s);
RT_API void rtglTexCoord1i(GLint s);
RT_API void rtglTexCoord1s(GLshort s);
RT_API void rtglTexCoord2d(GLdouble s, GLdouble t);
RT_API void rtglTexCoord2f(GLfloat s, GLfloat t);
RT_API void rtglTexCoord2i(GLint s, GLint t);
RT_API void rtglTexCoord2s(GLshort s, GLshort t);
RT_API void rtglTexCoord3d(GLdouble s, GLdouble t, GLdouble r);
RT_API void rtglTexCoord3f(GLfloat s, GLfloat t, GLfloat r);
RT_API void rtglTexCoord3i(GLint s, GLint t, GLint r);
RT_API void rtglTexCoord3s(GLshort s, GLshort t, GLshort r);
RT_API void rtglTexCoord4d(GLdouble s, GLdouble t, GLdouble r, GLdouble q);
RT_API void rtglTexCoord4f(GLfloat s, GLfloat t, GLfloat r, GLfloat q);
RT_API void rtglTexCoord4i(GLint s, GLint t, GLint r, GLint q);
RT_API void rtglTexCoord4s(GLshort s, GLshort t, GLshort r, GLshort q);
RT_API void rtglTexCoord1dv(const GLdouble* v);
RT_API void rtglTexCoord1fv(const GLfloat* v);
RT_API void rtglTexCoord1iv(const GLint* v);
RT_API void rtglTexCoord1sv(const GLshort* v);
RT_API void rtglTexCoord2dv(const GLdouble* v);
RT_API void rtglTexCoord2fv(const GLfloat* v);
RT_API void rtglTexCoord2iv(const GLint* v);
RT_API void rtglTexCoord2sv(const GLshort* v);
RT_API void rtglTexCoord3dv(const GLdouble* v);
RT_API void rtglTexCoord3fv(const GLfloat* v);
RT_API void rtglTexCoord3iv(const GLint* v);
RT_API void rtglTexCoord3sv(const GLshort* v);
RT_API void rtglTexCoord4dv(const GLdouble* v);
RT_API void rtglTexCoord4fv(const GLfloat* v);
RT_API void rtglTexCoord4iv(const GLint* v);
RT_API void rtglTexCoord4sv(const GLshort* v);
RT_API void rtglRectd(GLdouble x1, GLdouble y1, GLdouble x2, GLdouble y2);
RT_API void rtglRectf(GLfloat x1, GLfloat y1, GLfloat x2, GLfloat y2);
RT_API void rtglRecti(GLint x1, GLint y1, GLint x2, GLint y2);
RT_API void rtglRects(GLshort x1, GLshort y1, GLshort x2, GLshort y2);
RT_API void rtglRectdv(const GLdouble* v1, const GLdouble* v2);
RT_API void rtglRectfv(const GLfloat* v1, const GLfloat* v2);
RT_API void rtglRectiv(const GLint* v1, const GLint* v2);
RT_API void rtglRectsv(const GLshort* v1, const GLshort* v2);
RT_API void rtglArrayElement(GLint i);

/* Vertex arrays -------------------------------------------------------------------------------- */

RT_API void rtglEnableClientState(GLenum cap);
RT_API void rtglDisableClientState(GLenum cap);
RT_API void rtglPushClientAttrib(GLbitfield mask);
RT_API void rtglPopClientAttrib(void);
RT_API void rtglVertexPointer(GLint size, GLenum type, GLsizei stride, const GLvoid* ptr);
RT_API void rtglNormalPointer(GLenum type, GLsizei stride, const GLvoid* ptr);
RT_API void rtglColorPointer(GLint size, GLenum type, GLsizei stride, const GLvoid* ptr);
RT_API void rtglTexCoordPointer(GLint size, GLenum type, GLsizei stride, const GLvoid* ptr);
RT_API void rtglEdgeFlagPointer(GLsizei stride, const GLvoid* ptr);
RT_API void rtglGetPointerv(GLenum pname, GLvoid** params);
RT_API void rtglDrawArrays(GLenum mode, GLint first, GLsizei count);
RT_API void rtglDrawElements(GLenum mode, GLsizei count, GLenum type, const GLvoid* indices);
RT_API void rtglInterleavedArrays(GLenum format, GLsizei stride, const GLvoid* pointer);

/* Matrices and the view ------------------------------------------------------------------------ */

RT_API void rtglDepthRange(GLclampd near_val, GLclampd far_val);
RT_API void rtglMatrixMode(GLenum mode);
RT_API void rtglOrtho(GLdouble left, GLdouble right, GLdouble bottom, GLdouble top,
                      GLdouble near_val, GLdouble far_val);
RT_API void rtglFrustum(GLdouble left, GLdouble right, GLdouble bottom, GLdouble top,
                        GLdouble near_val, GLdouble far_val);
RT_API void rtglViewport(GLint x, GLint y, GLsizei width, GLsizei height);
RT_API void rtglPushMatrix(void);
RT_API void rtglPopMatrix(void);
RT_API void rtglLoadIdentity(void);
RT_API void rtglLoadMatrixd(const GLdouble* m);
RT_API void rtglLoadMatrixf(const GLfloat* m);
RT_API void rtglMultMatrixd(const GLdouble* m);
RT_API void rtglMultMatrixf(const GLfloat* m);
RT_API void rtglRotated(GLdouble angle, GLdouble x, GLdouble y, GLdouble z);
RT_API void rtglRotatef(GLfloat angle, GLfloat x, GLfloat y, GLfloat z);
RT_API void rtglScaled(GLdouble x, GLdouble y, GLdouble z);
RT_API void rtglScalef(GLfloat x, GLfloat y, GLfloat z);
RT_API void rtglTranslated(GLdouble x, GLdouble y, GLdouble z);
RT_API void rtglTranslatef(GLfloat x, GLfloat y, GLfloat z);

/* Display lists -------------------------------------------------------------------------------- */

RT_API GLboolean rtglIsList(GLuint list);
RT_API void rtglDeleteLists(GLuint list, GLsizei range);
RT_API GLuint rtglGenLists(GLsizei range);
RT_API void rtglNewList(GLuint list, GLenum mode);
RT_API void rtglEndList(void);
RT_API void rtglCallList(GLuint list);
RT_API void rtglCallLists(GLsizei n, GLenum type, const GLvoid* lists);
RT_API void rtglListBase(GLuint base);

/* Lights, materials, fog ----------------------------------------------------------------------- */

RT_API void rtglShadeModel(GLenum mode);
RT_API void rtglLightf(GLenum light, GLenum pname, GLfloat param);
RT_API void rtglLighti(GLenum light, GLenum pname, GLint param);
RT_API void rtglLightfv(GLenum light, GLenum pname, const GLfloat* params);
RT_API void rtglLightiv(GLenum light, GLenum pname, const GLint* params);
RT_API void rtglGetLightfv(GLenum light, GLenum pname, GLfloat* params);
RT_API void rtglGetLightiv(GLenum light, GLenum pname, GLint* params);
RT_API void rtglLightModelf(GLenum pname, GLfloat param);
RT_API void rtglLightModeli(GLenum pname, GLint param);
RT_API void rtglLightModelfv(GLenum pname, const GLfloat* params);
RT_API void rtglLightModeliv(GLenum pname, const GLint* params);
RT_API void rtglMaterialf(GLenum face, GLenum pname, GLfloat param);
RT_API void rtglMateriali(GLenum face, GLenum pname, GLint param);
RT_API void rtglMaterialfv(GLenum face, GLenum pname, const GLfloat* params);
RT_API void rtglMaterialiv(GLenum face, GLenum pname, const GLint* params);
RT_API void rtglGetMaterialfv(GLenum face, GLenum pname, GLfloat* params);
RT_API void rtglGetMaterialiv(GLenum face, GLenum pname, GLint* params);
RT_API void rtglColorMaterial(GLenum face, GLenum mode);
RT_API void rtglFogf(GLenum pname, GLfloat param);
RT_API void rtglFogi(GLenum pname, GLint param);
RT_API void rtglFogfv(GLenum pname, const GLfloat* params);
RT_API void rtglFogiv(GLenum pname, const GLint* params);

/* Textures ------------------------------------------------------------------------------------- */

RT_API void rtglPixelStoref(GLenum pname, GLfloat param);
RT_API void rtglPixelStorei(GLenum pname, GLint param);
RT_API void rtglTexEnvf(GLenum target, GLenum pname, GLfloat param);
RT_API void rtglTexEnvi(GLenum target, GLenum pname, GLint param);
RT_API void rtglTexEnvfv(GLenum target, GLenum pname, const GLfloat* params);
RT_API void rtglTexEnviv(GLenum target, GLenum pname, const GLint* params);
RT_API void rtglGetTexEnvfv(GLenum target, GLenum pname, GLfloat* params);
RT_API void rtglGetTexEnviv(GLenum target, GLenum pname, GLint* params);
RT_API void rtglTexParameterf(GLenum target, GLenum pname, GLfloat param);
RT_API void rtglTexParameteri(GLenum target, GLenum pname, GLint param);
RT_API void rtglTexParameterfv(GLenum target, GLenum pname, const GLfloat* params);
RT_API void rtglTexParameteriv(GLenum target, GLenum pname, const GLint* params);
RT_API void rtglGetTexParameterfv(GLenum target, GLenum pname, GLfloat* params);
RT_API void rtglGetTexParameteriv(GLenum target, GLenum pname, GLint* params);
RT_API void rtglTexImage1D(GLenum target, GLint level, GLint internalFormat, GLsizei width,
                           GLint border, GLenum format, GLenum type, const GLvoid* pixels);
RT_API void rtglTexImage2D(GLenum target, GLint level, GLint internalFormat, GLsizei width,
                           GLsizei height, GLint border, GLenum format, GLenum type,
                           const GLvoid* pixels);
RT_API void rtglGenTextures(GLsizei n, GLuint* textures);
RT_API void rtglDeleteTextures(GLsizei n, const GLuint* textures);
RT_API void rtglBindTexture(GLenum target, GLuint texture);
RT_API void rtglPrioritizeTextures(GLsizei n, const GLuint* textures, const GLclampf* priorities);
RT_API GLboolean rtglAreTexturesResident(GLsizei n, const GLuint* textures, GLboolean* residences);
RT_API GLboolean rtglIsTexture(GLuint texture);
RT_API void rtglTexSubImage1D(GLenum target, GLint level, GLint xoffset, GLsizei width,
                              GLenum format, GLenum type, const GLvoid* pixels);
RT_API void rtglTexSubImage2D(GLenum target, GLint level, GLint xoffset, GLint yoffset,
                              GLsizei width, GLsizei height, GLenum format, GLenum type,
                              const GLvoid* pixels);

/* State ---------------------------------------------------------------------------------------- */

RT_API void rtglColorMask(GLboolean red, GLboolean green, GLboolean blue, GLboolean alpha);
RT_API void rtglAlphaFunc(GLenum func, GLclampf ref);
RT_API void rtglBlendFunc(GLenum sfactor, GLenum dfactor);
RT_API void rtglCullFace(GLenum mode);
RT_API void rtglFrontFace(GLenum mode);
RT_API void rtglPointSize(GLfloat size);
RT_API void rtglLineWidth(GLfloat width);
RT_API void rtglPolygonMode(GLenum face, GLenum mode);
RT_API void rtglPolygonOffset(GLfloat factor, GLfloat units);
RT_API void rtglEnable(GLenum cap);
RT_API void rtglDisable(GLenum cap);
RT_API GLboolean rtglIsEnabled(GLenum cap);
RT_API void rtglGetBooleanv(GLenum pname, GLboolean* params);
RT_API void rtglGetDoublev(GLenum pname, GLdouble* params);
RT_API void rtglGetFloatv(GLenum pname, GLfloat* params);
RT_API void rtglGetIntegerv(GLenum pname, GLint* params);
RT_API void rtglPushAttrib(GLbitfield mask);
RT_API void rtglPopAttrib(void);
RT_API GLenum rtglGetError(void);
RT_API const GLubyte* rtglGetString(GLenum name);
RT_API void rtglHint(GLenum target, GLenum mode);
RT_API void rtglDepthFunc(GLenum func);
RT_API void rtglDepthMask(GLboolean flag);

/* Frames --------------------------------------------------------------------------------------- */

RT_API void rtglClearColor(GLclampf red, GLclampf green, GLclampf blue, GLclampf alpha);
RT_API void rtglClear(GLbitfield mask);
RT_API void rtglDrawBuffer(GLenum mode);
RT_API void rtglReadBuffer(GLenum mode);
RT_API void rtglFinish(void);
RT_API void rtglFlush(void);
RT_API void rtglClearDepth(GLclampd depth);
RT_API void rtglReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format,
                           GLenum type, GLvoid* pixels);

/* Refused, each once by its name; docs/from-opengl.md says what to use instead ----------------- */

RT_API void rtglClearIndex(GLfloat c);
RT_API void rtglIndexMask(GLuint mask);
RT_API void rtglLogicOp(GLenum opcode);
RT_API void rtglLineStipple(GLint factor, GLushort pattern);
RT_API void rtglPolygonStipple(const GLubyte* mask);
RT_API void rtglGetPolygonStipple(GLubyte* mask);
RT_API void rtglScissor(GLint x, GLint y, GLsizei width, GLsizei height);
RT_API void rtglClipPlane(GLenum plane, const GLdouble* equation);
RT_API void rtglGetClipPlane(GLenum plane, GLdouble* equation);
RT_API GLint rtglRenderMode(GLenum mode);
RT_API void rtglClearAccum(GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha);
RT_API void rtglAccum(GLenum op, GLfloat value);
RT_API void rtglIndexd(GLdouble c);
RT_API void rtglIndexf(GLfloat c);
RT_API void rtglIndexi(GLint c);
RT_API void rtglIndexs(GLshort c);
RT_API void rtglIndexub(GLubyte c);
RT_API void rtglIndexdv(const GLdouble* c);
RT_API void rtglIndexfv(const GLfloat* c);
RT_API void rtglIndexiv(const GLint* c);
RT_API void rtglIndexsv(const GLshort* c);
RT_API void rtglIndexubv(const GLubyte* c);
RT_API void rtglRasterPos2d(GLdouble x, GLdouble y);
RT_API void rtglRasterPos2f(GLfloat x, GLfloat y);
RT_API void rtglRasterPos2i(GLint x, GLint y);
RT_API void rtglRasterPos2s(GLshort x, GLshort y);
RT_API void rtglRasterPos3d(GLdouble x, GLdouble y, GLdouble z);
RT_API void rtglRasterPos3f(GLfloat x, GLfloat y, GLfloat z);
RT_API void rtglRasterPos3i(GLint x, GLint y, GLint z);
RT_API void rtglRasterPos3s(GLshort x, GLshort y, GLshort z);
RT_API void rtglRasterPos4d(GLdouble x, GLdouble y, GLdouble z, GLdouble w);
RT_API void rtglRasterPos4f(GLfloat x, GLfloat y, GLfloat z, GLfloat w);
RT_API void rtglRasterPos4i(GLint x, GLint y, GLint z, GLint w);
RT_API void rtglRasterPos4s(GLshort x, GLshort y, GLshort z, GLshort w);
RT_API void rtglRasterPos2dv(const GLdouble* v);
RT_API void rtglRasterPos2fv(const GLfloat* v);
RT_API void rtglRasterPos2iv(const GLint* v);
RT_API void rtglRasterPos2sv(const GLshort* v);
RT_API void rtglRasterPos3dv(const GLdouble* v);
RT_API void rtglRasterPos3fv(const GLfloat* v);
RT_API void rtglRasterPos3iv(const GLint* v);
RT_API void rtglRasterPos3sv(const GLshort* v);
RT_API void rtglRasterPos4dv(const GLdouble* v);
RT_API void rtglRasterPos4fv(const GLfloat* v);
RT_API void rtglRasterPos4iv(const GLint* v);
RT_API void rtglRasterPos4sv(const GLshort* v);
RT_API void rtglIndexPointer(GLenum type, GLsizei stride, const GLvoid* ptr);
RT_API void rtglPixelZoom(GLfloat xfactor, GLfloat yfactor);
RT_API void rtglPixelTransferf(GLenum pname, GLfloat param);
RT_API void rtglPixelTransferi(GLenum pname, GLint param);
RT_API void rtglPixelMapfv(GLenum map, GLsizei mapsize, const GLfloat* values);
RT_API void rtglPixelMapuiv(GLenum map, GLsizei mapsize, const GLuint* values);
RT_API void rtglPixelMapusv(GLenum map, GLsizei mapsize, const GLushort* values);
RT_API void rtglGetPixelMapfv(GLenum map, GLfloat* values);
RT_API void rtglGetPixelMapuiv(GLenum map, GLuint* values);
RT_API void rtglGetPixelMapusv(GLenum map, GLushort* values);
RT_API void rtglBitmap(GLsizei width, GLsizei height, GLfloat xorig, GLfloat yorig, GLfloat xmove,
                       GLfloat ymove, const GLubyte* bitmap);
RT_API void rtglDrawPixels(GLsizei width, GLsizei height, GLenum format, GLenum type,
                           const GLvoid* pixels);
RT_API void rtglCopyPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum type);
RT_API void rtglStencilFunc(GLenum func, GLint ref, GLuint mask);
RT_API void rtglStencilMask(GLuint mask);
RT_API void rtglStencilOp(GLenum fail, GLenum zfail, GLenum zpass);
RT_API void rtglClearStencil(GLint s);
RT_API void rtglTexGend(GLenum coord, GLenum pname, GLdouble param);
RT_API void rtglTexGenf(GLenum coord, GLenum pname, GLfloat param);
RT_API void rtglTexGeni(GLenum coord, GLenum pname, GLint param);
RT_API void rtglTexGendv(GLenum coord, GLenum pname, const GLdouble* params);
RT_API void rtglTexGenfv(GLenum coord, GLenum pname, const GLfloat* params);
RT_API void rtglTexGeniv(GLenum coord, GLenum pname, const GLint* params);
RT_API void rtglGetTexGendv(GLenum coord, GLenum pname, GLdouble* params);
RT_API void rtglGetTexGenfv(GLenum coord, GLenum pname, GLfloat* params);
RT_API void rtglGetTexGeniv(GLenum coord, GLenum pname, GLint* params);
RT_API void rtglGetTexLevelParameterfv(GLenum target, GLint level, GLenum pname, GLfloat* params);
RT_API void rtglGetTexLevelParameteriv(GLenum target, GLint level, GLenum pname, GLint* params);
RT_API void rtglGetTexImage(GLenum target, GLint level, GLenum format, GLenum type, GLvoid* pixels);
RT_API void rtglCopyTexImage1D(GLenum target, GLint level, GLenum internalformat, GLint x, GLint y,
                               GLsizei width, GLint border);
RT_API void rtglCopyTexImage2D(GLenum target, GLint level, GLenum internalformat, GLint x, GLint y,
                               GLsizei width, GLsizei height, GLint border);
RT_API void rtglCopyTexSubImage1D(GLenum target, GLint level, GLint xoffset, GLint x, GLint y,
                                  GLsizei width);
RT_API void rtglCopyTexSubImage2D(GLenum target, GLint level, GLint xoffset, GLint yoffset, GLint x,
                                  GLint y, GLsizei width, GLsizei height);
RT_API void rtglMap1d(GLenum target, GLdouble u1, GLdouble u2, GLint stride, GLint order,
                      const GLdouble* points);
RT_API void rtglMap1f(GLenum target, GLfloat u1, GLfloat u2, GLint stride, GLint order,
                      const GLfloat* points);
RT_API void rtglMap2d(GLenum target, GLdouble u1, GLdouble u2, GLint ustride, GLint uorder,
                      GLdouble v1, GLdouble v2, GLint vstride, GLint vorder,
                      const GLdouble* points);
RT_API void rtglMap2f(GLenum target, GLfloat u1, GLfloat u2, GLint ustride, GLint uorder,
                      GLfloat v1, GLfloat v2, GLint vstride, GLint vorder, const GLfloat* points);
RT_API void rtglGetMapdv(GLenum target, GLenum query, GLdouble* v);
RT_API void rtglGetMapfv(GLenum target, GLenum query, GLfloat* v);
RT_API void rtglGetMapiv(GLenum target, GLenum query, GLint* v);
RT_API void rtglEvalCoord1d(GLdouble u);
RT_API void rtglEvalCoord1f(GLfloat u);
RT_API void rtglEvalCoord1dv(const GLdouble* u);
RT_API void rtglEvalCoord1fv(const GLfloat* u);
RT_API void rtglEvalCoord2d(GLdouble u, GLdouble v);
RT_API void rtglEvalCoord2f(GLfloat u, GLfloat v);
RT_API void rtglEvalCoord2dv(const GLdouble* u);
RT_API void rtglEvalCoord2fv(const GLfloat* u);
RT_API void rtglMapGrid1d(GLint un, GLdouble u1, GLdouble u2);
RT_API void rtglMapGrid1f(GLint un, GLfloat u1, GLfloat u2);
RT_API void rtglMapGrid2d(GLint un, GLdouble u1, GLdouble u2, GLint vn, GLdouble v1, GLdouble v2);
RT_API void rtglMapGrid2f(GLint un, GLfloat u1, GLfloat u2, GLint vn, GLfloat v1, GLfloat v2);
RT_API void rtglEvalPoint1(GLint i);
RT_API void rtglEvalPoint2(GLint i, GLint j);
RT_API void rtglEvalMesh1(GLenum mode, GLint i1, GLint i2);
RT_API void rtglEvalMesh2(GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2);
RT_API void rtglFeedbackBuffer(GLsizei size, GLenum type, GLfloat* buffer);
RT_API void rtglPassThrough(GLfloat token);
RT_API void rtglSelectBuffer(GLsizei size, GLuint* buffer);
RT_API void rtglInitNames(void);
RT_API void rtglLoadName(GLuint name);
RT_API void rtglPushName(GLuint name);
RT_API void rtglPopName(void);

#ifdef __cplusplus
}
#endif
#endif
