// region.cpp: ProximitySensor and VisibilitySensor (clauses 6.38, 6.54): boxes that the viewer
// enters or sees, and TransformSensor (ISO/IEC 19775-1 22.4.2): a box that a group or a Shape
// enters. They are evaluated once per tick, after its events, and after jumps. A sensor that is
// USEd several times senses the union of its boxes.
#include <array>
#include <cmath>

#include <Imath/ImathMatrixAlgo.h>
#include <Imath/ImathQuat.h>

#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "nodes/viewpoint.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

struct RegionState : NodeState {
  bool active = false;
  Vec3f position; // last value sent
  Rotation orientation;
  Vec3f center; // that is, centerOfRotation_changed
};

struct Region {
  Vector center, half;
};

template <class Sensor> Region regionOf(const Sensor& s) {
  const Vector size = vector(s.size);
  return {vector(s.center), Vector(std::abs(size.x), std::abs(size.y), std::abs(size.z)) / 2};
}

Rotation rotationOf(const Matrix& m) {
  Imath::Quatd q = Imath::extractQuat(rotationOnly(m));
  if (q.r < 0) q = -q;
  if (!(q.v.length() > 1e-9)) return {0, 0, 1, 0};
  const Vector axis = q.v.normalized();
  return {float(axis.x), float(axis.y), float(axis.z), float(2 * std::atan2(q.v.length(), q.r))};
}

void setActive(Events& events, Node& node, bool active) {
  static_cast<RegionState&>(*events.state(node)).active = active;
  sendFrom<"isActive">(events, node, active);
  if (active)
    sendFrom<"enterTime">(events, node, events.now());
  else
    sendFrom<"exitTime">(events, node, events.now());
}

// Sends where something inside of the box is. place: from its coordinate system to the sensor's.
void sendPlace(Events& events, Node& node, const Matrix& place, bool entered) {
  auto& state = static_cast<RegionState&>(*events.state(node));
  const Vector p = transformPoint(place, Vector(0));
  const Vec3f position{float(p.x), float(p.y), float(p.z)};
  const Rotation orientation = rotationOf(place);
  if (entered || position != state.position) sendFrom<"position_changed">(events, node, position);
  if (entered || orientation != state.orientation)
    sendFrom<"orientation_changed">(events, node, orientation);
  state.position = position;
  state.orientation = orientation;
}

// Finds the first of the sensor's boxes that contains the viewer, and the matrix from the viewer to
// the sensor.
bool viewerInside(const Node& node, const Region& region, const Matrix& view,
                  Matrix& viewerToSensor) {
  for (const Path& path : pathsTo(node)) {
    Matrix toLocal;
    if (!invert(Picker::toWorld(path, view), toLocal)) continue;
    viewerToSensor = compose(toLocal, view);
    const Vector p = transformPoint(viewerToSensor, Vector(0)) - region.center;
    if (std::abs(p.x) <= region.half.x && std::abs(p.y) <= region.half.y &&
        std::abs(p.z) <= region.half.z)
      return true;
  }
  return false;
}

// Computes the centerOfRotation of the bound viewpoint in the sensor's coordinates (ISO/IEC 19775-1
// 22.4.1). Returns false if there is none.
bool centerOfRotation(Events& events, const Matrix& viewerToSensor, Vec3f& center) {
  const Interaction& interaction = interactionOf(events);
  const Node* viewpoint = interaction.binding.bound().viewpoint;
  const auto fields = viewpointFields(viewpoint);
  Matrix toViewer;
  if (!fields || !fields->centerOfRotation || !invert(interaction.viewer.view(), toViewer))
    return false;
  const Vector p =
      transformPoint(compose(viewerToSensor, compose(toViewer, Viewer::surroundingsOf(viewpoint))),
                     vector(*fields->centerOfRotation));
  center = {float(p.x), float(p.y), float(p.z)};
  return true;
}

void lookProximity(Events& events, Node& node) {
  auto& state = static_cast<RegionState&>(*events.state(node));
  const auto& sensor = static_cast<nodes::ProximitySensor&>(node);
  const Region region = regionOf(sensor);
  // A box of size 0 senses nothing (6.38).
  const bool senses = sensor.enabled && sensor.size != Vec3f();
  Matrix viewer;
  const bool inside =
      senses && viewerInside(node, region, interactionOf(events).viewer.view(), viewer);
  const bool entered = inside && !state.active;
  if (inside != state.active) setActive(events, node, inside);
  if (!inside) return;
  sendPlace(events, node, viewer, entered);
  Vec3f center;
  if (!centerOfRotation(events, viewer, center)) return;
  if (entered || center != state.center) sendFrom<"centerOfRotation_changed">(events, node, center);
  state.center = center;
}

// Returns whether a box that is placed by a matrix meets the region: no axis separates them, which
// for two parallelepipeds is a normal of a face or a normal to an edge of each (S. Gottschalk, M.
// C. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996).
bool meets(const Region& region, const PickBox& box, const Matrix& place) {
  const Vector middle = transformPoint(place, (box.low + box.high) / 2) - region.center;
  const Vector size = box.high - box.low;
  Vector own[3], half[3]; // half of the edges of the region, and of the box
  for (int i = 0; i < 3; ++i) {
    own[i] = half[i] = Vector(0);
    own[i][i] = region.half[i];
    half[i][i] = size[i] / 2;
    half[i] = transformDirection(place, half[i]);
  }
  const auto separates = [&](const Vector& axis) {
    double reach = 0;
    for (int i = 0; i < 3; ++i) reach += std::abs(own[i].dot(axis)) + std::abs(half[i].dot(axis));
    return std::abs(middle.dot(axis)) > reach * (1 + 1e-12);
  };
  for (int i = 0; i < 3; ++i) {
    Vector axis(0);
    axis[i] = 1;
    if (separates(axis) || separates(half[i].cross(half[(i + 1) % 3]))) return false;
    for (const Vector& edge : half)
      if (separates(axis.cross(edge))) return false;
  }
  return std::isfinite(middle.length());
}

