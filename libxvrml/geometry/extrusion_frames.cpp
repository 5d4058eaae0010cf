// extrusion_frames.cpp: the axes of the spine-aligned cross-section planes by clauses 6.18.2 and
// 6.18.3. Coincident spine points share a frame, so the rules run over the distinct points only.
#include "geometry/extrusion_frames.h"

namespace xvrml {
namespace {

const V3d none(0, 0, 0);

// Rotates v by the shortest rotation from +y to `to`.
V3d rotateFromY(const V3d& to, const V3d& v) {
  V3d y(0, 1, 0), axis = y.cross(to);
  double cosine = y.dot(to);
  if (cosine < -1 + 1e-12) return {v.x, -v.y, -v.z}; // straight down: half a turn about x
  return v * cosine + axis.cross(v) + axis * (axis.dot(v) / (1 + cosine));
}

SpineFrame frame(const V3d& y, const V3d& z) {
  V3d x = unit(y.cross(z));
  if (x == none) { // z along y (z was copied from a distant point): the frame of a straight spine
    x = rotateFromY(y, {1, 0, 0});
  }
  return {x, y, unit(x.cross(y))};
}

// Computes y: from the previous to the next point, or along the end segment at an open end.
std::vector<V3d> yAxes(const std::vector<V3d>& p, bool closed) {
  size_t n = p.size();
  std::vector<V3d> axes(n);
  for (size_t i = 0; i < n; i++) {
    bool end = i == 0 || i == n - 1;
    if (end && closed)
      axes[i] = unit(p[1] - p[n - 2]);
    else
      axes[i] = unit(p[std::min(i + 1, n - 1)] - p[i ? i - 1 : 0]);
    // If the spine turns straight back, y continues along the segment before.
    if (axes[i] == none) axes[i] = i ? unit(p[i] - p[i - 1]) : unit(p[1] - p[0]);
  }
  return axes;
}

// Computes z: the normal of the plane of three successive points; zero if they are collinear.
std::vector<V3d> zAxes(const std::vector<V3d>& p, bool closed) {
  size_t n = p.size();
  auto cross = [](const V3d& a, const V3d& b) {
    V3d u = unit(a), v = unit(b), c = u.cross(v);
    return c.dot(c) > 1e-14 ? unit(c)
                            : none; // float coordinates on a line are rarely exactly collinear
  };
  std::vector<V3d> axes(n, none);
  for (size_t i = 1; i + 1 < n; i++) axes[i] = cross(p[i + 1] - p[i], p[i - 1] - p[i]);
  if (closed && n > 2) axes[0] = axes[n - 1] = cross(p[1] - p[0], p[n - 2] - p[0]);
  return axes;
}

} // namespace

std::vector<SpineFrame> spineFrames(std::span<const Vec3f> spine, bool closed) {
  std::vector<V3d> p;          // without repeated points
  std::vector<size_t> placeOf; // index into p of each spine point
  for (const Vec3f& point : spine) {
    V3d v = toV3d(point);
    if (p.empty() || v != p.back()) p.push_back(v);
    placeOf.push_back(p.size() - 1);
  }
  size_t n = p.size();
  if (n < 2)
    return std::vector<SpineFrame>(spine.size(),
                                   {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}); // a surface of revolution
  std::vector<V3d> y = yAxes(p, closed), z = zAxes(p, closed);

  size_t defined = 0;
  while (defined < n && z[defined] == none) defined++;
  std::vector<SpineFrame> frames(n);
  if (defined == n) { // all collinear: the xz plane rotated from +y to the line
    V3d along = unit(p[n - 1] - p[0]);
    if (along == none) along = unit(p[1] - p[0]);
    for (auto& f : frames)
      f = {rotateFromY(along, {1, 0, 0}), along, rotateFromY(along, {0, 0, 1})};
  } else {
    // An undefined z is copied from the previous point, or from the first point that has one.
    for (size_t i = 0; i < defined; i++) z[i] = z[defined];
    for (size_t i = defined; i < n; i++) {
      if (z[i] == none) z[i] = z[i - 1];
    }
    for (size_t i = 1; i < n; i++)
      if (z[i].dot(z[i - 1]) < 0) z[i] = -z[i]; // no flips where the spine bends the other way
    for (size_t i = 0; i < n; i++) frames[i] = frame(y[i], z[i]);
  }
  std::vector<SpineFrame> result;
  result.reserve(placeOf.size());
  for (size_t place : placeOf) result.push_back(frames[place]);
  return result;
}

} // namespace xvrml
