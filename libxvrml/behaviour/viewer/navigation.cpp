// navigation.cpp: the Navigator: NavigationInfo, collisions and keys.
#include "behaviour/viewer/navigation.h"

#include <algorithm>
#include <cmath>

#include "behaviour/named_fields.h"
#include "behaviour/viewer/interaction.h"
#include "nodes/viewpoint.h"
#include "xvrml/browser.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

bool contains(const std::vector<Node*>& nodes, const Node* node) {
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

} // namespace

// Lengths are in the coordinate system around the Viewpoint (6.29); up is its y axis (6.53).
Avatar Navigator::avatarAt(const Node* viewpoint, const Vector& upWithoutViewpoint) const {
  Avatar a;
  const auto* info = nodeCast<nodes::NavigationInfo>(interaction_.binding.bound().navigationInfo);
  const Matrix outside = Viewer::surroundingsOf(viewpoint);
  const double scale = std::cbrt(std::abs(determinant(outside)));
  if (info) {
    const auto length = [&](size_t i, double otherwise) {
      return i < info->avatarSize.size() && info->avatarSize[i] >= 0 ? double(info->avatarSize[i])
                                                                     : otherwise;
    };
    a.distance = length(0, a.distance);
    a.height = length(1, a.height);
    a.step = length(2, a.step);
    a.speed = info->speed;
  }
  if (scale > 0 && std::isfinite(scale))
    for (double* v : {&a.distance, &a.height, &a.step, &a.speed, &a.gravity}) *v *= scale;
  const Vector up = viewpoint ? transformDirection(outside, {0, 1, 0}) : upWithoutViewpoint;
  if (up.length() > 0) a.up = up.normalized();
  return a;
}

bool Navigator::findObstacle(const PickRay& ray, const Matrix& view, bool touch, double& t,
                             Vector& normal) {
  Hit hit;
  if (!interaction_.picker.pick(ray, {.collision = true, .bothSides = true, .mayLag = true}, view,
                                interaction_.scope->roots, hit))
    return false;
  t = hit.t;
  normal = hit.normal;
  if (touch)
    for (const Hit::Step& step : hit.path)
      if (step.node->type().index == nodes::Collision::typeIndex) {
        sendFrom<"collideTime">(interaction_.engine, *step.node, interaction_.engine.now());
        if (!contains(touched_, step.node)) touched_.push_back(step.node);
      }
  return true;
}

// Sends isActive of the Collision nodes that the viewer has begun or ceased to touch (ISO/IEC
// 19775-1 23.4.2).
void Navigator::tellTouches() {
  for (Node* node : active_)
    if (!contains(touched_, node)) sendFrom<"isActive">(interaction_.engine, *node, false);
  for (Node* node : touched_)
    if (!contains(active_, node)) sendFrom<"isActive">(interaction_.engine, *node, true);
  active_ = touched_;
}

void Navigator::forget(const Node& node) {
  std::erase(touched_, &node);
  std::erase(active_, &node);
}

// Returns the centre of rotation for EXAMINE. A viewpoint of X3D says it (ISO/IEC 19775-1 23.3.1).
// Otherwise it lies on the line of sight, so the view does not
// change. Its distance is that of the centre of the Shape in the middle of the picture, else of the
// world. If the world's centre is not ahead, that centre itself is used.
Vector Navigator::centerOf(const Matrix& view) {
  const Node* viewpoint = interaction_.binding.bound().viewpoint;
  if (const auto fields = viewpointFields(viewpoint);
      fields && fields->centerOfRotation && versionOf(*viewpoint).isX3d())
    return transformPoint(Viewer::surroundingsOf(viewpoint), vector(*fields->centerOfRotation));
  Picker& picker = interaction_.picker;
  const Vector eye(view.x[3][0], view.x[3][1], view.x[3][2]),
      back(view.x[2][0], view.x[2][1], view.x[2][2]);
  const auto& roots = interaction_.scope->roots;
  PickBox box = picker.bounds(roots, true);
  if (box.empty()) return eye - back * 10;
  Vector center = (box.low + box.high) / 2;
  if (Hit hit; picker.pick({eye, -back}, {.bothSides = true, .mayLag = true}, view, roots, hit)) {
    box = picker.bounds({NodeRef(hit.path.back().node)}, true);
    center = transformPoint(hit.path.back().toWorld, (box.low + box.high) / 2);
  }
  if (const double ahead = (eye - center).dot(back); ahead > 0) return eye - back * ahead;
  return (eye - center).length() > 0 ? center : eye - back;
}

