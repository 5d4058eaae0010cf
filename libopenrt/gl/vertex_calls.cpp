// vertex_calls.cpp: Implements the calls between glBegin and glEnd in all their variants.
#include <limits>
#include <type_traits>

#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

// Returns a component of a colour or normal: the range of an integer type stands for 0 .. 1, or
// for -1 .. 1 if it is signed (OpenGL 1.1, table 2.6).
template <class T> float component(T value) {
  if constexpr (std::is_floating_point_v<T>)
    return static_cast<float>(value);
  else if constexpr (std::is_unsigned_v<T>)
    return static_cast<float>(static_cast<double>(value) / std::numeric_limits<T>::max());
  else
    return static_cast<float>((2.0 * static_cast<double>(value) + 1) /
                              (2.0 * std::numeric_limits<T>::max() + 1));
}

template <class T> void vertex(T x, T y, T z = 0, T w = 1) {
  guarded("glVertex", [&](State& s) {
    const double scale = w == 1 || w == 0 ? 1.0 : 1.0 / static_cast<double>(w);
    s.vertex(static_cast<float>(static_cast<double>(x) * scale),
             static_cast<float>(static_cast<double>(y) * scale),
             static_cast<float>(static_cast<double>(z) * scale));
  });
}
template <class T> void normal(T x, T y, T z) {
  guarded("glNormal", [&](State& s) { s.setNormal(component(x), component(y), component(z)); });
}
template <class T> void color(T r, T g, T b) {
  guarded("glColor", [&](State& s) {
    s.setColor({component(r), component(g), component(b), 1.0f});
  });
}
template <class T> void color(T r, T g, T b, T a) {
  guarded("glColor", [&](State& s) {
    s.setColor({component(r), component(g), component(b), component(a)});
  });
}
template <class T> void texCoord(T s, T t = 0, T = 0, T q = 1) {
  guarded("glTexCoord", [&](State& state) {
    const double scale = q == 1 || q == 0 ? 1.0 : 1.0 / static_cast<double>(q);
    state.setTexCoord(static_cast<float>(static_cast<double>(s) * scale),
                      static_cast<float>(static_cast<double>(t) * scale));
  });
}
template <class T> void rectangle(T x1, T y1, T x2, T y2) {
  rtglBegin(GL_POLYGON);
  vertex(x1, y1);
  vertex(x2, y1);
  vertex(x2, y2);
  vertex(x1, y2);
  rtglEnd();
}

} // namespace

void rtglBegin(GLenum mode) {
  guarded("glBegin", [&](State& s) { s.begin(mode); });
}
void rtglEnd(void) {
  guarded("glEnd", [&](State& s) { s.end(); });
}
// Edges are drawn by glPolygonMode without exception.
void rtglEdgeFlag(GLboolean) {}
void rtglEdgeFlagv(const GLboolean*) {}

// Each macro defines the functions of one number of components: by values and by pointer.
#define ONE(name, call, letter, Type)                                                              \
  void rtgl##name##1##letter(Type x) { call(x); }                                                  \
  void rtgl##name##1##letter##v(const Type* v) { call(v[0]); }
#define TWO(name, call, letter, Type)                                                              \
  void rtgl##name##2##letter(Type x, Type y) { call(x, y); }                                       \
  void rtgl##name##2##letter##v(const Type* v) { call(v[0], v[1]); }
#define THREE(name, call, letter, Type)                                                            \
  void rtgl##name##3##letter(Type x, Type y, Type z) { call(x, y, z); }                            \
  void rtgl##name##3##letter##v(const Type* v) { call(v[0], v[1], v[2]); }
#define FOUR(name, call, letter, Type)                                                             \
  void rtgl##name##4##letter(Type x, Type y, Type z, Type w) { call(x, y, z, w); }                 \
  void rtgl##name##4##letter##v(const Type* v) { call(v[0], v[1], v[2], v[3]); }
#define RECTANGLE(letter, Type)                                                                    \
  void rtglRect##letter(Type x1, Type y1, Type x2, Type y2) { rectangle(x1, y1, x2, y2); }         \
  void rtglRect##letter##v(const Type* v1, const Type* v2) {                                       \
    rectangle(v1[0], v1[1], v2[0], v2[1]);                                                         \
  }
#define FOUR_TYPES(count, name, call)                                                              \
  count(name, call, d, GLdouble) count(name, call, f, GLfloat) count(name, call, i, GLint)         \
      count(name, call, s, GLshort)

FOUR_TYPES(TWO, Vertex, vertex)
FOUR_TYPES(THREE, Vertex, vertex)
FOUR_TYPES(FOUR, Vertex, vertex)
FOUR_TYPES(THREE, Normal, normal)
THREE(Normal, normal, b, GLbyte)
FOUR_TYPES(THREE, Color, color)
THREE(Color, color, b, GLbyte)
THREE(Color, color, ub, GLubyte)
THREE(Color, color, us, GLushort)
THREE(Color, color, ui, GLuint)
FOUR_TYPES(FOUR, Color, color)
FOUR(Color, color, b, GLbyte)
FOUR(Color, color, ub, GLubyte)
FOUR(Color, color, us, GLushort)
FOUR(Color, color, ui, GLuint)
FOUR_TYPES(ONE, TexCoord, texCoord)
FOUR_TYPES(TWO, TexCoord, texCoord)
FOUR_TYPES(THREE, TexCoord, texCoord)
FOUR_TYPES(FOUR, TexCoord, texCoord)
RECTANGLE(d, GLdouble)
RECTANGLE(f, GLfloat)
RECTANGLE(i, GLint)
RECTANGLE(s, GLshort)
