// glu.cpp: Implements the utilities of GLU that make matrices and name errors.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

Matrix matrixOf(const double* m) {
  Matrix matrix;
  std::copy_n(m, 16, matrix.begin());
  return matrix;
}

} // namespace

void rtuPerspective(GLdouble fovy, GLdouble aspect, GLdouble near, GLdouble far) {
  guarded("gluPerspective", [&](State&) {
    if (!(fovy > 0 && fovy < 180) || aspect == 0 || near == far)
      fail(GL_INVALID_VALUE, "the view is empty");
    const double top = near * std::tan(fovy * (std::numbers::pi / 360));
    rtglFrustum(-top * aspect, top * aspect, -top, top, near, far);
  });
}

void rtuLookAt(GLdouble eyeX, GLdouble eyeY, GLdouble eyeZ, GLdouble atX, GLdouble atY,
               GLdouble atZ, GLdouble upX, GLdouble upY, GLdouble upZ) {
  const Matrix m = lookAt({eyeX, eyeY, eyeZ}, {atX, atY, atZ}, {upX, upY, upZ});
  rtglMultMatrixd(m.data());
}

void rtuOrtho2D(GLdouble left, GLdouble right, GLdouble bottom, GLdouble top) {
  rtglOrtho(left, right, bottom, top, -1, 1);
}

void rtuPickMatrix(GLdouble x, GLdouble y, GLdouble width, GLdouble height, const GLint* viewport) {
  if (!(width > 0 && height > 0)) return; // as GLU does
  rtglTranslated((viewport[2] - 2 * (x - viewport[0])) / width,
                 (viewport[3] - 2 * (y - viewport[1])) / height, 0);
  rtglScaled(viewport[2] / width, viewport[3] / height, 1);
}

GLint rtuProject(GLdouble x, GLdouble y, GLdouble z, const GLdouble* model,
                 const GLdouble* projection, const GLint* viewport, GLdouble* windowX,
                 GLdouble* windowY, GLdouble* windowZ) {
  const std::array<double, 4> clip =
      transform(matrixOf(projection), transform(matrixOf(model), {x, y, z, 1}));
  if (clip[3] == 0) return GL_FALSE;
  *windowX = viewport[0] + viewport[2] * (clip[0] / clip[3] + 1) / 2;
  *windowY = viewport[1] + viewport[3] * (clip[1] / clip[3] + 1) / 2;
  *windowZ = (clip[2] / clip[3] + 1) / 2;
  return GL_TRUE;
}

GLint rtuUnProject(GLdouble windowX, GLdouble windowY, GLdouble windowZ, const GLdouble* model,
                   const GLdouble* projection, const GLint* viewport, GLdouble* x, GLdouble* y,
                   GLdouble* z) {
  Matrix back;
  if (!invert(matrixOf(projection) * matrixOf(model), back)) return GL_FALSE;
  const std::array<double, 4> p =
      transform(back, {2 * (windowX - viewport[0]) / viewport[2] - 1,
                       2 * (windowY - viewport[1]) / viewport[3] - 1, 2 * windowZ - 1, 1});
  if (p[3] == 0) return GL_FALSE;
  *x = p[0] / p[3];
  *y = p[1] / p[3];
  *z = p[2] / p[3];
  return GL_TRUE;
}

GLint rtuBuild2DMipmaps(GLenum target, GLint components, GLsizei width, GLsizei height,
                        GLenum format, GLenum type, const void* data) {
  rtglTexImage2D(target, 0, components, width, height, 0, format, type, data);
  return 0;
}

const GLubyte* rtuErrorString(GLenum error) {
  const char* text = "unknown error";
  switch (error) {
  case GL_NO_ERROR: text = "no error"; break;
  case GL_INVALID_ENUM: text = "invalid enumerant"; break;
  case GL_INVALID_VALUE: text = "invalid value"; break;
  case GL_INVALID_OPERATION: text = "invalid operation"; break;
  case GL_STACK_OVERFLOW: text = "stack overflow"; break;
  case GL_STACK_UNDERFLOW: text = "stack underflow"; break;
  case GL_OUT_OF_MEMORY: text = "out of memory"; break;
  default: break;
  }
  return reinterpret_cast<const GLubyte*>(text);
}
