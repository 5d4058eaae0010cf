// matrix_calls.cpp: Implements the calls for matrices, the view and display lists.
#include <algorithm>

#include "gl/names.h"
#include "gl/numbers.h"
#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

constexpr size_t maxDepth = 4096; // matrices of a stack

template <class T> Matrix matrixOf(const T* m) {
  if (!m) fail(GL_INVALID_VALUE, "the matrix is NULL");
  Matrix matrix;
  for (size_t i = 0; i < 16; i++) matrix[i] = static_cast<double>(m[i]);
  return matrix;
}

template <class T> void load(const char* name, const T* m) {
  guarded(name, [&](State&) {
    const Matrix matrix = matrixOf(m);
    listed(name, [matrix](State& s) { s.top() = matrix; });
  });
}

void multiply(const char* name, const Matrix& m) {
  listed(name, [m](State& s) { s.top() = s.top() * m; });
}

template <class T> void multiplyBy(const char* name, const T* m) {
  guarded(name, [&](State&) { multiply(name, matrixOf(m)); });
}

bool isInterval(double from, double to) { return from < to || from > to; }

// Returns a number of an array of names (glCallLists).
GLuint nameAt(GLenum type, const void* lists, size_t i) {
  const auto* bytes = static_cast<const GLubyte*>(lists);
  switch (type) {
  case GL_BYTE: return static_cast<GLuint>(static_cast<const GLbyte*>(lists)[i]);
  case GL_UNSIGNED_BYTE: return bytes[i];
  case GL_SHORT: return static_cast<GLuint>(static_cast<const GLshort*>(lists)[i]);
  case GL_UNSIGNED_SHORT: return static_cast<const GLushort*>(lists)[i];
  case GL_INT:
  case GL_UNSIGNED_INT: return static_cast<const GLuint*>(lists)[i];
  case GL_FLOAT: return toName(static_cast<double>(static_cast<const GLfloat*>(lists)[i]));
  case GL_2_BYTES: return bytes[2 * i] * 256u + bytes[2 * i + 1];
  default: fail(GL_INVALID_ENUM, "no such type of names");
  }
}

} // namespace

void rtglMatrixMode(GLenum mode) {
  listed("glMatrixMode", [=](State& s) {
    if (mode != GL_MODELVIEW && mode != GL_PROJECTION && mode != GL_TEXTURE)
      fail(GL_INVALID_ENUM, "no such stack");
    s.now.matrixMode = mode;
  });
}
void rtglPushMatrix(void) {
  listed("glPushMatrix", [](State& s) {
    if (s.stack().size() >= maxDepth) fail(GL_STACK_OVERFLOW, "the stack is full");
    s.stack().push_back(Matrix(s.top()));
  });
}
void rtglPopMatrix(void) {
  listed("glPopMatrix", [](State& s) {
    if (s.stack().size() == 1) fail(GL_STACK_UNDERFLOW, "glPushMatrix is missing");
    s.stack().pop_back();
  });
}
void rtglLoadIdentity(void) {
  listed("glLoadIdentity", [](State& s) { s.top() = identity; });
}
void rtglLoadMatrixd(const GLdouble* m) { load("glLoadMatrix", m); }
void rtglLoadMatrixf(const GLfloat* m) { load("glLoadMatrix", m); }
void rtglMultMatrixd(const GLdouble* m) { multiplyBy("glMultMatrix", m); }
void rtglMultMatrixf(const GLfloat* m) { multiplyBy("glMultMatrix", m); }
void rtglTranslated(GLdouble x, GLdouble y, GLdouble z) {
  multiply("glTranslate", translation(x, y, z));
}
void rtglTranslatef(GLfloat x, GLfloat y, GLfloat z) { rtglTranslated(x, y, z); }
void rtglScaled(GLdouble x, GLdouble y, GLdouble z) { multiply("glScale", scaling(x, y, z)); }
void rtglScalef(GLfloat x, GLfloat y, GLfloat z) { rtglScaled(x, y, z); }
void rtglRotated(GLdouble angle, GLdouble x, GLdouble y, GLdouble z) {
  multiply("glRotate", rotation(angle, x, y, z));
}
void rtglRotatef(GLfloat angle, GLfloat x, GLfloat y, GLfloat z) { rtglRotated(angle, x, y, z); }
void rtglFrustum(GLdouble l, GLdouble r, GLdouble b, GLdouble t, GLdouble n, GLdouble f) {
  guarded("glFrustum", [&](State&) {
    if (!(n > 0) || !(f > 0) || !isInterval(n, f) || !isInterval(l, r) || !isInterval(b, t))
      fail(GL_INVALID_VALUE, "the frustum is empty");
    multiply("glFrustum", frustum(l, r, b, t, n, f));
  });
}
void rtglOrtho(GLdouble l, GLdouble r, GLdouble b, GLdouble t, GLdouble n, GLdouble f) {
  guarded("glOrtho", [&](State&) {
    if (!isInterval(n, f) || !isInterval(l, r) || !isInterval(b, t))
      fail(GL_INVALID_VALUE, "the box is empty");
    multiply("glOrtho", ortho(l, r, b, t, n, f));
  });
}
void rtglViewport(GLint x, GLint y, GLsizei width, GLsizei height) {
  listed("glViewport", [=](State& s) {
    if (width < 0 || height < 0) fail(GL_INVALID_VALUE, "a size is below 0");
    const GLsizei w = std::min(width, maxViewportSide), h = std::min(height, maxViewportSide);
    if (int64_t(w) * h > maxPixels)
      fail(GL_INVALID_VALUE, "a picture has at most " + std::to_string(maxPixels) + " pixels");
    s.now.viewport = {x, y, w, h};
  });
}
// Depths are distances here.
void rtglDepthRange(GLclampd, GLclampd) {}

