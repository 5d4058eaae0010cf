// teapot.cpp: Draws the teapot that M. Newell modelled in 1975: 32 bicubic Bezier patches, in the
// size and place of freeglut's.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "openrt/rtut.h"

namespace {

constexpr int cells = 10;        // a side of a patch
constexpr double middle = 1.575; // half the height of the teapot

using Place = std::array<double, 3>;
using Patch = std::array<std::array<Place, 4>, 4>;

// An outline that turns about the z axis: radius and height of four control points, from the top
// to the bottom.
struct Outline {
  double radius[4], height[4];
};
constexpr Outline outlines[] = {
    {{0, 0.8, 0, 0.2}, {3.15, 3.15, 2.85, 2.7}},                // knob of the lid
    {{0.2, 0.4, 1.3, 1.3}, {2.7, 2.55, 2.55, 2.4}},             // lid
    {{1.4, 1.3375, 1.4375, 1.5}, {2.4, 2.53125, 2.53125, 2.4}}, // rim
    {{1.5, 1.75, 2, 2}, {2.4, 1.875, 1.35, 0.9}},               // body
    {{2, 2, 1.5, 1.5}, {0.9, 0.45, 0.225, 0.15}},               // body
    {{1.5, 1.5, 1.425, 0}, {0.15, 0.075, 0, 0}},                // bottom
};

// A bent tube that is the same on both sides of the plane y = 0: x and z of its two edges in that
// plane, and how far it reaches from the plane, for four control points along it.
struct Tube {
  double x[4], z[4], otherX[4], otherZ[4], reach[4];
};
constexpr Tube tubes[] = {
    // handle
    {{-1.6, -2.3, -2.7, -2.7},
     {2.025, 2.025, 2.025, 1.8},
     {-1.5, -2.5, -3, -3},
     {2.25, 2.25, 2.25, 1.8},
     {0.3, 0.3, 0.3, 0.3}},
    {{-2.7, -2.7, -2.5, -2},
     {1.8, 1.575, 1.125, 0.9},
     {-3, -3, -2.65, -1.9},
     {1.8, 1.35, 0.9375, 0.6},
     {0.3, 0.3, 0.3, 0.3}},
    // spout
    {{1.7, 2.6, 2.3, 2.7},
     {1.425, 1.425, 2.1, 2.4},
     {1.7, 3.1, 2.4, 3.3},
     {0.6, 0.825, 2.025, 2.4},
     {0.66, 0.66, 0.25, 0.25}},
    {{2.7, 2.8, 2.9, 2.8},
     {2.4, 2.475, 2.475, 2.4},
     {3.3, 3.525, 3.45, 3.2},
     {2.4, 2.49375, 2.5125, 2.4},
     {0.25, 0.25, 0.15, 0.15}},
};

// Control points run along the outline or tube, and counter-clockwise to them seen from outside.
std::vector<Patch> makePatches() {
  constexpr double arc = 0.56; // the distance of control points that makes quarters of circles
  constexpr double x[4] = {1, 1, arc, 0}, y[4] = {0, -arc, -1, -1};
  std::vector<Patch> patches;
  for (const Outline& outline : outlines)
    for (int quarter = 0; quarter < 4; quarter++) {
      Patch patch;
      for (size_t v = 0; v < 4; v++)
        for (size_t u = 0; u < 4; u++) {
          const double r = outline.radius[v], px = r * x[u], py = r * y[u], z = outline.height[v];
          const Place turned[4] = {{px, py, z}, {py, -px, z}, {-px, -py, z}, {-py, px, z}};
          patch[v][u] = turned[quarter];
        }
      patches.push_back(patch);
    }
  for (const Tube& tube : tubes)
    for (const double side : {-1.0, 1.0}) {
      Patch patch;
      for (size_t v = 0; v < 4; v++)
        for (size_t u = 0; u < 4; u++) {
          const bool other = (u >= 2) == (side < 0), inPlane = u == 0 || u == 3;
          patch[v][u] = {other ? tube.otherX[v] : tube.x[v], inPlane ? 0 : side * tube.reach[v],
                         other ? tube.otherZ[v] : tube.z[v]};
        }
      patches.push_back(patch);
    }
  return patches;
}

// Returns the four weights of the control points of a cubic Bezier curve, or of its derivative.
std::array<double, 4> weightsAt(double t, bool derivative) {
  const double s = 1 - t;
  if (derivative) return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

Place sum(const Patch& patch, const std::array<double, 4>& u, const std::array<double, 4>& v) {
  Place at = {0, 0, 0};
  for (size_t i = 0; i < 4; i++)
    for (size_t j = 0; j < 4; j++)
      for (size_t c = 0; c < 3; c++) at[c] += v[i] * u[j] * patch[i][j][c];
  return at;
}

// Writes the normal and the vertex of a patch at u, v. y is up in GLUT, and z in the patches.
void vertex(const Patch& patch, double u, double v, double scale) {
  const Place at = sum(patch, weightsAt(u, false), weightsAt(v, false));
  const double in = std::clamp(v, 1e-4, 1 - 1e-4); // an end of an outline may be a point
  const Place a = sum(patch, weightsAt(u, true), weightsAt(in, false)),
              b = sum(patch, weightsAt(u, false), weightsAt(in, true));
  const Place n = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  rtglNormal3d(n[0] / length, n[2] / length, -n[1] / length);
  rtglTexCoord2d(u, v);
  rtglVertex3d(scale * at[0], scale * (at[2] - middle), -scale * at[1]);
}

void solid(const Patch& patch, double scale) {
  const auto at = [&](int i, int j) {
    vertex(patch, static_cast<double>(i) / cells, static_cast<double>(j) / cells, scale);
  };
  for (int j = 0; j < cells; j++)
    for (int i = 0; i < cells; i++) {
      at(i, j);
      at(i + 1, j);
      at(i + 1, j + 1);
      at(i, j + 1);
    }
}

void wires(const Patch& patch, double scale) {
  for (const bool along : {false, true})
    for (int i = 0; i <= cells; i++) {
      rtglBegin(GL_LINE_STRIP);
      for (int j = 0; j <= cells; j++) {
        const double a = static_cast<double>(i) / cells, b = static_cast<double>(j) / cells;
        vertex(patch, along ? a : b, along ? b : a, scale);
      }
      rtglEnd();
    }
}

} // namespace

void rtutSolidTeapot(GLdouble size) {
  rtglBegin(GL_QUADS);
  for (const Patch& patch : makePatches()) solid(patch, size / 2);
  rtglEnd();
}
void rtutWireTeapot(GLdouble size) {
  for (const Patch& patch : makePatches()) wires(patch, size / 2);
}
