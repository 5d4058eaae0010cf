// views.cpp: finds viewpoints and computes cameras.
#include "mapper/views.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/lens.h"
#include "nodes/bindable.h"
#include "nodes/viewpoint.h"

namespace xvrml::mapper {

Bound firstBound(const Graph& graph, const Places& places) {
  Bound bound;
  int32_t nowhere = none;
  for (size_t i = 0; i < places.all.size(); ++i) {
    if (places.all[i].inlined) continue;
    const Item& item = graph.items[places.all[i].item];
    const auto take = [&](NodeRef& node, int32_t& place) {
      if (node) return;
      node = item.node;
      place = int32_t(i);
    };
    switch (item.kind) {
    case Kind::viewpoint: take(bound.viewpoint, bound.viewpointPlace); break;
    case Kind::background: take(bound.background, bound.backgroundPlace); break;
    case Kind::fog: take(bound.fog, bound.fogPlace); break;
    case Kind::navigationInfo: take(bound.navigationInfo, nowhere); break;
    default: break;
    }
  }
  return bound;
}

Bound boundTo(const Graph& graph, const Places& places, const BoundNodes& nodes) {
  Bound bound;
  const auto find = [&](Node* written, BindableStack stack, NodeRef& node, int32_t* place) {
    Node* rendered = written ? renderedNode(written) : nullptr;
    if (!rendered || bindableStack(rendered->type()) != stack) return;
    node = NodeRef(rendered);
    if (!place) return;
    places.each(graph.find(rendered), [&](int32_t at) {
      if (*place == none) *place = at;
    });
  };
  find(nodes.viewpoint, BindableStack::viewpoint, bound.viewpoint, &bound.viewpointPlace);
  find(nodes.background, BindableStack::background, bound.background, &bound.backgroundPlace);
  find(nodes.fog, BindableStack::fog, bound.fog, &bound.fogPlace);
  find(nodes.navigationInfo, BindableStack::navigationInfo, bound.navigationInfo, nullptr);
  return bound;
}

std::vector<ViewpointInfo> listViewpoints(const Graph& graph, const Places& places,
                                          std::vector<int32_t>& place) {
  std::vector<ViewpointInfo> list;
  for (size_t i = 0; i < places.all.size(); ++i) {
    const Item& item = graph.items[places.all[i].item];
    if (item.kind != Kind::viewpoint) continue;
    ViewpointInfo info;
    info.name = graph.names[item.name];
    info.description = viewpointFields(item.node.get())->description;
    info.node = item.node;
    toArray(places.all[i].world, info.matrix);
    list.push_back(std::move(info));
    place.push_back(int32_t(i));
  }
  return list;
}

namespace {
// Returns whether a light that is on shines on a group above a place, and only there (clause 6.16,
// ISO/IEC 19775-1 17.2.1.2).
bool inScopedLight(const Graph& graph, const Places& places, const Place& place) {
  for (int32_t above = place.parent; above > 0; above = places.all[size_t(above)].parent) {
    const Place& group = places.all[size_t(above)];
    for (uint32_t i = 0; i < group.childCount; ++i) {
      const int32_t child = places.children[group.firstChild + i];
      if (child == none) continue;
      const Item& item = graph.items[places.all[size_t(child)].item];
      if (isLight(item.kind) && item.scoped && item.on) return true;
    }
  }
  return false;
}
} // namespace

namespace {
SensorInfo infoOf(const Graph& graph, const Place& place) {
  const Item& item = graph.items[place.item];
  SensorInfo info;
  info.name = graph.names[item.name];
  info.node = item.node;
  toArray(place.world, info.matrix);
  return info;
}
} // namespace

std::vector<SensorInfo> listLamps(const Graph& graph, const Places& places) {
  std::vector<SensorInfo> list;
  for (const Place& place : places.all) {
    const Item& item = graph.items[place.item];
    if (item.kind == Kind::localLight && item.on && place.active && finite(place.world) &&
        nodeCast<nodes::ORTLight>(item.node.get()))
      list.push_back(infoOf(graph, place));
  }
  return list;
}

std::vector<SensorInfo> listSensors(const Graph& graph, const Places& places,
                                    Diagnostics& diagnostics) {
  std::vector<SensorInfo> list;
  for (const Place& place : places.all) {
    const Item& item = graph.items[place.item];
    if (item.kind != Kind::sensor || !place.active) continue;
    if (inScopedLight(graph, places, place))
      diagnostics.warn(
          item.node->source,
          "ORTSensor: a light in a group that lights the shapes of that group alone is "
          "not in the reading; sensors see those at the top level");
    list.push_back(infoOf(graph, place));
  }
  return list;
}

CameraSettings cameraOf(const Node* node, const Matrix& parent, double aspect) {
  const auto viewpoint = viewpointFields(node);
  const Vec3f position = viewpoint ? viewpoint->position : Vec3f(0, 0, 10); // as in clause 6.53
  const Rotation orientation = viewpoint ? viewpoint->orientation : Rotation();
  CameraSettings camera;
  toArray(rigid(compose(parent, compose(translation(vector(position)), rotation(orientation)))),
          camera.matrix);
  setLens(camera, viewpoint, parent, aspect);
  return camera;
}

namespace {

// The smallest camera along the axes of a view that sees all points: its place right of the
// centre, above it and before it, and half of the size of what a parallel view shows.
struct Fit {
  double right = 0, above = 0, front = 0, distance = 0, halfWidth = 0, halfHeight = 0;
};

// Finds how far the points reach to both sides of the lines of sight with this slope, from the
// middle of the picture: their place in it, and half of their width there.
struct Reach {
  double middle, half;
};
Reach reachOf(std::span<const Vector> points, int axis, double slope) {
  double above = std::numeric_limits<double>::lowest(), below = above;
  for (const Vector& p : points) {
    above = std::max(above, p[axis] + slope * p.z);
    below = std::max(below, -p[axis] + slope * p.z);
  }
  return {(above - below) / 2, (above + below) / 2};
}

// Returns the place at which the points are in the middle of the picture, seen from a distance: at
// some slope, the lines of sight touch them on both sides.
double middleFrom(std::span<const Vector> points, int axis, double most, double distance) {
  double low = 0, high = most;
  for (int i = 0; i < 50; ++i) {
    const double slope = (low + high) / 2;
    (reachOf(points, axis, slope).half > slope * distance ? low : high) = slope;
  }
  return reachOf(points, axis, high).middle;
}

// Returns the coordinates of a point, relative to another, along the axes of a view.
Vector along(const Matrix& view, const Vector& point) {
  Vector p;
  for (int i = 0; i < 3; ++i) p[i] = point.dot(Vector(view.x[i][0], view.x[i][1], view.x[i][2]));
  return p;
}

// points: along the axes of the view. tanX, tanY: tangents of half the angles; 0: a parallel view.
// clearance: least distance of the eye from what is nearest to it.
Fit fitPoints(std::span<const Vector> points, double tanX, double tanY, double clearance) {
  Fit fit{0, 0, std::numeric_limits<double>::lowest(), 0, 0, 0};
  for (const Vector& p : points) fit.front = std::max(fit.front, p.z);
  const Reach across = reachOf(points, 0, tanX), upwards = reachOf(points, 1, tanY);
  fit.halfWidth = across.half;
  fit.halfHeight = upwards.half;
  fit.distance = fit.front;
  if (!(tanX > 0)) {
    fit.right = across.middle;
    fit.above = upwards.middle;
    return fit;
  }
  fit.distance = std::max({fit.front + clearance, across.half / tanX, upwards.half / tanY});
  // The middle follows from points between those that touch the edges of the picture: only these
  // say for certain what is seen.
  const auto middle = [&](int axis, double most, const Reach& reach) {
    const double slack = std::max(0.0, most * fit.distance - reach.half);
    return std::clamp(middleFrom(points, axis, most, fit.distance), reach.middle - slack,
                      reach.middle + slack);
  };
  fit.right = middle(0, tanX, across);
  fit.above = middle(1, tanY, upwards);
  return fit;
}

// A fitted picture has a margin, which its angles of view do not count.
constexpr double margin = 1.1;

struct Tangents { // those of half the angles of view, within the margin
  double x, y;
};
Tangents tangentsOf(double fovy, double aspect) {
  const double y = std::tan(fovy / 2) / margin;
  return {y * (aspect > 0 ? aspect : 1), y};
}
bool isAngle(double fovy) { return fovy >= 0 && fovy < 3.14; } // a parallel view has none

} // namespace

bool hasHeadlight(const Bound& bound) {
  const auto* info = nodeCast<nodes::NavigationInfo>(bound.navigationInfo);
  return !info || info->headlight;
}

std::optional<Outermost::Directions> directionsAcross(const double view[16], double fovy,
                                                      double aspect) {
  const Tangents most = tangentsOf(fovy, aspect);
  if (!isAngle(fovy) || !(std::max(most.x, most.y) > 1 / margin)) return {};
  const Matrix axes = rotationOnly(fromArray(view));
  Outermost::Directions directions;
  directions.fill(transformDirection(axes, Vector(0, 0, 1)));
  // Across the edges of the picture, and of smaller ones, which find its middle.
  constexpr size_t slopes = Outermost::count / 4 - 1;
  for (size_t i = 0; i < slopes; ++i)
    for (const double side : {-1.0, 1.0}) {
      const double part = double(i + 1) / slopes;
      const size_t at = 4 * i + (side > 0 ? 2 : 0);
      directions[at] = transformDirection(axes, Vector(side, 0, most.x * part));
      directions[at + 1] = transformDirection(axes, Vector(0, side, most.y * part));
    }
  return directions;
}

CameraSettings cameraAround(std::span<const Vector> points, const double view[16], double fovy,
                            double aspect) {
  CameraSettings camera = cameraOf(nullptr, Matrix(), aspect);
  camera.fovy = isAngle(fovy) ? fovy : camera.fovy;
  const double ratio = aspect > 0 ? aspect : 1;
  const Matrix axes = rotationOnly(fromArray(view));
  if (points.empty()) {
    if (camera.fovy == 0) camera.height = 10;
    return camera;
  }
  Vector low = points.front(), high = low;
  for (const Vector& p : points)
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  const Vector center = (low + high) / 2;
  std::vector<Vector> seen;
  seen.reserve(points.size());
  for (const Vector& p : points) seen.push_back(along(axes, p - center));
  const Tangents most = tangentsOf(camera.fovy, aspect);
  const double size = (high - low).length();
  // A spire that is seen from its tip fits at any distance from the tip.
  constexpr double leastClearance = .05;
  const Fit fit = fitPoints(seen, most.x, most.y, leastClearance * size);
  double distance = fit.distance;
  if (camera.fovy == 0) {
    camera.height = 2 * margin * std::max(fit.halfHeight, fit.halfWidth / ratio);
    distance = fit.front + size;
    if (!(camera.height > 0)) camera.height = 1;
  }
  if (!(distance > 0)) distance = 1;
  const Vector eye = center + transformDirection(axes, Vector(fit.right, fit.above, distance));
  toArray(compose(translation(eye), axes), camera.matrix);
  return camera;
}

bool seesAll(std::span<const Vector> points, const CameraSettings& camera, double aspect) {
  constexpr double rounding = 1.01;
  const Matrix matrix = fromArray(camera.matrix);
  const Vector eye = transformPoint(matrix, Vector(0));
  const bool parallel = camera.fovy == 0;
  const double y = rounding * (parallel ? camera.height / 2 : std::tan(camera.fovy / 2)),
               x = y * (aspect > 0 ? aspect : 1);
  return std::all_of(points.begin(), points.end(), [&](const Vector& point) {
    const Vector p = along(matrix, point - eye);
    const double scale = parallel ? 1 : -p.z;
    return p.z < 0 && std::abs(p.x) <= x * scale && std::abs(p.y) <= y * scale;
  });
}

} // namespace xvrml::mapper

namespace xvrml {

CameraSettings cameraAround(const Bounds& bounds, const double view[16], double fovy,
                            double aspect) {
  std::vector<Vector> corners;
  for (size_t corner = 0; corner < 8 && !bounds.empty; ++corner) {
    auto side = [&](size_t i) {
      return corner & (1u << i) ? bounds.maximum[i] : bounds.minimum[i];
    };
    corners.emplace_back(side(0), side(1), side(2));
  }
  return mapper::cameraAround(corners, view, fovy, aspect);
}

} // namespace xvrml
