// motion.cpp: WALK, FLY and EXAMINE as pure functions (clause 6.29). Time is divided into steps of
// at most a thirtieth of a second. So a long frame cannot move the viewer through a wall.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "behaviour/viewer/navigation.h"

namespace xvrml {
namespace {

constexpr double quarter = std::numbers::pi / 2;
// The limit for looking up or down without turning over.
constexpr double steepest = 85 * std::numbers::pi / 180;

Vector axis(const Matrix& m, int i) { return {m.x[i][0], m.x[i][1], m.x[i][2]}; }
Vector eyeOf(const Matrix& m) { return axis(m, 3); }
void setEye(Matrix& m, const Vector& eye) {
  m.x[3][0] = eye.x;
  m.x[3][1] = eye.y;
  m.x[3][2] = eye.z;
}

Matrix turned(const Matrix& view, const Vector& about, const Vector& point, double angle) {
  return compose(compose(translation(point), rotation(about, angle)),
                 compose(translation(-point), view));
}

// Tilts about `point` and the view's x axis, as far as the view stays upright.
Matrix tilted(const Matrix& view, const Vector& point, double angle, const Vector& up,
              double limit) {
  const double height = std::asin(std::clamp(-axis(view, 2).dot(up), -1.0, 1.0));
  const double wanted =
      std::clamp(height + angle, std::min(height, -limit), std::max(height, limit));
  return turned(view, axis(view, 0), point, wanted - height);
}

int stepsFor(double seconds) { return int(std::clamp(std::ceil(seconds * 30), 1.0, 300.0)); }

double usable(double v) { return std::isfinite(v) ? v : 0; }
NavigationInput usable(const NavigationInput& in) {
  return {usable(in.ahead), usable(in.right), usable(in.up),
          usable(in.turn),  usable(in.tilt),  usable(in.roll)};
}

// Surfaces that are less steep than this are ground to the knees, not walls: avatarSize[2] bounds
// the objects that one steps over, not the ramps that one follows (6.29).
const double steepestGround = std::cos(45 * std::numbers::pi / 180);

// A part of the body that collides with walls. knees: the lowest part, which meets ramps.
struct BodyPart {
  Vector offset;
  bool knees = false;
};

// Returns the room along `direction` before a hit at distance t: the eye stays `distance` away from
// the plane of the wall, also where it comes aslant. On a grazing course that would be far before
// the wall, which may not reach there: then it is mostLead distances before it.
constexpr double mostLead = 4;
double roomBefore(double t, const Vector& normal, const Vector& direction, double distance) {
  return std::max(0.0, t - distance / std::max(std::abs(normal.dot(direction)), 1 / mostLead));
}

// Returns the motion from `eye` along `wish`. It stays `distance` away from walls and slides along
// them. level: if not null, walls deflect the motion only about this axis.
Vector slide(const Vector& eye, Vector wish, std::initializer_list<BodyPart> parts, double distance,
             const Vector* level, const Obstacle& obstacle) {
  Vector moved(0);
  for (int wall = 0; wall < 3; ++wall) {
    const double length = wish.length();
    if (!(length > 1e-12)) break;
    const Vector direction = wish / length;
    double allowed = length;
    Vector normal(0);
    bool blocked = false;
    for (const BodyPart& part : parts) {
      const PickRay ray{eye + part.offset + moved, direction, 0, length + mostLead * distance};
      double t;
      Vector n;
      if (!obstacle(ray, false, t, n)) continue;
      if (part.knees && level && std::abs(level->dot(n)) > steepestGround) continue;
      const double room = roomBefore(t, n, direction, distance);
      if (room >= length) continue;
      obstacle(ray, true, t, n); // it is near enough for a collision
      if (blocked && room >= allowed) continue;
      allowed = room;
      normal = n;
      blocked = true;
    }
    moved += direction * allowed;
    if (!blocked) break;
    if (level) normal -= *level * level->dot(normal);
    if (!(normal.length() > 1e-9)) break;
    normal.normalize();
    const Vector rest = direction * (length - allowed);
    wish = rest - normal * rest.dot(normal);
  }
  return moved;
}

// Returns the horizontal direction of view. If the view is straight up or down, it is that of the
// view's upper edge.
Vector headingOf(const Matrix& view, const Vector& up) {
  const Vector forward = -axis(view, 2);
  Vector flat = forward - up * up.dot(forward);
  if (!(flat.length() > 1e-6)) {
    flat = axis(view, 1) * (up.dot(forward) > 0 ? -1 : 1);
    flat -= up * up.dot(flat);
  }
  return flat.normalized();
}

// Applies gravity and steps: returns where the eye ends after moving from `eye` by `moved`.
Vector settle(const Vector& eye, const Vector& moved, double seconds, const Avatar& a,
              const Obstacle& obstacle, double& fall) {
  const auto floorUnder =
      [&](const Vector& from,
          double& gap) { // distance from the feet down to the floor, negative below it
        double t;
        Vector n;
        if (!obstacle({from, -a.up, 0, std::numeric_limits<double>::infinity()}, false, t, n))
          return false;
        gap = t - a.height;
        return true;
      };
  double before = 0, after = 0;
  const bool stood = floorUnder(eye, before);
  Vector to = eye + moved;
  bool stands = floorUnder(to, after);
  // Higher than a step, and steeper than ground: a wall.
  if (stands && after < 0 &&
      std::min(stood ? before : 0, 0.0) - after > std::max(a.step, moved.length())) {
    to = eye;
    after = before;
    stands = stood;
  }
  if (!stands) { // no floor at any depth: the viewer does not fall out of the world
    fall = 0;
  } else if (after <= 0 || (after <= a.step && fall == 0)) {
    to -= a.up * after;
    fall = 0;
  } else {
    fall += a.gravity * seconds;
    const double drop = std::min(fall * seconds, after);
    to -= a.up * drop;
    if (drop == after) fall = 0;
  }
  return to;
}

} // namespace

Motion walk(const Motion& from, const NavigationInput& raw, double seconds, const Avatar& a,
            const Obstacle& obstacle) {
  Motion m = from;
  if (!(seconds > 0) || !std::isfinite(seconds)) return m;
  const NavigationInput in = usable(raw);
  const int steps = stepsFor(seconds);
  const double s = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector eye = eyeOf(m.view);
    m.view = turned(m.view, a.up, eye, in.turn * quarter * s);
    m.view = tilted(m.view, eye, in.tilt * quarter * s, a.up, steepest);
    const Vector ahead = headingOf(m.view, a.up), right = ahead.cross(a.up);
    const Vector wish = (ahead * in.ahead + right * in.right) * (a.speed * s);
    const Vector knee = -a.up * (std::max(0.0, a.height - a.step) * 0.999);
    if (!(a.speed > 0)) continue; // the position stays (6.29): no gravity, either
    const Vector moved =
        slide(eye, wish, {{Vector(0)}, {knee / 2}, {knee, true}}, a.distance, &a.up, obstacle);
    setEye(m.view, settle(eye, moved, s, a, obstacle, m.fall));
  }
  return m;
}

