// polyhedra.cpp: Draws the regular polyhedra of rtut, in the sizes and places of freeglut.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "openrt/rtut.h"
#include "rtut/messages.h"

namespace {

using Place = std::array<double, 3>;
using Places = std::vector<Place>;

double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Draws the face that lies farthest along a direction: polygons if mode is GL_POLYGON, else
// outlines (GL_LINE_LOOP).
void drawFace(const Places& points, const Place& direction, GLenum mode) {
  const double length = std::sqrt(dot(direction, direction));
  const Place normal = {direction[0] / length, direction[1] / length, direction[2] / length};
  double farthest = 0;
  for (const Place& p : points) farthest = std::max(farthest, dot(p, normal));
  Places corners;
  for (const Place& p : points)
    if (dot(p, normal) > farthest - 1e-6) corners.push_back(p);
  // The corners are sorted by their angle about the normal.
  const Place right = corners.front(), up = cross(normal, right);
  const double height = dot(right, normal);
  const auto angle = [&](const Place& p) {
    return std::atan2(dot(p, up), dot(p, right) - height * dot(p, normal));
  };
  std::sort(corners.begin(), corners.end(),
            [&](const Place& a, const Place& b) { return angle(a) < angle(b); });
  rtglBegin(mode);
  rtglNormal3dv(normal.data());
  for (const Place& corner : corners) rtglVertex3dv(corner.data());
  rtglEnd();
}

// Draws a solid whose faces are triangles between points that are `edge` apart.
void drawOfTriangles(const Places& points, double edge, GLenum mode) {
  const auto joined = [&](const Place& a, const Place& b) {
    const Place way = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return std::abs(dot(way, way) - edge * edge) < 1e-6;
  };
  for (size_t i = 0; i < points.size(); i++)
    for (size_t j = 0; j < i; j++)
      for (size_t k = 0; k < j; k++) {
        const Place &a = points[i], &b = points[j], &c = points[k];
        if (joined(a, b) && joined(b, c) && joined(c, a))
          drawFace(points, {a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]}, mode);
      }
}

// Returns the points 0 +-a +-b and those with the coordinates in the two other orders.
Places inThreePlanes(double a, double b) {
  Places points;
  for (size_t axis = 0; axis < 3; axis++)
    for (const double x : {a, -a})
      for (const double y : {b, -b}) {
        Place p = {0, 0, 0};
        p[(axis + 1) % 3] = x;
        p[(axis + 2) % 3] = y;
        points.push_back(p);
      }
  return points;
}

void tetrahedron(GLenum mode) {
  const double third = 1.0 / 3, wide = std::sqrt(8.0) / 3, half = wide / 2;
  const double side = std::sqrt(2.0 / 3);
  drawOfTriangles({{1, 0, 0}, {-third, wide, 0}, {-third, -half, side}, {-third, -half, -side}},
                  std::sqrt(8.0 / 3), mode);
}

void octahedron(GLenum mode) {
  drawOfTriangles({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                  std::numbers::sqrt2, mode);
}

// The points are two on the x axis, and a ring of five near each.
void icosahedron(GLenum mode) {
  const double high = 1 / std::sqrt(5.0), radius = 2 * high;
  Places points = {{1, 0, 0}, {-1, 0, 0}};
  for (int i = 0; i < 5; i++) {
    const double angle = i * 2 * std::numbers::pi / 5;
    const double y = radius * std::cos(angle), z = radius * std::sin(angle);
    points.push_back({high, y, z});
    points.push_back({-high, -y, -z});
  }
  drawOfTriangles(points, std::sqrt(2 - radius), mode);
}

void dodecahedron(GLenum mode) {
  const double golden = std::numbers::phi;
  Places points = inThreePlanes(golden, 1 / golden);
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0}) points.push_back({x, y, z});
  for (const Place& direction : inThreePlanes(1, golden)) drawFace(points, direction, mode);
}

void draw(void (*solid)(GLenum mode), GLenum mode) {
  rtut::guarded("a polyhedron", [=] { solid(mode); });
}

} // namespace

void rtutSolidTetrahedron(void) { draw(tetrahedron, GL_POLYGON); }
void rtutWireTetrahedron(void) { draw(tetrahedron, GL_LINE_LOOP); }
void rtutSolidOctahedron(void) { draw(octahedron, GL_POLYGON); }
void rtutWireOctahedron(void) { draw(octahedron, GL_LINE_LOOP); }
void rtutSolidDodecahedron(void) { draw(dodecahedron, GL_POLYGON); }
void rtutWireDodecahedron(void) { draw(dodecahedron, GL_LINE_LOOP); }
void rtutSolidIcosahedron(void) { draw(icosahedron, GL_POLYGON); }
void rtutWireIcosahedron(void) { draw(icosahedron, GL_LINE_LOOP); }
