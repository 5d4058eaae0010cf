// drag.cpp: the drag sensors. A ray that misses the sensor's surface uses the nearest point of it.
// So a drag over the edge of a sphere or cylinder continues without a leap. Rays parallel to a
// plane are ignored.
#include "behaviour/viewer/drag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Imath/ImathMatrixAlgo.h>
#include <Imath/ImathQuat.h>

#include "behaviour/named_fields.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

constexpr double pi = std::numbers::pi;

// Returns false for huge coordinates and NaN.
bool usable(const Vector& v) {
  return std::abs(v.x) < 1e30 && std::abs(v.y) < 1e30 && std::abs(v.z) < 1e30;
}
Vec3f narrow(const Vector& v) { return {float(v.x), float(v.y), float(v.z)}; }

// Clamps a value. A limit applies only if its minimum is not above its maximum (6.15, 6.34).
double limited(double v, double lowest, double highest) {
  return lowest <= highest ? std::clamp(v, lowest, highest) : v;
}

// Intersects the ray with the plane through `point`. Returns false if it misses.
bool onPlane(const PickRay& ray, const Vector& point, const Vector& normal, Vector& out) {
  const double slope = ray.direction.dot(normal);
  const double t = (point - ray.origin).dot(normal) / slope;
  if (slope == 0 || !(t >= 0)) return false;
  out = ray.at(t);
  return usable(out);
}

// Returns the t at which origin + t direction has distance `radius` from 0: the nearer or the
// farther one. If there is none, it returns the t of closest approach.
double intersectRound(const Vector& origin, const Vector& direction, double radius, bool farther) {
  const double a = direction.dot(direction);
  const double middle = -origin.dot(direction) / a;
  const Vector foot = origin + direction * middle;
  const double half = std::sqrt(std::max(0.0, (radius * radius - foot.dot(foot)) / a));
  if (farther || middle - half < 0) return middle + half;
  return middle - half;
}

// Returns whether the press hit the far side of the round body.
bool isFar(const PickRay& ray, const Vector& fromAxis) { return ray.direction.dot(fromAxis) > 0; }

// The axes that a sensor of X3D turns with axisRotation (ISO/IEC 19775-1 20.4.1, 20.4.2). A drag
// works in the turned system; what is sent is in the sensor's own.
class Axes {
 public:
  explicit Axes(const Rotation& rotation) {
    Matrix inverse;
    const Matrix m = xvrml::rotation(rotation);
    if (!finite(m) || !invert(m, inverse)) return;
    out_ = m;
    in_ = inverse;
  }
  Vector in(const Vector& p) const { return transformPoint(in_, p); }
  Vector out(const Vector& p) const { return transformPoint(out_, p); }
  PickRay in(const PickRay& ray) const {
    PickRay turned = ray;
    turned.origin = in(ray.origin);
    turned.direction = in(ray.direction);
    return turned;
  }

 private:
  Matrix in_, out_;
};

class PlaneDrag final : public Drag {
 public:
  PlaneDrag(nodes::PlaneSensor& sensor, const Vector& point)
      : sensor_(sensor), axes_(sensor.axisRotation), start_(axes_.in(point)),
        offset_(axes_.in(vector(sensor.offset))) {}

  void move(Events& events, const PickRay& world) override {
    const PickRay ray = axes_.in(world);
    Vector p;
    if (!onPlane(ray, start_, {0, 0, 1}, p)) return;
    p.z = start_.z; // removes rounding
    Vector moved = p - start_ + offset_;
    moved.x = limited(moved.x, sensor_.minPosition.x, sensor_.maxPosition.x);
    moved.y = limited(moved.y, sensor_.minPosition.y, sensor_.maxPosition.y);
    last_ = narrow(axes_.out(moved));
    has_ = true;
    sendFrom<"trackPoint_changed">(events, sensor_, narrow(axes_.out(p)));
    sendFrom<"translation_changed">(events, sensor_, last_);
  }

  void end(Events& events) override {
    if (has_ && sensor_.autoOffset)
      events.post(sensor_, fieldOf<nodes::PlaneSensor>("offset"), last_);
  }

 private:
  nodes::PlaneSensor& sensor_;
  const Axes axes_;
  Vector start_, offset_;
  Vec3f last_;
  bool has_ = false;
};

// Returns the shortest rotation from direction a to direction b.
Matrix turn(const Vector& a, const Vector& b) {
  Vector axis = a.cross(b);
  if (!(axis.length() > 0))
    axis = a.cross(std::abs(a.y) < 0.9 * a.length() ? Vector(0, 1, 0) : Vector(1, 0, 0));
  return rotation(axis, std::atan2(a.cross(b).length(), a.dot(b)));
}

