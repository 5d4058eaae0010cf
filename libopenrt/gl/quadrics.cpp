// quadrics.cpp: Implements spheres, cylinders and disks of GLU, with its facets and texture
// coordinates.
#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <utility>

#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

struct RTUquadric_ {
  GLenum style = RTU_FILL, normals = RTU_SMOOTH, orientation = RTU_OUTSIDE;
  bool texture = false;
};

namespace {

// A point of a surface: its place, the normal outside, and texture coordinates.
struct Point {
  Vector at, normal;
  double s, t;
};

void emit(const RTUquadric& q, const Point& p, const Vector& normal) {
  const double side = q.orientation == RTU_INSIDE ? -1 : 1;
  if (q.normals != RTU_NONE) rtglNormal3d(side * normal[0], side * normal[1], side * normal[2]);
  if (q.texture) rtglTexCoord2d(p.s, p.t);
  rtglVertex3d(p.at[0], p.at[1], p.at[2]);
}

// The edges of a grid within one plane, which GLU_SILHOUETTE leaves out.
enum class Plane {
  none,  // a sphere has no such edges
  rings, // between the rows of a cylinder
  disk,  // all but the first and the last ring
  sector // all but the first and the last ring and column
};

// Draws a grid of columns x rows facets. at(column, row) returns a point; columns run
// counter-clockwise and rows upwards, seen from outside.
template <class At>
void grid(const RTUquadric& q, Plane plane, int columns, int rows, const At& at) {
  if (q.style == RTU_POINT) {
    rtglBegin(GL_POINTS);
    for (int row = 0; row <= rows; row++)
      for (int column = 0; column < columns; column++) {
        const Point p = at(column, row);
        emit(q, p, p.normal);
      }
    rtglEnd();
    return;
  }
  if (q.style != RTU_FILL) {
    if (q.style != RTU_SILHOUETTE) plane = Plane::none;
    for (int row = 0; row <= rows; row++) {
      if (plane != Plane::none && row > 0 && row < rows) continue;
      rtglBegin(GL_LINE_STRIP);
      for (int column = 0; column <= columns; column++) {
        const Point p = at(column, row);
        emit(q, p, p.normal);
      }
      rtglEnd();
    }
    for (int column = 0; column <= columns; column++) {
      const bool ends = column == 0 || column == columns;
      if (plane == Plane::disk || (plane == Plane::sector && !ends)) continue;
      rtglBegin(GL_LINE_STRIP);
      for (int row = 0; row <= rows; row++) {
        const Point p = at(column, row);
        emit(q, p, p.normal);
      }
      rtglEnd();
    }
    return;
  }
  rtglBegin(GL_QUADS);
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < columns; column++) {
      Point corners[4] = {at(column, row), at(column + 1, row), at(column + 1, row + 1),
                          at(column, row + 1)};
      if (q.orientation == RTU_INSIDE) std::swap(corners[1], corners[3]);
      if (row + 1 == rows) // the provoking vertex of GLU at the upper end, which may be a pole
        std::rotate(corners, corners + 2, corners + 4);
      Vector sum = {0, 0, 0};
      for (const Point& p : corners)
        for (size_t c = 0; c < 3; c++) sum[c] += p.normal[c];
      for (const Point& p : corners) emit(q, p, q.normals == RTU_FLAT ? unit(sum) : p.normal);
    }
  rtglEnd();
}

double turn(int i, int count, double degrees = 360) {
  return i * degrees / count * (std::numbers::pi / 180);
}

constexpr int64_t maxFacets = maxVertices / 4;

bool isShape(const RTUquadric* q, int slices, int stacks) {
  bool is = false;
  guarded("a quadric", [&](State&) {
    if (!q || slices < 2 || stacks < 1)
      fail(GL_INVALID_VALUE, "a number is too small, or the quadric is NULL");
    if (int64_t(slices) * stacks > maxFacets)
      fail(GL_OUT_OF_MEMORY, "a quadric has at most " + std::to_string(maxFacets) + " facets");
    is = true;
  });
  return is;
}

} // namespace

RTUquadric* rtuNewQuadric(void) { return new (std::nothrow) RTUquadric; }
void rtuDeleteQuadric(RTUquadric* q) { delete q; }
// rtuNewQuadric() returns NULL if memory has run out.
void rtuQuadricDrawStyle(RTUquadric* q, GLenum style) {
  if (q) q->style = style;
}
void rtuQuadricNormals(RTUquadric* q, GLenum normals) {
  if (q) q->normals = normals;
}
void rtuQuadricOrientation(RTUquadric* q, GLenum orientation) {
  if (q) q->orientation = orientation;
}
void rtuQuadricTexture(RTUquadric* q, GLboolean texture) {
  if (q) q->texture = texture != 0;
}

void rtuSphere(RTUquadric* q, GLdouble radius, GLint slices, GLint stacks) {
  if (!isShape(q, slices, stacks)) return;
  grid(*q, Plane::none, slices, stacks, [=](int column, int row) {
    // Slices begin at the y axis, as in GLU.
    const double around = turn(column, slices), up = turn(row, stacks, 180);
    const Vector n = {-std::sin(around) * std::sin(up), std::cos(around) * std::sin(up),
                      -std::cos(up)};
    return Point{radius * n, n, double(column) / slices, double(row) / stacks};
  });
}

void rtuCylinder(RTUquadric* q, GLdouble base, GLdouble top, GLdouble height, GLint slices,
                 GLint stacks) {
  if (!isShape(q, slices, stacks)) return;
  grid(*q, Plane::rings, slices, stacks, [=](int column, int row) {
    const double around = turn(column, slices), share = double(row) / stacks;
    const double radius = base + share * (top - base);
    const double x = -std::sin(around), y = std::cos(around);
    return Point{{radius * x, radius * y, share * height},
                 unit({height * x, height * y, base - top}),
                 double(column) / slices,
                 share};
  });
}

void rtuPartialDisk(RTUquadric* q, GLdouble inner, GLdouble outer, GLint slices, GLint loops,
                    GLdouble start, GLdouble sweep) {
  if (!isShape(q, slices, loops)) return;
  const double first = start * (std::numbers::pi / 180);
  // Angles run clockwise from the y axis; the facets run the other way, so that +z is the front.
  const Plane plane = std::abs(sweep) >= 360 ? Plane::disk : Plane::sector;
  grid(*q, plane, slices, loops, [=](int column, int row) {
    const double radius = inner + (outer - inner) * (loops - row) / loops;
    const double angle = first + turn(slices - column, slices, sweep);
    const double x = radius * std::sin(angle), y = radius * std::cos(angle);
    return Point{{x, y, 0}, {0, 0, 1}, x / outer / 2 + 0.5, y / outer / 2 + 0.5};
  });
}

void rtuDisk(RTUquadric* q, GLdouble inner, GLdouble outer, GLint slices, GLint loops) {
  rtuPartialDisk(q, inner, outer, slices, loops, 0, 360);
}
