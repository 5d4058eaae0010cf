// nurbs_swept.cpp: NurbsSwungSurface and NurbsSweptSurface (ISO/IEC 19775-1 27.4.12, 27.4.11), with
// normals by the derivatives of both curves.
#include <algorithm>

#include "geometry/builders.h"
#include "geometry/extrusion_frames.h"
#include "geometry/nurbs/fields.h"
#include "geometry/nurbs/surface_grid.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

// A curve that sweeps or is swept. At a corner there are two points, one for each side.
struct SweptCurve {
  std::vector<V2d> points, tangents;
  std::vector<double> fractions; // texture coordinates
};

SweptCurve sweptCurveOf(const NodeRef& node, const MeshOptions& options, Faults& faults) {
  PlaneCurve given = planeCurveOf(node, triangleLimit(options) / 2, faults);
  SweptCurve curve;
  const size_t count = given.points.size();
  if (count < 2) return curve;
  const auto add = [&](size_t i, const V2d& tangent) {
    curve.points.push_back(given.points[i]);
    curve.tangents.push_back(tangent);
    curve.fractions.push_back(given.fractions[i]);
  };
  if (given.tangents.empty()) {
    for (size_t i = 0; i + 1 < count; i++)
      for (const size_t end : {i, i + 1}) add(end, given.points[i + 1] - given.points[i]);
  } else {
    for (size_t i = 0; i < count; i++) add(i, given.tangents[i]);
  }
  return curve;
}

// One place of a curve in space, with the derivatives by its parameter.
struct Station {
  ParameterStep step;
  V3d place, first, second;
  SpineFrame frame;
  V3d turn{0, 0, 0}; // angular velocity of the frame
};

// Lays the planes of an Extrusion at the points of a curve, at right angles to its tangents. At a
// bend they stay in the middle between both.
void layFrames(std::vector<Station>& stations) {
  std::vector<Vec3f> spine;
  for (const Station& station : stations) spine.push_back(toVec3f(station.place));
  const std::vector<SpineFrame> frames = spineFrames(spine, spine.front() == spine.back());
  for (size_t i = 0; i < stations.size(); i++) {
    Station& station = stations[i];
    const V3d y = unit(station.first);
    station.frame = frames[i];
    const V3d z = unit(frames[i].z - y * frames[i].z.dot(y));
    if (station.step.side != ParameterStep::Side::inside) continue;
    if (y != V3d(0, 0, 0) && z != V3d(0, 0, 0)) station.frame = {y.cross(z), y, z};
  }
}

// Sets how the frames turn: with the tangent, and about it from one station to the next.
void setTurns(std::vector<Station>& stations) {
  for (size_t i = 0; i < stations.size(); i++) {
    Station& station = stations[i];
    const Station &before = stations[i > 0 ? i - 1 : 0],
                  &after = stations[std::min(i + 1, stations.size() - 1)];
    const double speed = station.first.length(), way = after.step.t - before.step.t;
    if (!(speed > 0) || !(way > 0)) continue;
    const double sine = before.frame.z.cross(after.frame.z).dot(station.frame.y);
    station.turn = station.first.cross(station.second) / (speed * speed) +
                   station.frame.y * (std::asin(std::clamp(sine, -1.0, 1.0)) / way);
  }
}

std::vector<Station> stationsOf(const RationalCurve& curve, uint64_t steps) {
  std::vector<Station> stations;
  for (const ParameterStep& step : curve.knots.steps(steps)) {
    const RationalCurve::Point point = curve.at(curve.knots.basis(step));
    stations.push_back({step, point.place, point.first, point.second, {}, {0, 0, 0}});
  }
  layFrames(stations);
  setTurns(stations);
  return stations;
}

// Fills a grid, row by row along the first curve. at: returns place and normal at column and row.
template <class At>
SurfaceGrid gridOf(std::span<const double> s, std::span<const double> t, const At& at) {
  SurfaceGrid grid{s.size(), t.size(), {}};
  grid.vertices.reserve(s.size() * t.size());
  for (size_t j = 0; j < t.size(); j++)
    for (size_t i = 0; i < s.size(); i++) {
      SurfaceVertex vertex = at(i, j);
      vertex.texCoord = {float(s[i]), float(t[j])};
      grid.vertices.push_back(vertex);
    }
  return grid;
}

