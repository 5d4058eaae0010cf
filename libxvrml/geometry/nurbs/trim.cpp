// trim.cpp: clips the contours to strips between values of u, these to cells between values of v
// (I. E. Sutherland, G. W. Hodgman, "Reentrant Polygon Clipping", 1974), and triangulates what is
// left in each cell. Clipped contours run along the sides of their cell and back; the odd winding
// rule cancels what is there twice.
#include "geometry/nurbs/trim.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "geometry/polygons/flat_triangles.h"
#include "geometry/polygons/tessellator.h"

namespace xvrml {
namespace {

using Contour = std::vector<V2d>;
using Contours = std::vector<Contour>;

// A half-plane: coordinate `axis` is at least `limit`, or with `below` at most.
struct HalfPlane {
  int axis;
  double limit;
  bool below;

  bool holds(const V2d& p) const { return below ? p[axis] <= limit : p[axis] >= limit; }
  // Returns where an edge crosses the line. The same edge gives the same point on both sides.
  V2d crossing(V2d a, V2d b) const {
    if (b[axis] < a[axis] || (b[axis] == a[axis] && b[1 - axis] < a[1 - axis])) std::swap(a, b);
    const double share = (limit - a[axis]) / (b[axis] - a[axis]);
    V2d p(limit, limit);
    p[1 - axis] = a[1 - axis] + (b[1 - axis] - a[1 - axis]) * share;
    return p;
  }
};

Contour clipped(const Contour& contour, const HalfPlane& half) {
  Contour result;
  const auto push = [&](const V2d& p) {
    if (result.empty() || result.back() != p) result.push_back(p);
  };
  for (size_t i = 0; i < contour.size(); i++) {
    const V2d &a = contour[i], &b = contour[(i + 1) % contour.size()];
    if (half.holds(a)) push(a);
    // An end on the line is a corner on both of its sides.
    if (a[half.axis] != half.limit && b[half.axis] != half.limit && half.holds(a) != half.holds(b))
      push(half.crossing(a, b));
  }
  while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  if (result.size() < 3) result.clear();
  return result;
}

// Clips contours to the part between two values of a coordinate. work: counts their corners.
Contours between(const Contours& contours, int axis, double low, double high, uint64_t& work) {
  Contours result;
  for (const Contour& contour : contours) {
    work += contour.size();
    Contour part = clipped(clipped(contour, {axis, low, false}), {axis, high, true});
    if (!part.empty()) result.push_back(std::move(part));
  }
  return result;
}

double areaOf(const V2d& a, const V2d& b, const V2d& c) { return (b - a).cross(c - a); }

// Splits triangles at the corners that other cells have on the lines between them, as where a
// contour touches a line from one side.
class LineSplitter {
 public:
  LineSplitter(std::span<const double> u, std::span<const double> v, TrimmedCells& cells)
      : cells_(cells) {
    for (const double line : u) lines_[0][line];
    for (const double line : v) lines_[1][line];
    for (uint32_t i = 0; i < cells.corners.size(); i++)
      for (int axis = 0; axis < 2; axis++)
        if (const auto line = lines_[axis].find(cells.corners[i][axis]); line != lines_[axis].end())
          line->second.emplace_back(cells.corners[i][1 - axis], i);
    for (auto& lines : lines_)
      for (auto& [place, corners] : lines) std::sort(corners.begin(), corners.end());
  }

  void run() {
    std::vector<uint32_t> whole;
    auto& open = cells_.triangles;
    while (open.size() >= 3) {
      std::array<uint32_t, 3> t;
      std::copy(open.end() - 3, open.end(), t.begin());
      open.resize(open.size() - 3);
      uint32_t between = 0;
      int edge = 0;
      while (edge < 3 && !find(t[size_t(edge)], t[size_t(edge + 1) % 3], between)) edge++;
      if (edge == 3) {
        whole.insert(whole.end(), t.begin(), t.end());
        continue;
      }
      const uint32_t a = t[size_t(edge)], b = t[size_t(edge + 1) % 3], c = t[size_t(edge + 2) % 3];
      open.insert(open.end(), {a, between, c, between, b, c});
    }
    open = std::move(whole);
  }

 private:
  // Finds a corner on the line between two others, if they are on one.
  bool find(uint32_t a, uint32_t b, uint32_t& between) const {
    const V2d &p = cells_.corners[a], &q = cells_.corners[b];
    for (int axis = 0; axis < 2; axis++) {
      if (p[axis] != q[axis]) continue;
      const auto line = lines_[axis].find(p[axis]);
      if (line == lines_[axis].end()) continue;
      const double low = std::min(p[1 - axis], q[1 - axis]),
                   high = std::max(p[1 - axis], q[1 - axis]);
      const auto next =
          std::upper_bound(line->second.begin(), line->second.end(), std::pair{low, UINT32_MAX});
      if (next == line->second.end() || !(next->first < high)) continue;
      between = next->second;
      return true;
    }
    return false;
  }

