// shapes.cpp: Draws the round solids of rtut, and the cube.
#include <array>
#include <cmath>
#include <numbers>

#include "openrt/rtut.h"
#include "rtut/messages.h"

namespace {

constexpr double mostFacets = 1 << 23; // as quadrics have at most

void sphere(GLenum style, double radius, int slices, int stacks) {
  RTUquadric* quadric = rtuNewQuadric();
  if (!quadric) return;
  rtuQuadricDrawStyle(quadric, style);
  rtuSphere(quadric, radius, slices, stacks);
  rtuDeleteQuadric(quadric);
}

// Calls face(normal, corners) for each face of a cube; corners are counter-clockwise.
template <class Face> void cube(double size, const Face& face) {
  using Place = std::array<double, 3>;
  const double h = size / 2;
  for (size_t axis = 0; axis < 3; axis++)
    for (double side : {-1.0, 1.0}) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      Place normal = {0, 0, 0};
      normal[axis] = side;
      std::array<Place, 4> corners;
      for (size_t k = 0; k < 4; k++) {
        const double a = k == 1 || k == 2 ? h : -h, b = k >= 2 ? h : -h;
        corners[k][axis] = side * h;
        corners[k][u] = side * a; // the other way round on the far side
        corners[k][v] = b;
      }
      face(normal, corners);
    }
}

// Writes a point and the normal of a torus about the z axis.
void torusPoint(double inner, double outer, double around, double along) {
  const double r = std::cos(along), x = std::cos(around), y = std::sin(around);
  rtglNormal3d(r * x, r * y, std::sin(along));
  rtglVertex3d((outer + inner * r) * x, (outer + inner * r) * y, inner * std::sin(along));
}

bool isTorus(int sides, int rings) {
  if (static_cast<double>(sides) * rings <= mostFacets) return true;
  rtut::complain("a torus has at most 8388608 facets: sides times rings");
  return false;
}

void cone(GLenum style, double base, double height, int slices, int stacks) {
  RTUquadric* quadric = rtuNewQuadric();
  if (!quadric) return;
  rtuQuadricDrawStyle(quadric, style);
  rtuCylinder(quadric, base, 0, height, slices, stacks);
  rtuQuadricOrientation(quadric, RTU_INSIDE); // the bottom is seen from below
  if (style == RTU_FILL) rtuDisk(quadric, 0, base, slices, 1);
  rtuDeleteQuadric(quadric);
}

} // namespace

void rtutSolidSphere(GLdouble radius, GLint slices, GLint stacks) {
  sphere(RTU_FILL, radius, slices, stacks);
}
void rtutWireSphere(GLdouble radius, GLint slices, GLint stacks) {
  sphere(RTU_LINE, radius, slices, stacks);
}

void rtutSolidCube(GLdouble size) {
  rtglBegin(GL_QUADS);
  cube(size, [](const auto& normal, const auto& corners) {
    rtglNormal3dv(normal.data());
    for (const auto& corner : corners) rtglVertex3dv(corner.data());
  });
  rtglEnd();
}
void rtutWireCube(GLdouble size) {
  cube(size, [](const auto& normal, const auto& corners) {
    rtglBegin(GL_LINE_LOOP);
    rtglNormal3dv(normal.data());
    for (const auto& corner : corners) rtglVertex3dv(corner.data());
    rtglEnd();
  });
}

void rtutSolidTorus(GLdouble inner, GLdouble outer, GLint sides, GLint rings) {
  if (!isTorus(sides, rings)) return;
  const double step = 2 * std::numbers::pi / rings, turn = 2 * std::numbers::pi / sides;
  rtglBegin(GL_QUADS);
  for (int i = 0; i < rings; i++)
    for (int k = 0; k < sides; k++) {
      torusPoint(inner, outer, i * step, k * turn);
      torusPoint(inner, outer, (i + 1) * step, k * turn);
      torusPoint(inner, outer, (i + 1) * step, (k + 1) * turn);
      torusPoint(inner, outer, i * step, (k + 1) * turn);
    }
  rtglEnd();
}
void rtutWireTorus(GLdouble inner, GLdouble outer, GLint sides, GLint rings) {
  if (!isTorus(sides, rings)) return;
  const double step = 2 * std::numbers::pi / rings, turn = 2 * std::numbers::pi / sides;
  for (int i = 0; i < rings; i++) {
    rtglBegin(GL_LINE_LOOP);
    for (int k = 0; k < sides; k++) torusPoint(inner, outer, i * step, k * turn);
    rtglEnd();
  }
  for (int k = 0; k < sides; k++) {
    rtglBegin(GL_LINE_LOOP);
    for (int i = 0; i < rings; i++) torusPoint(inner, outer, i * step, k * turn);
    rtglEnd();
  }
}

void rtutSolidCone(GLdouble base, GLdouble height, GLint slices, GLint stacks) {
  cone(RTU_FILL, base, height, slices, stacks);
}
void rtutWireCone(GLdouble base, GLdouble height, GLint slices, GLint stacks) {
  cone(RTU_LINE, base, height, slices, stacks);
}