Motion fly(const Motion& from, const NavigationInput& raw, double seconds, const Avatar& a,
           const Obstacle& obstacle) {
  Motion m = from;
  m.fall = 0;
  if (!(seconds > 0) || !std::isfinite(seconds)) return m;
  const NavigationInput in = usable(raw);
  const int steps = stepsFor(seconds);
  const double s = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector eye = eyeOf(m.view);
    m.view = turned(m.view, a.up, eye, in.turn * quarter * s);
    m.view = turned(m.view, axis(m.view, 0), eye, in.tilt * quarter * s);
    m.view = turned(m.view, axis(m.view, 2), eye, -in.roll * quarter * s);
    const Vector wish =
        (axis(m.view, 0) * in.right + axis(m.view, 1) * in.up - axis(m.view, 2) * in.ahead) *
        (a.speed * s);
    setEye(m.view, eye + slide(eye, wish, {{Vector(0)}}, a.distance, nullptr, obstacle));
  }
  return m;
}

Motion examine(const Motion& from, const NavigationInput& raw, double seconds, const Avatar& a) {
  Motion m = from;
  m.fall = 0;
  if (!(seconds > 0) || !std::isfinite(seconds)) return m;
  const NavigationInput in = usable(raw);
  m.view = turned(m.view, a.up, m.center, in.turn * quarter * seconds);
  m.view = tilted(m.view, m.center, in.tilt * quarter * seconds, a.up, 89 * std::numbers::pi / 180);
  const Vector away = eyeOf(m.view) - m.center;
  const Vector pan =
      (axis(m.view, 0) * in.right + axis(m.view, 1) * in.up) * (away.length() * seconds);
  m.center += pan;
  setEye(m.view, m.center + away * std::exp(std::clamp(-in.ahead * seconds, -20.0, 20.0)));
  return m;
}

} // namespace xvrml