Motion Navigator::moved(const Motion& from, Navigation type, const Avatar& avatar,
                        const NavigationInput& input, double seconds, Touches touches) {
  if (!interaction_.scope) return from;
  const Obstacle obstacle = [&](const PickRay& ray, bool touch, double& t, Vector& normal) {
    return findObstacle(ray, from.view, touch && touches == Touches::sent, t, normal);
  };
  Motion to = from;
  switch (type) {
  case Navigation::none: break;
  case Navigation::walk: to = walk(from, input, seconds, avatar, obstacle); break;
  case Navigation::fly: to = fly(from, input, seconds, avatar, obstacle); break;
  case Navigation::examine:
    if (!to.hasCenter) to.center = centerOf(to.view);
    to.hasCenter = true;
    to = examine(to, input, seconds, avatar);
    break;
  }
  return finite(to.view) ? to : from;
}

void Navigator::move(const NavigationInput& input, double seconds) {
  if (!interaction_.scope || interaction_.viewer.inTransition()) return;
  motion_.view = interaction_.viewer.view();
  const Avatar avatar = avatarAt(interaction_.binding.bound().viewpoint, up_);
  touched_.clear();
  const Motion to = moved(motion_, type(), avatar, input, seconds, Touches::sent);
  tellTouches();
  const bool elsewhere = to.view != motion_.view;
  motion_ = to;
  if (elsewhere) interaction_.viewer.moveTo(to.view);
}

namespace {

struct NavigationName {
  std::string_view name;
  Navigation type;
};
constexpr NavigationName known[] = {{"NONE", Navigation::none},
                                    {"WALK", Navigation::walk},
                                    {"FLY", Navigation::fly},
                                    {"EXAMINE", Navigation::examine}};

} // namespace

Navigation Navigator::type() const { return typeFor(chosen_); }

Navigation Navigator::typeFor(std::optional<Navigation> chosen) const {
  const auto* info = nodeCast<nodes::NavigationInfo>(interaction_.binding.bound().navigationInfo);
  Browser* browser = interaction_.engine.browser();
  const bool x3d = browser && browser->world().head.version.isX3d();
  const MFString standard{x3d ? "EXAMINE" : "WALK", "ANY"}; // defaults of 6.29 and of X3D's 23.4.4
  const MFString& list = info ? info->type : standard;
  const auto lists = [&](std::string_view name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  if (chosen)
    for (const NavigationName& k : known)
      if (k.type == *chosen && (lists(k.name) || lists("ANY"))) return *chosen;
  for (const std::string& name : list) {
    if (name == "ANY") return Navigation::walk;
    for (const NavigationName& k : known)
      if (k.name == name) return k.type;
  }
  return Navigation::none;
}

bool Navigator::choose(Navigation wanted) {
  chosen_ = wanted;
  resetMotion();
  return type() == wanted;
}

void Navigator::key(Key key, bool pressed) {
  if (!pressed) {
    held_.erase(key);
    return;
  }
  if (key == Key::home) return interaction_.viewer.reset();
  if (key != Key::pageUp && key != Key::pageDown) {
    held_.insert(key);
    return;
  }
  std::vector<Node*> all = interaction_.binding.viewpoints(*interaction_.scope), list;
  for (Node* node : all)
    if (!viewpointFields(node)->description.empty()) list.push_back(node);
  if (list.empty()) list = all;
  if (list.empty()) return;
  const auto at = std::find(list.begin(), list.end(), interaction_.binding.bound().viewpoint);
  const size_t count = list.size(), i = size_t(at - list.begin());
  const size_t next =
      key == Key::pageDown ? (at == list.end() ? 0 : (i + 1) % count) : (i + count - 1) % count;
  interaction_.binding.set(*list[at == list.end() && key == Key::pageUp ? count - 1 : next], true);
}

void Navigator::ticked() {
  const double now = interaction_.engine.now(), seconds = now - lastTick_;
  lastTick_ = now;
  const auto held = [&](Key key) { return held_.contains(key) ? 1.0 : 0.0; };
  const double across = held(Key::right) - held(Key::left), along = held(Key::up) - held(Key::down);
  if (!(seconds > 0) || (across == 0 && along == 0)) return;
  NavigationInput input;
  const double speed = held_.contains(Key::shift) ? 4 : 1;
  if (held_.contains(Key::alt)) {
    input.right = across * speed;
    input.up = along * speed;
  } else {
    input.turn = -across;
    input.ahead = along * speed;
  }
  move(input, seconds);
}

} // namespace xvrml