GLuint rtglGenLists(GLsizei range) {
  GLuint first = 0;
  guarded("glGenLists", [&](State& s) {
    if (range < 0) fail(GL_INVALID_VALUE, "the number is below 0");
    if (range == 0) return;
    const auto count = static_cast<GLuint>(range);
    const GLuint unused = unusedNames(s.lists, count);
    for (GLuint i = 0; i < count; i++) s.lists[unused + i] = std::make_shared<List>();
    first = unused;
  });
  return first;
}
void rtglDeleteLists(GLuint first, GLsizei range) {
  guarded("glDeleteLists", [&](State& s) {
    if (range < 0) fail(GL_INVALID_VALUE, "the number is below 0");
    const auto count = static_cast<GLuint>(range);
    const bool wraps = first + count < first; // all from the first name on
    s.lists.erase(s.lists.lower_bound(first),
                  wraps ? s.lists.end() : s.lists.lower_bound(first + count));
  });
}
GLboolean rtglIsList(GLuint list) {
  bool is = false;
  guarded("glIsList", [&](State& s) { is = s.lists.count(list) != 0; });
  return is;
}
void rtglNewList(GLuint list, GLenum mode) {
  guarded("glNewList", [&](State& s) { s.newList(list, mode); });
}
void rtglEndList(void) {
  guarded("glEndList", [](State& s) { s.endList(); });
}
void rtglCallList(GLuint list) {
  guarded("glCallList", [](State& s) { s.unroll(); });
  listed("glCallList", [list](State& s) { s.callList(list); });
}
void rtglCallLists(GLsizei n, GLenum type, const GLvoid* lists) {
  guarded("glCallLists", [&](State& state) {
    state.unroll();
    if (n < 0) fail(GL_INVALID_VALUE, "the number is below 0");
    std::vector<GLuint> names;
    for (size_t i = 0; i < static_cast<size_t>(n); i++) names.push_back(nameAt(type, lists, i));
    listed("glCallLists", [names](State& s) {
      const GLuint base = s.now.listBase;
      for (GLuint name : names) s.callList(base + name);
    });
  });
}
void rtglListBase(GLuint base) {
  listed("glListBase", [base](State& s) { s.now.listBase = base; });
}
