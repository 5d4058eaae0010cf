// shapes.cpp: Draws the solids of rtut.
#include <array>
#include <cmath>
#include <numbers>

#include "openrt/rtut.h"

namespace {

void sphere(GLenum style, double radius, int slices, int stacks) {
  RTUquadric* quadric = rtuNewQuadric();
  if (!quadric) return;
  rtuQuadricDrawStyle(quadric, style);
  rtuSphere(quadric, radius, slices, stacks);
  rtuDeleteQuadric(quadric);
}

// Places and normals of a torus about the z axis.
void torusPoint(double inner, double outer, double around, double along) {
  const double r = std::cos(along), x = std::cos(around), y = std::sin(around);
  rtglNormal3d(r * x, r * y, std::sin(along));
  rtglVertex3d((outer + inner * r) * x, (outer + inner * r) * y, inner * std::sin(along));
}

} // namespace

void rtutSolidSphere(GLdouble radius, GLint slices, GLint stacks) {
  sphere(RTU_FILL, radius, slices, stacks);
}
void rtutWireSphere(GLdouble radius, GLint slices, GLint stacks) {
  sphere(RTU_LINE, radius, slices, stacks);
}

void rtutSolidCube(GLdouble size) {
  const double h = size / 2;
  rtglBegin(GL_QUADS);
  for (size_t axis = 0; axis < 3; axis++)
    for (double side : {-1.0, 1.0}) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<double, 3> normal = {0, 0, 0};
      normal[axis] = side;
      rtglNormal3dv(normal.data());
      for (int k = 0; k < 4; k++) {
        const double a = k == 1 || k == 2 ? h : -h, b = k >= 2 ? h : -h;
        std::array<double, 3> at;
        at[axis] = side * h;
        at[u] = side * a; // the other way round on the far side
        at[v] = b;
        rtglVertex3dv(at.data());
      }
    }
  rtglEnd();
}

void rtutSolidTorus(GLdouble inner, GLdouble outer, GLint sides, GLint rings) {
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

void rtutSolidCone(GLdouble base, GLdouble height, GLint slices, GLint stacks) {
  RTUquadric* quadric = rtuNewQuadric();
  if (!quadric) return;
  rtuCylinder(quadric, base, 0, height, slices, stacks);
  rtuQuadricOrientation(quadric, RTU_INSIDE); // the bottom is seen from below
  rtuDisk(quadric, 0, base, slices, 1);
  rtuDeleteQuadric(quadric);
}
