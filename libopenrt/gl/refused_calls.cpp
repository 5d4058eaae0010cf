// refused_calls.cpp: The calls of OpenGL 1.1 that have no counterpart. Each is refused once, with
// what to use instead; otherwise it does nothing.
#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {
constexpr const char* noIndices = "colours have no indices: use glColor";
constexpr const char* noLogic = "there are no logical operations on pixels";
constexpr const char* noStipple = "draw dashes as lines, and half-tones by GL_BLEND";
constexpr const char* noScissor = "use rtScissor (openrt/frame.h), or a smaller viewport";
constexpr const char* noClipping = "cut the geometry in the program";
constexpr const char* noFeedback = "gluProject tells where vertices are in the picture";
constexpr const char* noAccumulation = "samples smooth edges and move (rtglSamples, rtglRefine)";
constexpr const char* noRaster = "draw a rectangle with a texture";
constexpr const char* noTransfer = "change the pixels in the program";
constexpr const char* noStencils = "shadows and mirrors are traced (rtglLight)";
constexpr const char* noTexGen = "give texture coordinates by glTexCoord";
constexpr const char* noTextureQuery = "keep the picture in the program";
constexpr const char* noCopy = "use glReadPixels and glTexImage2D";
constexpr const char* noEvaluators = "tessellate the surface in the program";

void refuse(const char* name, const char* instead) {
  guarded(name, [=](State& s) { s.refuse(name, instead); });
}
} // namespace

#define REFUSE(name, parameters, instead)                                                          \
  void rtgl##name parameters { refuse("gl" #name, instead); }

REFUSE(ClearIndex, (GLfloat), noIndices)
REFUSE(IndexMask, (GLuint), noIndices)
REFUSE(Indexd, (GLdouble), noIndices)
REFUSE(Indexf, (GLfloat), noIndices)
REFUSE(Indexi, (GLint), noIndices)
REFUSE(Indexs, (GLshort), noIndices)
REFUSE(Indexub, (GLubyte), noIndices)
REFUSE(Indexdv, (const GLdouble*), noIndices)
REFUSE(Indexfv, (const GLfloat*), noIndices)
REFUSE(Indexiv, (const GLint*), noIndices)
REFUSE(Indexsv, (const GLshort*), noIndices)
REFUSE(Indexubv, (const GLubyte*), noIndices)
REFUSE(IndexPointer, (GLenum, GLsizei, const GLvoid*), noIndices)
REFUSE(LogicOp, (GLenum), noLogic)
REFUSE(LineStipple, (GLint, GLushort), noStipple)
REFUSE(PolygonStipple, (const GLubyte*), noStipple)
REFUSE(GetPolygonStipple, (GLubyte*), noStipple)
REFUSE(Scissor, (GLint, GLint, GLsizei, GLsizei), noScissor)
REFUSE(ClipPlane, (GLenum, const GLdouble*), noClipping)
REFUSE(GetClipPlane, (GLenum, GLdouble*), noClipping)
REFUSE(FeedbackBuffer, (GLsizei, GLenum, GLfloat*), noFeedback)
REFUSE(PassThrough, (GLfloat), noFeedback)
REFUSE(ClearAccum, (GLfloat, GLfloat, GLfloat, GLfloat), noAccumulation)
REFUSE(Accum, (GLenum, GLfloat), noAccumulation)
REFUSE(RasterPos2d, (GLdouble, GLdouble), noRaster)
REFUSE(RasterPos2f, (GLfloat, GLfloat), noRaster)
REFUSE(RasterPos2i, (GLint, GLint), noRaster)
REFUSE(RasterPos2s, (GLshort, GLshort), noRaster)
REFUSE(RasterPos3d, (GLdouble, GLdouble, GLdouble), noRaster)
REFUSE(RasterPos3f, (GLfloat, GLfloat, GLfloat), noRaster)
REFUSE(RasterPos3i, (GLint, GLint, GLint), noRaster)
REFUSE(RasterPos3s, (GLshort, GLshort, GLshort), noRaster)
REFUSE(RasterPos4d, (GLdouble, GLdouble, GLdouble, GLdouble), noRaster)
REFUSE(RasterPos4f, (GLfloat, GLfloat, GLfloat, GLfloat), noRaster)
REFUSE(RasterPos4i, (GLint, GLint, GLint, GLint), noRaster)
REFUSE(RasterPos4s, (GLshort, GLshort, GLshort, GLshort), noRaster)
REFUSE(RasterPos2dv, (const GLdouble*), noRaster)
REFUSE(RasterPos2fv, (const GLfloat*), noRaster)
REFUSE(RasterPos2iv, (const GLint*), noRaster)
REFUSE(RasterPos2sv, (const GLshort*), noRaster)
REFUSE(RasterPos3dv, (const GLdouble*), noRaster)
REFUSE(RasterPos3fv, (const GLfloat*), noRaster)
REFUSE(RasterPos3iv, (const GLint*), noRaster)
REFUSE(RasterPos3sv, (const GLshort*), noRaster)
REFUSE(RasterPos4dv, (const GLdouble*), noRaster)
REFUSE(RasterPos4fv, (const GLfloat*), noRaster)
REFUSE(RasterPos4iv, (const GLint*), noRaster)
REFUSE(RasterPos4sv, (const GLshort*), noRaster)
REFUSE(PixelZoom, (GLfloat, GLfloat), noRaster)
REFUSE(Bitmap, (GLsizei, GLsizei, GLfloat, GLfloat, GLfloat, GLfloat, const GLubyte*), noRaster)
REFUSE(DrawPixels, (GLsizei, GLsizei, GLenum, GLenum, const GLvoid*), noRaster)
REFUSE(CopyPixels, (GLint, GLint, GLsizei, GLsizei, GLenum), noRaster)
REFUSE(PixelTransferf, (GLenum, GLfloat), noTransfer)
REFUSE(PixelTransferi, (GLenum, GLint), noTransfer)
REFUSE(PixelMapfv, (GLenum, GLsizei, const GLfloat*), noTransfer)
REFUSE(PixelMapuiv, (GLenum, GLsizei, const GLuint*), noTransfer)
REFUSE(PixelMapusv, (GLenum, GLsizei, const GLushort*), noTransfer)
REFUSE(GetPixelMapfv, (GLenum, GLfloat*), noTransfer)
REFUSE(GetPixelMapuiv, (GLenum, GLuint*), noTransfer)
REFUSE(GetPixelMapusv, (GLenum, GLushort*), noTransfer)
REFUSE(StencilFunc, (GLenum, GLint, GLuint), noStencils)
REFUSE(StencilMask, (GLuint), noStencils)
REFUSE(StencilOp, (GLenum, GLenum, GLenum), noStencils)
REFUSE(ClearStencil, (GLint), noStencils)
REFUSE(TexGend, (GLenum, GLenum, GLdouble), noTexGen)
REFUSE(TexGenf, (GLenum, GLenum, GLfloat), noTexGen)
REFUSE(TexGeni, (GLenum, GLenum, GLint), noTexGen)
REFUSE(TexGendv, (GLenum, GLenum, const GLdouble*), noTexGen)
REFUSE(TexGenfv, (GLenum, GLenum, const GLfloat*), noTexGen)
REFUSE(TexGeniv, (GLenum, GLenum, const GLint*), noTexGen)
REFUSE(GetTexGendv, (GLenum, GLenum, GLdouble*), noTexGen)
REFUSE(GetTexGenfv, (GLenum, GLenum, GLfloat*), noTexGen)
REFUSE(GetTexGeniv, (GLenum, GLenum, GLint*), noTexGen)
REFUSE(GetTexLevelParameterfv, (GLenum, GLint, GLenum, GLfloat*), noTextureQuery)
REFUSE(GetTexLevelParameteriv, (GLenum, GLint, GLenum, GLint*), noTextureQuery)
REFUSE(GetTexImage, (GLenum, GLint, GLenum, GLenum, GLvoid*), noTextureQuery)
REFUSE(CopyTexImage1D, (GLenum, GLint, GLenum, GLint, GLint, GLsizei, GLint), noCopy)
REFUSE(CopyTexImage2D, (GLenum, GLint, GLenum, GLint, GLint, GLsizei, GLsizei, GLint), noCopy)
REFUSE(CopyTexSubImage1D, (GLenum, GLint, GLint, GLint, GLint, GLsizei), noCopy)
REFUSE(CopyTexSubImage2D, (GLenum, GLint, GLint, GLint, GLint, GLint, GLsizei, GLsizei), noCopy)
REFUSE(Map1d, (GLenum, GLdouble, GLdouble, GLint, GLint, const GLdouble*), noEvaluators)
REFUSE(Map1f, (GLenum, GLfloat, GLfloat, GLint, GLint, const GLfloat*), noEvaluators)
REFUSE(Map2d,
       (GLenum, GLdouble, GLdouble, GLint, GLint, GLdouble, GLdouble, GLint, GLint,
        const GLdouble*),
       noEvaluators)
