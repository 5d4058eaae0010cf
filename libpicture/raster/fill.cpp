#include "libpicture/raster/fill.h"

#include <utility>

namespace picture::raster {

namespace {

// The cross product of two corners: the edge from one to the other.
Edge between(const Corner& u, const Corner& v) {
  return {double(u.hy) * v.w - double(v.hy) * u.w, double(v.hx) * u.w - double(u.hx) * v.w,
          double(u.hx) * v.hy - double(v.hx) * u.hy};
}

// Six times the volume that the corners span with the eye. It is negative if they are
// counter-clockwise in the picture, whose y points down.
double determinant(const Corner corners[3]) {
  const Edge edge = between(corners[1], corners[2]);
  return edge.a * corners[0].hx + edge.b * corners[0].hy + edge.c * corners[0].w;
}

template <class Value> bool allOf(const Corner corners[3], const Value& value) {
  return value(corners[0]) && value(corners[1]) && value(corners[2]);
}

// Finds the first and the last pixel whose centre lies between two places, which may be wrong by
// rounding.
void pixelsBetween(double low, double high, int size, int& first, int& last) {
  constexpr double rounding = 1e-6;
  first = int(std::clamp(std::ceil(low - 0.5 - rounding), 0.0, double(size)));
  last = int(std::clamp(std::floor(high - 0.5 + rounding), -1.0, size - 1.0));
}

} // namespace

PixelBox Triangle::box(const Corner corners[3], int width, int height) {
  if (!allOf(corners, [](const Corner& c) { return c.isFinite(); })) return {};
  if (!allOf(corners, [](const Corner& c) { return c.w > 0; })) {
    const double w = width, h = height;
    const bool outside = allOf(corners, [](const Corner& c) { return c.w <= 0; }) ||
                         allOf(corners, [](const Corner& c) { return c.hx < 0; }) ||
                         allOf(corners, [](const Corner& c) { return c.hy < 0; }) ||
                         allOf(corners, [&](const Corner& c) { return c.hx > w * c.w; }) ||
                         allOf(corners, [&](const Corner& c) { return c.hy > h * c.w; });
    return outside || determinant(corners) == 0 ? PixelBox{}
                                                : PixelBox{0, width - 1, 0, height - 1};
  }
  const double x[3] = {double(corners[0].hx) / corners[0].w, double(corners[1].hx) / corners[1].w,
                       double(corners[2].hx) / corners[2].w};
  const double y[3] = {double(corners[0].hy) / corners[0].w, double(corners[1].hy) / corners[1].w,
                       double(corners[2].hy) / corners[2].w};
  PixelBox box;
  pixelsBetween(std::min({x[0], x[1], x[2]}), std::max({x[0], x[1], x[2]}), width, box.left,
                box.right);
  if (box.left > box.right) return {};
  pixelsBetween(std::min({y[0], y[1], y[2]}), std::max({y[0], y[1], y[2]}), height, box.top,
                box.bottom);
  return box.empty() || determinant(corners) == 0 ? PixelBox{} : box;
}

bool Triangle::facesEye(const Corner corners[3]) { return determinant(corners) < 0; }

Triangle::Triangle(const Corner corners[3], double nearest) : nearest_(nearest) {
  const double volume = determinant(corners), sign = volume < 0 ? -1 : 1;
  farthest_ = INFINITY;
  closest_ = -INFINITY;
  for (int i = 0; i < 3; ++i) {
    const Corner& corner = corners[i];
    Edge& edge = edges_[i];
    edge = between(corners[(i + 1) % 3], corners[(i + 2) % 3]);
    edge = {edge.a * sign, edge.b * sign, edge.c * sign};
    // The weights of the corners are the edges' values, divided by the volume.
    const double share = corner.d / std::abs(volume);
    depth_.a += edge.a * share;
    depth_.b += edge.b * share;
    depth_.c += edge.c * share;
    const double d = corner.w > 0 ? double(corner.d) / corner.w : INFINITY;
    farthest_ = std::min(farthest_, d);
    closest_ = std::max(closest_, d);
  }
}

std::optional<Segment> clipped(const Corner ends[2], double nearest, int width, int height) {
  if (!ends[0].isFinite() || !ends[1].isFinite()) return {};
  double from = 0, to = 1; // the part that is kept
  // Keeps where a value that is linear along the line is positive, or 0.
  const auto keep = [&](double first, double last) {
    if (first < 0 && last < 0) to = -1;
    const double cut = first / (first - last);
    if (first < 0) from = std::max(from, cut);
    if (last < 0) to = std::min(to, cut);
  };
  const double least = 1e-6 * std::max(std::abs(ends[0].w), std::abs(ends[1].w));
  const auto along = [&](float Corner::*value) {
    return std::pair<double, double>(ends[0].*value, ends[1].*value);
  };
  const auto [w0, w1] = along(&Corner::w);
  const auto [x0, x1] = along(&Corner::hx);
  const auto [y0, y1] = along(&Corner::hy);
  const auto [d0, d1] = along(&Corner::d);
  keep(w0 - least, w1 - least);
  keep(nearest * w0 - d0, nearest * w1 - d1);
  keep(x0, x1);
  keep(y0, y1);
  keep(width * w0 - x0, width * w1 - x1);
  keep(height * w0 - y0, height * w1 - y1);
  if (!(from <= to)) return {};
  Segment segment;
  const double t[2] = {from, to};
  for (int i = 0; i < 2; ++i) {
    const auto at = [&](double first, double last) { return first + t[i] * (last - first); };
    const double w = at(w0, w1);
    if (!(w > 0)) return {};
    segment.w[i] = w;
    segment.x[i] = std::clamp(at(x0, x1) / w, 0.0, double(width));
    segment.y[i] = std::clamp(at(y0, y1) / w, 0.0, double(height));
    segment.d[i] = at(d0, d1) / w;
    segment.t[i] = t[i];
  }
  return segment;
}

} // namespace picture::raster