// Returns whether there are two curves, and notes a fault if one of them is there alone.
bool areCurves(size_t points, size_t otherPoints, Faults& faults) {
  if (points >= 2 && otherPoints >= 2) return true;
  faults.note("a surface needs two curves with two points at least; nothing is drawn");
  return false;
}

} // namespace

// The point of the profile in the plane of y and z goes to the trajectory in the plane of x and z,
// z times as far from the axis ("The NURBS Book" 8.4).
Mesh buildNurbsSwungSurface(const nodes::NurbsSwungSurface& node, const MeshOptions& options,
                            Faults& faults) {
  if (!node.profileCurve && !node.trajectoryCurve) return {};
  const SweptCurve profile = sweptCurveOf(node.profileCurve, options, faults),
                   trajectory = sweptCurveOf(node.trajectoryCurve, options, faults);
  const size_t columns = profile.points.size(), rows = trajectory.points.size();
  if (!areCurves(columns, rows, faults) || !isGridAllowed(columns - 1, rows - 1, options, faults))
    return {};
  // The distance of a point from the axis has a side, which at the axis is that of the points
  // beside it; its amount does not change the direction of the normal.
  const auto side = [&](size_t i) {
    const double z = profile.points[i].y, onwards = i < columns / 2 ? 1 : -1;
    return z < 0 || (z == 0 && profile.tangents[i].y * onwards < 0) ? -1.0 : 1.0;
  };
  SurfaceGrid grid = gridOf(profile.fractions, trajectory.fractions, [&](size_t i, size_t j) {
    const V2d &p = profile.points[i], &dp = profile.tangents[i], &t = trajectory.points[j],
              &dt = trajectory.tangents[j];
    const V3d alongProfile(dp.y * t.x, dp.x, dp.y * t.y), alongTrajectory(dt.x, 0, dt.y);
    return SurfaceVertex{
        {p.y * t.x, p.x, p.y * t.y}, unit(alongProfile.cross(alongTrajectory)) * side(i), {}};
  });
  Mesh mesh = meshOfGrid(std::move(grid), !node.ccw, faults);
  mesh.solid = node.solid;
  return mesh;
}

// The cross-section lies in the planes of an Extrusion, as if the trajectory were its spine.
Mesh buildNurbsSweptSurface(const nodes::NurbsSweptSurface& node, const MeshOptions& options,
                            Faults& faults) {
  if (!node.crossSectionCurve && !node.trajectoryCurve) return {};
  const SweptCurve section = sweptCurveOf(node.crossSectionCurve, options, faults);
  auto* trajectory = nodeCast<nodes::NurbsCurve>(renderedNode(node.trajectoryCurve.get()));
  const std::optional<RationalCurve> spine =
      trajectory ? curveOf(*trajectory, faults) : std::nullopt;
  if (!areCurves(section.points.size(), spine ? 2 : 0, faults)) return {};
  const uint64_t steps = stepsOf(trajectory->tessellation, spine->points.size());
  if (!isGridAllowed(section.points.size() - 1, steps + 2 * spine->points.size(), options, faults))
    return {};
  const std::vector<Station> stations = stationsOf(*spine, steps);
  std::vector<double> fractions;
  for (const Station& station : stations) fractions.push_back(station.step.fraction);
  SurfaceGrid grid = gridOf(section.fractions, fractions, [&](size_t i, size_t j) {
    const Station& at = stations[j];
    const V2d &p = section.points[i], &d = section.tangents[i];
    const V3d offset = at.frame.x * p.x + at.frame.z * p.y;
    const V3d alongSection = at.frame.x * d.x + at.frame.z * d.y;
    const V3d alongSpine = at.first + at.turn.cross(offset);
    return SurfaceVertex{at.place + offset, unit(alongSection.cross(alongSpine)), {}};
  });
  Mesh mesh = meshOfGrid(std::move(grid), !node.ccw, faults);
  mesh.solid = node.solid;
  return mesh;
}

} // namespace xvrml