REFUSE(Map2f,
       (GLenum, GLfloat, GLfloat, GLint, GLint, GLfloat, GLfloat, GLint, GLint, const GLfloat*),
       noEvaluators)
REFUSE(GetMapdv, (GLenum, GLenum, GLdouble*), noEvaluators)
REFUSE(GetMapfv, (GLenum, GLenum, GLfloat*), noEvaluators)
REFUSE(GetMapiv, (GLenum, GLenum, GLint*), noEvaluators)
REFUSE(EvalCoord1d, (GLdouble), noEvaluators)
REFUSE(EvalCoord1f, (GLfloat), noEvaluators)
REFUSE(EvalCoord1dv, (const GLdouble*), noEvaluators)
REFUSE(EvalCoord1fv, (const GLfloat*), noEvaluators)
REFUSE(EvalCoord2d, (GLdouble, GLdouble), noEvaluators)
REFUSE(EvalCoord2f, (GLfloat, GLfloat), noEvaluators)
REFUSE(EvalCoord2dv, (const GLdouble*), noEvaluators)
REFUSE(EvalCoord2fv, (const GLfloat*), noEvaluators)
REFUSE(MapGrid1d, (GLint, GLdouble, GLdouble), noEvaluators)
REFUSE(MapGrid1f, (GLint, GLfloat, GLfloat), noEvaluators)
REFUSE(MapGrid2d, (GLint, GLdouble, GLdouble, GLint, GLdouble, GLdouble), noEvaluators)
REFUSE(MapGrid2f, (GLint, GLfloat, GLfloat, GLint, GLfloat, GLfloat), noEvaluators)
REFUSE(EvalPoint1, (GLint), noEvaluators)
REFUSE(EvalPoint2, (GLint, GLint), noEvaluators)
REFUSE(EvalMesh1, (GLenum, GLint, GLint), noEvaluators)
REFUSE(EvalMesh2, (GLenum, GLint, GLint, GLint, GLint), noEvaluators)