// Returns the bounding box of a group's children, or of another node, in its coordinate system.
PickBox ownBounds(Picker& picker, Node& node) {
  const FieldInfo* children = node.type().find("children");
  if (!children || children->type != FieldType::MFNode) return picker.bounds({NodeRef(&node)});
  return picker.bounds(*static_cast<const MFNode*>(node.storage(*children)));
}

// Finds the first place of the sensor and of its target where the target's bounding box meets the
// region, and the matrix from the target's coordinate system to the sensor's. A target in a choice
// that a Switch does not show is nowhere.
bool targetInside(Events& events, const Node& node, const Region& region, Node& target,
                  Matrix& targetToSensor) {
  constexpr size_t places = 64; // a hostile world has more, and ends
  Interaction& interaction = interactionOf(events);
  const PickBox box = ownBounds(interaction.picker, target);
  if (box.empty()) return false;
  const Matrix view = interaction.viewer.view();
  const std::vector<Path> targets = pathsTo(target, places);
  for (const Path& path : pathsTo(node, places)) {
    Matrix toSensor;
    if (!invert(Picker::toWorld(path, view), toSensor)) continue;
    for (const Path& to : targets) {
      targetToSensor = compose(toSensor, Picker::toWorld(to, view));
      if (isChosen(to) && meets(region, box, targetToSensor)) return true;
    }
  }
  return false;
}

void lookTransform(Events& events, Node& node) {
  const auto& state = static_cast<const RegionState&>(*events.state(node));
  const auto& sensor = static_cast<nodes::TransformSensor&>(node);
  const Region region = regionOf(sensor);
  Node* const target = renderedNode(sensor.targetObject.get());
  // A box without volume senses nothing.
  const bool senses =
      sensor.enabled && target && region.half.x > 0 && region.half.y > 0 && region.half.z > 0;
  Matrix place;
  const bool inside = senses && targetInside(events, node, region, *target, place);
  const bool entered = inside && !state.active;
  if (inside != state.active) setActive(events, node, inside);
  if (inside) sendPlace(events, node, place, entered);
}

// Clips a convex polygon to the inner side of a plane through the eye (Sutherland and Hodgman
// 1974).
void clip(std::vector<Vector>& polygon, const Vector& inwards) {
  std::vector<Vector> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = a.dot(inwards), db = b.dot(inwards);
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  polygon = std::move(kept);
}

// Returns whether a part of the box's surface is in the view frustum, or the eye is in the box.
bool seen(const Region& region, const Matrix& toCamera, double fovy, double aspect) {
  std::array<Vector, 8> corner;
  for (int i = 0; i < 8; ++i)
    corner[size_t(i)] =
        transformPoint(toCamera, region.center + Vector(region.half.x * (i & 1 ? 1 : -1),
                                                        region.half.y * (i & 2 ? 1 : -1),
                                                        region.half.z * (i & 4 ? 1 : -1)));
  const double y = std::tan(fovy / 2), x = y * aspect;
  const std::array<Vector, 5> planes{Vector(1, 0, -x), Vector(-1, 0, -x), Vector(0, 1, -y),
                                     Vector(0, -1, -y), Vector(0, 0, -1)};
  constexpr std::array<std::array<size_t, 4>, 6> faces{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  for (const auto& face : faces) {
    std::vector<Vector> polygon{corner[face[0]], corner[face[1]], corner[face[2]], corner[face[3]]};
    for (const Vector& plane : planes) clip(polygon, plane);
    if (!polygon.empty()) return true;
  }
  Matrix toBox;
  if (!invert(toCamera, toBox)) return false;
  const Vector p = transformPoint(toBox, Vector(0)) - region.center;
  return std::abs(p.x) <= region.half.x && std::abs(p.y) <= region.half.y &&
         std::abs(p.z) <= region.half.z;
}

void lookVisibility(Events& events, Node& node) {
  const Interaction& interaction = interactionOf(events);
  const auto& sensor = static_cast<nodes::VisibilitySensor&>(node);
  const Region region = regionOf(sensor);
  bool visible = false;
  if (sensor.enabled) { // 6.54 has no rule for a box without extent: it is treated as a point
    const CameraSettings camera = interaction.viewer.camera(interaction.aspect);
    const Matrix view = fromArray(camera.matrix);
    Matrix toCamera;
    if (invert(view, toCamera))
      for (const Path& path : pathsTo(node))
        visible = visible || seen(region, compose(toCamera, Picker::toWorld(path, view)),
                                  camera.fovy, interaction.aspect);
  }
  if (visible != static_cast<RegionState&>(*events.state(node)).active)
    setActive(events, node, visible);
}

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  events.wantLooks(node, true);
  return std::make_unique<RegionState>();
}

// A sensor that is disabled sends isActive FALSE at once (4.6.7.2).
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  if (isField<"enabled">(node, in) && !std::get<bool>(value) &&
      static_cast<RegionState&>(*events.state(node)).active)
    setActive(events, node, false);
}

} // namespace

void addRegionBehaviours(const AddBehaviour& add) {
  add(nodes::ProximitySensor::nodeType(),
      {.begin = begin, .receive = receive, .look = lookProximity});
  add(nodes::TransformSensor::nodeType(),
      {.begin = begin, .receive = receive, .look = lookTransform});
  add(nodes::VisibilitySensor::nodeType(),
      {.begin = begin, .receive = receive, .look = lookVisibility});
}

} // namespace xvrml
