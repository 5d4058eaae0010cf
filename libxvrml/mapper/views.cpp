// views.cpp: finds viewpoints and computes cameras.
#include "mapper/views.h"

#include <algorithm>
#include <cmath>

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

std::vector<SensorInfo> listSensors(const Graph& graph, const Places& places,
                                    Diagnostics& diagnostics) {
  std::vector<SensorInfo> list;
  for (const Place& place : places.all) {
    const Item& item = graph.items[place.item];
    if (item.kind != Kind::sensor || !place.active) continue;
    SensorInfo info;
    info.name = graph.names[item.name];
    info.node = item.node;
    toArray(place.world, info.matrix);
    if (inScopedLight(graph, places, place))
      diagnostics.warn(
          item.node->source,
          "ORTSensor: a light in a group that lights the shapes of that group alone is "
          "not in the reading; sensors see those at the top level");
    list.push_back(std::move(info));
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
struct Extents {
  double x = 0, y = 0, front = 0;
};

// Measures how far the corners reach from the centre along the axes of the view. For a perspective
// view it also computes the distance of the camera.
Extents measure(const Bounds& b, const Matrix& view, const Vector& center, double tanX,
                double tanY) {
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

bool hasHeadlight(const Bound& bound) {
  const auto* info = nodeCast<nodes::NavigationInfo>(bound.navigationInfo);
  return !info || info->headlight;
}

} // namespace xvrml::mapper

namespace xvrml {

CameraSettings cameraAround(const Bounds& bounds, const double view[16], double fovy,
                            double aspect) {
  CameraSettings camera = mapper::cameraOf(nullptr, Matrix(), aspect);
  camera.fovy = fovy >= 0 && fovy < 3.14 ? fovy : camera.fovy;
  const double margin = 1.1, ratio = aspect > 0 ? aspect : 1;
  const Matrix axes = rotationOnly(fromArray(view));
  if (bounds.empty) {
    if (camera.fovy == 0) camera.height = 10;
    return camera;
  }
  const Vector low(bounds.minimum[0], bounds.minimum[1], bounds.minimum[2]),
      high(bounds.maximum[0], bounds.maximum[1], bounds.maximum[2]);
  const Vector center = (low + high) / 2;
  const double tanY = std::tan(camera.fovy / 2) / margin, size = (high - low).length();
  const mapper::Extents e = mapper::measure(bounds, axes, center, tanY * ratio, tanY);
  double distance = e.front;
  if (camera.fovy == 0) {
    camera.height = 2 * margin * std::max(e.y, e.x / ratio);
    distance = e.front + size;
    if (!(camera.height > 0)) camera.height = 1;
  }
  if (!(distance > 0)) distance = 1;
  toArray(compose(translation(center + transformDirection(axes, Vector(0, 0, distance))), axes),
          camera.matrix);
  return camera;
}

} // namespace xvrml
