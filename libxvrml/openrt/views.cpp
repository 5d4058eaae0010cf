// views.cpp: viewpoints and cameras. See views.h.
#include "openrt/views.h"

#include <algorithm>
#include <cmath>

#include "xvrml/nodes.h"

namespace xvrml::mapping {

Bound firstBound(const Graph& graph, const Places& places) {
  Bound bound;
  auto take = [](int32_t& slot, size_t place) {
    if (slot == none) slot = int32_t(place);
  };
  for (size_t i = 0; i < places.all.size(); ++i) {
    if (places.all[i].inlined) continue;
    switch (graph.items[places.all[i].item].kind) {
    case Kind::viewpoint: take(bound.viewpoint, i); break;
    case Kind::background: take(bound.background, i); break;
    case Kind::fog: take(bound.fog, i); break;
    case Kind::navigationInfo: take(bound.navigationInfo, i); break;
    default: break;
    }
  }
  return bound;
}

Bound placesOf(const Graph& graph, const Places& places, const BoundNodes& nodes) {
  const auto first = [&](Node* node) {
    Node* rendered = node ? renderedNode(node) : nullptr;
    for (size_t i = 0; rendered && i < places.all.size(); ++i)
      if (graph.items[places.all[i].item].node == rendered) return int32_t(i);
    return none;
  };
  return {first(nodes.viewpoint), first(nodes.background), first(nodes.fog), first(nodes.navigationInfo)};
}

std::vector<ViewpointInfo> listViewpoints(const Graph& graph, const Places& places, std::vector<int32_t>& place) {
  std::vector<ViewpointInfo> list;
  for (size_t i = 0; i < places.all.size(); ++i) {
    const Item& item = graph.items[places.all[i].item];
    if (item.kind != Kind::viewpoint) continue;
    ViewpointInfo info;
    info.name = graph.names[item.name];
    info.description = static_cast<nodes::Viewpoint&>(*item.node).description;
    info.node = NodeRef(item.node);
    toArray(places.all[i].world, info.matrix);
    list.push_back(std::move(info));
    place.push_back(int32_t(i));
  }
  return list;
}

CameraSettings cameraOf(const Node* node, const Matrix& parent, double aspect) {
  Vec3f position{0, 0, 10}; // clause 6.53
  Rotation orientation;
  float fieldOfView = 0.785398f;
  if (node) {
    const auto& viewpoint = static_cast<const nodes::Viewpoint&>(*node);
    position = viewpoint.position;
    orientation = viewpoint.orientation;
    fieldOfView = viewpoint.fieldOfView;
  }
  CameraSettings camera;
  toArray(rigid(compose(parent, compose(translation(vector(position)), rotation(orientation)))), camera.matrix);
  camera.fovy = verticalFieldOfView(fieldOfView, aspect);
  return camera;
}

namespace {
struct Extents {
  double x = 0, y = 0, front = 0;
};

// How far the corners reach from the centre, in the view's axes, and for a perspective how far away the eye must be.
Extents measure(const Bounds& b, const Matrix& view, const Vector& center, double tanX, double tanY) {
  Extents e;
  const Vector axis[3] = {{view.x[0][0], view.x[0][1], view.x[0][2]},
                          {view.x[1][0], view.x[1][1], view.x[1][2]},
                          {view.x[2][0], view.x[2][1], view.x[2][2]}};
  for (int corner = 0; corner < 8; ++corner) {
    auto side = [&](int i) { return corner & (1 << i) ? b.maximum[i] : b.minimum[i]; };
    const Vector p = Vector(side(0), side(1), side(2)) - center;
    const double x = std::abs(p.dot(axis[0])), y = std::abs(p.dot(axis[1])), z = p.dot(axis[2]);
    e.x = std::max(e.x, x);
    e.y = std::max(e.y, y);
    e.front = std::max({e.front, z + (tanX > 0 ? std::max(x / tanX, y / tanY) : 0)});
  }
  return e;
}
} // namespace

CameraSettings cameraAround(const Bounds& bounds, const Matrix& view, double fovy, double aspect) {
  CameraSettings camera = cameraOf(nullptr, Matrix(), aspect);
  camera.fovy = fovy >= 0 && fovy < 3.14 ? fovy : camera.fovy;
  const double margin = 1.1, ratio = aspect > 0 ? aspect : 1;
  const Matrix axes = rotationOnly(view);
  if (bounds.empty) {
    if (camera.fovy == 0) camera.height = 10;
    return camera;
  }
  const Vector low(bounds.minimum[0], bounds.minimum[1], bounds.minimum[2]),
      high(bounds.maximum[0], bounds.maximum[1], bounds.maximum[2]);
  const Vector center = (low + high) / 2;
  const double tanY = std::tan(camera.fovy / 2) / margin, size = (high - low).length();
  const Extents e = measure(bounds, axes, center, tanY * ratio, tanY);
  double distance = e.front;
  if (camera.fovy == 0) {
    camera.height = 2 * margin * std::max(e.y, e.x / ratio);
    distance = e.front + size;
    if (!(camera.height > 0)) camera.height = 1;
  }
  if (!(distance > 0)) distance = 1;
  toArray(compose(translation(center + transformDirection(axes, Vector(0, 0, distance))), axes), camera.matrix);
  return camera;
}

bool hasHeadlight(const Graph& graph, const Places& places, const Bound& bound) {
  if (bound.navigationInfo == none) return true;
  const Item& item = graph.items[places.all[size_t(bound.navigationInfo)].item];
  return static_cast<nodes::NavigationInfo&>(*item.node).headlight;
}

} // namespace xvrml::mapping