  TrimmedCells& cells_;
  std::map<double, std::vector<std::pair<double, uint32_t>>> lines_[2];
};

class Cutter {
 public:
  Cutter(std::span<const double> u, std::span<const double> v, uint64_t most)
      : u_(u), v_(v), most_(most) {}

  // Returns false if there is too much to do.
  bool run(const Contours& contours) {
    return cut(0, 0, u_.size() - 1, between(contours, 0, u_.front(), u_.back(), work_));
  }
  TrimmedCells take() {
    LineSplitter(u_, v_, result_).run();
    return std::move(result_);
  }

 private:
  static constexpr uint64_t mostWork = 400'000'000; // corners that are clipped

  // Cuts what lies between two lines of an axis in halves, down to one cell. Both sides of a line
  // are cut from the same contours, so that their corners on it are the same.
  bool cut(int axis, size_t low, size_t high, const Contours& part) {
    if (part.empty()) return true;
    if (work_ > mostWork || result_.triangles.size() / 3 > most_) return false;
    const auto lines = axis == 0 ? u_ : v_;
    if (high - low > 1) {
      const size_t middle = low + (high - low) / 2;
      return cut(axis, low, middle, between(part, axis, lines[low], lines[middle], work_)) &&
             cut(axis, middle, high, between(part, axis, lines[middle], lines[high], work_));
    }
    if (axis == 1) return addCell(part);
    return cut(1, 0, v_.size() - 1, between(part, 1, v_.front(), v_.back(), work_));
  }

  bool addCell(const Contours& cell) {
    std::vector<V2d> places;
    std::vector<V3d> all; // one after the other
    for (const Contour& contour : cell)
      for (const V2d& p : contour) {
        places.push_back(p);
        all.emplace_back(p.x, p.y, 0);
      }
    if (all.empty()) return true;
    if (cell.size() == 1 && addWhole(cell[0], places)) return true;
    if (isTangled(all, 4 * all.size() + 20'000)) return false;
    work_ += std::min(sweepWork(all, 0), sweepWork(all, 1));
    if (work_ > mostWork) return false;
    tessellator_.begin({0, 0, 1}, Tessellator::Winding::odd);
    size_t first = 0;
    for (const Contour& contour : cell) {
      tessellator_.contour(std::span(all).subspan(first, contour.size()));
      first += contour.size();
    }
    if (!tessellator_.end()) return false;
    for (const auto& crossing : tessellator_.crossings())
      places.emplace_back(crossing.point.x, crossing.point.y);
    addTriangles(places, tessellator_.triangles());
    return true;
  }

  // Adds the triangles of a cell that no contour cuts.
  bool addWhole(const Contour& contour, const std::vector<V2d>& places) {
    if (contour.size() != 4) return false;
    const auto [low, high] = std::pair{*std::min_element(contour.begin(), contour.end(), isBefore),
                                       *std::max_element(contour.begin(), contour.end(), isBefore)};
    for (const V2d& p : contour)
      if ((p.x != low.x && p.x != high.x) || (p.y != low.y && p.y != high.y)) return false;
    const double area = areaOf(contour[0], contour[1], contour[2]);
    if (area == 0 || areaOf(contour[0], contour[2], contour[3]) * area <= 0) return false;
    addTriangles(places, area > 0 ? std::vector<uint32_t>{0, 1, 2, 0, 2, 3}
                                  : std::vector<uint32_t>{0, 2, 1, 0, 3, 2});
    return true;
  }
  static bool isBefore(const V2d& a, const V2d& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  }

  void addTriangles(const std::vector<V2d>& places, std::vector<uint32_t> triangles) {
    removeFlatTriangles(
        triangles, [&](uint32_t a) { return V3d(places[a].x, places[a].y, 0); },
        [&](uint32_t a, uint32_t b, uint32_t c) {
          return areaOf(places[a], places[b], places[c]) != 0;
        });
    for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
      const std::array<uint32_t, 3> corners{corner(places[triangles[t]]),
                                            corner(places[triangles[t + 1]]),
                                            corner(places[triangles[t + 2]])};
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
        result_.triangles.insert(result_.triangles.end(), corners.begin(), corners.end());
    }
  }

  uint32_t corner(const V2d& place) {
    const auto [found, isNew] =
        numbers_.try_emplace({place.x, place.y}, uint32_t(result_.corners.size()));
    if (isNew) result_.corners.push_back(place);
    return found->second;
  }

  std::span<const double> u_, v_;
  uint64_t most_, work_ = 0;
  Tessellator tessellator_;
  std::map<std::pair<double, double>, uint32_t> numbers_;
  TrimmedCells result_;
};

} // namespace

TrimmedCells trimCells(std::span<const double> u, std::span<const double> v,
                       std::span<const std::vector<V2d>> contours, uint64_t most, Faults& faults) {
  Cutter cutter(u, v, most);
  if (cutter.run({contours.begin(), contours.end()})) return cutter.take();
  faults.note("trimmingContour is too long or tangled; nothing is drawn");
  return {};
}

} // namespace xvrml
