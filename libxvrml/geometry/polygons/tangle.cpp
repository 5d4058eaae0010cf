// tangle.cpp: estimates the cost of tessellating a polygon before it starts. Crossings are counted
// up to a budget by halving the plane until few edges are left. So a polygon built to have a
// billion of them is rejected.
#include <algorithm>
#include <cmath>

#include "geometry/polygons/tessellator.h"

namespace xvrml {
namespace {

struct Edge {
  V2d a, b;
};

double side(const V2d& a, const V2d& b, const V2d& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Returns whether both ends of each edge lie on different sides of the other, at least so far away
// from it.
bool cross(const Edge& e, const Edge& f, double distance) {
  const double fa = side(e.a, e.b, f.a), fb = side(e.a, e.b, f.b), ea = side(f.a, f.b, e.a),
               eb = side(f.a, f.b, e.b);
  if (!(fa * fb < 0 && ea * eb < 0)) return false;
  if (distance == 0) return true;
  const double alongE = distance * std::hypot(e.b.x - e.a.x, e.b.y - e.a.y),
               alongF = distance * std::hypot(f.b.x - f.a.x, f.b.y - f.a.y);
  return std::min(std::abs(fa), std::abs(fb)) > alongE &&
         std::min(std::abs(ea), std::abs(eb)) > alongF;
}

bool touches(const Edge& e, const V2d& low, const V2d& high) {
  if (std::max(e.a.x, e.b.x) < low.x || std::min(e.a.x, e.b.x) > high.x) return false;
  if (std::max(e.a.y, e.b.y) < low.y || std::min(e.a.y, e.b.y) > high.y) return false;
  // All corners of the box lie on one side of the edge's line: no contact.
  double s0 = side(e.a, e.b, low), s1 = side(e.a, e.b, high);
  double s2 = side(e.a, e.b, {low.x, high.y}), s3 = side(e.a, e.b, {high.x, low.y});
  return !((s0 > 0 && s1 > 0 && s2 > 0 && s3 > 0) || (s0 < 0 && s1 < 0 && s2 < 0 && s3 < 0));
}

struct Counter {
  std::vector<Edge> edges;
  uint64_t crossings = 0, work = 0, crossingBudget = 0, workBudget = 0;
  double distance = 0; // see cross()

  bool exhausted() const { return crossings > crossingBudget || work > workBudget; }

  void visit(const std::vector<uint32_t>& list, const V2d& low, const V2d& high, int depth) {
    work += list.size();
    if (exhausted()) return;
    if (list.size() <= 12 || depth == 40) {
      for (size_t i = 0; i < list.size() && !exhausted(); i++) {
        work += list.size() - i;
        for (size_t k = i + 1; k < list.size(); k++)
          crossings += cross(edges[list[i]], edges[list[k]], distance);
      }
      return;
    }
    bool splitX = high.x - low.x > high.y - low.y;
    V2d middleHigh = high, middleLow = low;
    (splitX ? middleHigh.x : middleHigh.y) = (splitX ? middleLow.x : middleLow.y) =
        splitX ? low.x + (high.x - low.x) / 2 : low.y + (high.y - low.y) / 2;
    for (int half = 0; half < 2; half++) {
      const V2d& from = half ? middleLow : low;
      const V2d& to = half ? high : middleHigh;
      std::vector<uint32_t> part;
      for (uint32_t edge : list)
        if (touches(edges[edge], from, to)) part.push_back(edge);
      visit(part, from, to, depth + 1);
      if (exhausted()) return;
    }
  }
};

} // namespace

PlaneAxes::PlaneAxes(const V3d& normal) {
  V3d size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
  w_ = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  u_ = (w_ + 1) % 3;
  v_ = (w_ + 2) % 3;
  if (normal[w_] < 0) std::swap(u_, v_);
}

V3d PlaneAxes::fromPlane(const V3d& p) const {
  V3d result;
  result[u_] = turned_ ? -p.y : p.x;
  result[v_] = turned_ ? p.x : p.y;
  result[w_] = p.z;
  return result;
}

uint64_t sweepWork(std::span<const V3d> flatPolygon, int axis) {
  size_t n = flatPolygon.size();
  std::vector<double> events(n);
  for (size_t i = 0; i < n; i++) events[i] = flatPolygon[i][axis];
  std::sort(events.begin(), events.end());
  auto rank = [&](size_t i) {
    return uint64_t(std::lower_bound(events.begin(), events.end(), flatPolygon[i][axis]) -
                    events.begin());
  };
  uint64_t work = 0, previous = rank(n - 1);
  for (size_t i = 0; i < n; i++) { // an edge is visited at each event between its ends
    uint64_t now = rank(i);
    work += now > previous ? now - previous : previous - now;
    previous = now;
  }
  return work;
}

// Counts the crossings of edges that are clearer than a part of the polygon's size.
static Counter count(std::span<const V3d> polygon, uint64_t budget, double clearness) {
  const size_t n = polygon.size();
  Counter counter;
  counter.crossingBudget = budget;
  // Long edges beside each other, as of a comb or a star, pass many of the small parts. The second
  // term bounds the time for outlines of up to 100,000 points to a second.
  counter.workBudget =
      std::max(1000 * uint64_t(n), std::min<uint64_t>(10'000 * n, 200'000'000)) + 1'000'000;
  V2d low(polygon[0].x, polygon[0].y), high = low;
  std::vector<uint32_t> all(n);
  for (size_t i = 0; i < n; i++) {
    const V3d& a = polygon[i];
    const V3d& b = polygon[i + 1 < n ? i + 1 : 0];
    counter.edges.push_back({{a.x, a.y}, {b.x, b.y}});
    low = {std::min(low.x, a.x), std::min(low.y, a.y)};
    high = {std::max(high.x, a.x), std::max(high.y, a.y)};
    all[i] = uint32_t(i);
  }
  counter.distance = clearness * std::max(high.x - low.x, high.y - low.y);
  counter.visit(all, low, high, 0);
  return counter;
}

bool isTangled(std::span<const V3d> polygon, uint64_t budget) {
  const size_t n = polygon.size();
  if (n < 4) return false;
  if (uint64_t(n) * n / 2 <= budget) return false; // it cannot have that many
  return count(polygon, budget, 0).exhausted();
}

bool crossesItself(std::span<const V3d> polygon) {
  return polygon.size() >= 4 && count(polygon, 0, 1e-4).crossings > 0;
}

} // namespace xvrml