Rotation rotationOf(const Matrix& m) {
  Imath::Quatd q = Imath::extractQuat(m);
  if (q.r < 0) q = -q;
  const double angle = 2 * std::atan2(q.v.length(), q.r);
  if (!(q.v.length() > 1e-12)) return {0, 0, 1, 0};
  const Vector axis = q.v.normalized();
  return {float(axis.x), float(axis.y), float(axis.z), float(angle)};
}

class SphereDrag final : public Drag {
 public:
  SphereDrag(nodes::SphereSensor& sensor, const PickRay& ray, const Vector& point)
      : sensor_(sensor), start_(point), offset_(rotation(sensor.offset)), far_(isFar(ray, point)) {}

  void move(Events& events, const PickRay& ray) override {
    const double radius = start_.length();
    if (!(radius > 0)) return;
    Vector p = ray.at(intersectRound(ray.origin, ray.direction, radius, far_));
    if (!usable(p) || !(p.length() > 0)) return;
    p *= radius / p.length();
    last_ = rotationOf(compose(turn(start_, p), offset_));
    has_ = true;
    sendFrom<"trackPoint_changed">(events, sensor_, narrow(p));
    sendFrom<"rotation_changed">(events, sensor_, last_);
  }

  void end(Events& events) override {
    if (has_ && sensor_.autoOffset)
      events.post(sensor_, fieldOf<nodes::SphereSensor>("offset"), last_);
  }

 private:
  nodes::SphereSensor& sensor_;
  Vector start_;
  Matrix offset_;
  bool far_;
  Rotation last_;
  bool has_ = false;
};

class CylinderDrag final : public Drag {
 public:
  CylinderDrag(nodes::CylinderSensor& sensor, const PickRay& world, const Vector& pressed)
      : sensor_(sensor), axes_(sensor.axisRotation), start_(axes_.in(pressed)),
        offset_(sensor.offset) {
    const PickRay ray = axes_.in(world);
    const Vector& point = start_;
    const Vector flat(ray.direction.x, 0, ray.direction.z);
    disk_ = std::atan2(flat.length(), std::abs(ray.direction.y)) < double(sensor.diskAngle);
    far_ = isFar(ray, {point.x, 0, point.z});
    angle_ = around(point);
  }

  void move(Events& events, const PickRay& world) override {
    const PickRay ray = axes_.in(world);
    Vector p;
    if (!(disk_ ? onDisk(ray, p) : onCylinder(ray, p))) return;
    // Use the angle nearest to the last one: a drag may go round more than once.
    turned_ += std::remainder(around(p) - angle_, 2 * pi);
    angle_ = around(p);
    last_ = float(limited(turned_ + offset_, sensor_.minAngle, sensor_.maxAngle));
    has_ = true;
    const Vec3f axis = narrow(axes_.out({0, 1, 0}));
    sendFrom<"trackPoint_changed">(events, sensor_, narrow(axes_.out(p)));
    sendFrom<"rotation_changed">(events, sensor_, Rotation{axis.x, axis.y, axis.z, last_});
  }

  void end(Events& events) override {
    if (has_ && sensor_.autoOffset)
      events.post(sensor_, fieldOf<nodes::CylinderSensor>("offset"), last_);
  }

 private:
  static double around(const Vector& p) { return std::atan2(p.x, p.z); } // angle about +y, from +z

  bool onDisk(const PickRay& ray, Vector& p) const {
    if (!onPlane(ray, start_, {0, 1, 0}, p)) return false;
    p.y = start_.y;
    return p.x != 0 || p.z != 0;
  }

  bool onCylinder(const PickRay& ray, Vector& p) const {
    const Vector origin(ray.origin.x, 0, ray.origin.z),
        direction(ray.direction.x, 0, ray.direction.z);
    const double radius = std::hypot(start_.x, start_.z);
    if (!(radius > 0) || !(direction.length() > 0)) return false;
    p = ray.at(intersectRound(origin, direction, radius, far_));
    const double away = std::hypot(p.x, p.z);
    if (!usable(p) || !(away > 0)) return false;
    p.x *= radius / away;
    p.z *= radius / away;
    return true;
  }

  nodes::CylinderSensor& sensor_;
  const Axes axes_;
  Vector start_;
  double offset_, angle_ = 0, turned_ = 0;
  bool disk_ = false, far_ = false;
  float last_ = 0;
  bool has_ = false;
};

} // namespace

std::unique_ptr<Drag> beginDrag(Node& sensor, const PickRay& ray, const Vector& point) {
  if (auto* plane = nodeCast<nodes::PlaneSensor>(&sensor))
    return std::make_unique<PlaneDrag>(*plane, point);
  if (auto* sphere = nodeCast<nodes::SphereSensor>(&sensor))
    return std::make_unique<SphereDrag>(*sphere, ray, point);
  if (auto* cylinder = nodeCast<nodes::CylinderSensor>(&sensor))
    return std::make_unique<CylinderDrag>(*cylinder, ray, point);
  return nullptr;
}

} // namespace xvrml
