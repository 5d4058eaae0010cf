#include "libpicture/export/gltf/place.h"

#include <algorithm>
#include <cmath>

namespace picture::gltf {

using xvrml::Vec3f;

namespace {

Vec vecOf(const Vec3f& v) { return {v.x, v.y, v.z}; }

bool isFinite(const Vec& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Quaternion unit(const Quaternion& q) {
  const double length = std::sqrt(dot(q, q));
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

} // namespace

Quaternion quaternionOf(const xvrml::Rotation& r) {
  const double length = std::hypot(double(r.x), double(r.y), double(r.z));
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(r.angle)) return {};
  const double s = std::sin(0.5 * double(r.angle)) / length;
  return {r.x * s, r.y * s, r.z * s, std::cos(0.5 * double(r.angle))};
}

// Shepperd's method: the largest of the four squares is the one to divide by.
Quaternion quaternionOf(const double m[16]) {
  const double size =
      std::cbrt(m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
                m[8] * (m[1] * m[6] - m[2] * m[5]));
  if (!(size > 0) || !std::isfinite(size)) return {};
  const auto at = [&](int row, int column) { return m[4 * column + row] / size; };
  const double xx = at(0, 0), yy = at(1, 1), zz = at(2, 2);
  const double squares[4] = {1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz,
                             1 + xx + yy + zz};
  switch (std::max_element(squares, squares + 4) - squares) {
  case 0: return unit({squares[0], at(0, 1) + at(1, 0), at(0, 2) + at(2, 0), at(2, 1) - at(1, 2)});
  case 1: return unit({at(0, 1) + at(1, 0), squares[1], at(1, 2) + at(2, 1), at(0, 2) - at(2, 0)});
  case 2: return unit({at(0, 2) + at(2, 0), at(1, 2) + at(2, 1), squares[2], at(1, 0) - at(0, 1)});
  default: return unit({at(2, 1) - at(1, 2), at(0, 2) - at(2, 0), at(1, 0) - at(0, 1), squares[3]});
  }
}

Quaternion quaternionToward(const Vec3f& direction) {
  const Vec d = vecOf(direction);
  const double size = length(d);
  if (!(size > 0) || !std::isfinite(size)) return {};
  const Vec to = d / size;
  if (to.z > 1 - 1e-9) return {0, 1, 0, 0}; // half a turn
  const Vec axis = cross({0, 0, -1}, to);
  return unit({axis.x, axis.y, axis.z, 1 - to.z});
}

Quaternion inverse(const Quaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Vec rotated(const Quaternion& q, const Vec& v) {
  const Vec axis{q.x, q.y, q.z};
  const Vec twice = cross(axis, v) * 2;
  return v + twice * q.w + cross(axis, twice);
}

Quaternion between(const Quaternion& a, const Quaternion& b, double fraction) {
  const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0)), sine = std::sin(angle);
  double ofA = 1 - fraction, ofB = fraction;
  if (constexpr double least = 1e-6; sine > least) {
    ofA = std::sin(ofA * angle) / sine;
    ofB = std::sin(ofB * angle) / sine;
  }
  return unit(
      {ofA * a.x + ofB * b.x, ofA * a.y + ofB * b.y, ofA * a.z + ofB * b.z, ofA * a.w + ofB * b.w});
}

Places placesOf(const TransformFields& fields, bool moves) {
  const Vec center = vecOf(fields.center), scale = vecOf(fields.scale);
  const Quaternion turn = quaternionOf(fields.rotation),
                   axes = quaternionOf(fields.scaleOrientation);
  const Vec pivot = vecOf(fields.translation) + center, back = center * -1.0;
  if (!isFinite(pivot) || !isFinite(scale)) return {{Place{}}, 0};
  const bool even = scale.x == scale.y && scale.y == scale.z;
  if (std::abs(axes.w) < 1 && (moves || !even)) {
    const Quaternion undone = inverse(axes);
    return {{{pivot, turn, {1, 1, 1}},
             {{0, 0, 0}, axes, scale},
             {rotated(undone, back), undone, {1, 1, 1}}},
            1};
  }
  if (moves) {
    Places places{{{pivot, turn, scale}}, 0};
    if (length(center) > 0) places.chain.push_back({back, {}, {1, 1, 1}});
    return places;
  }
  const Vec scaled{back.x * scale.x, back.y * scale.y, back.z * scale.z};
  return {{{pivot + rotated(turn, scaled), turn, scale}}, 0};
}

// Numbers that are too large for a float are left out: JSON has no infinity.
void setPlace(Json& node, const Place& place) {
  const auto set = [&](const char* name, const Vec& v, double otherwise) {
    if (v.x == otherwise && v.y == otherwise && v.z == otherwise) return;
    const Vec3f numbers{float(v.x), float(v.y), float(v.z)};
    if (isFinite(vecOf(numbers))) node[name] = {numbers.x, numbers.y, numbers.z};
  };
  const Quaternion& q = place.rotation;
  set("translation", place.translation, 0);
  if (std::abs(q.w) < 1) node["rotation"] = {float(q.x), float(q.y), float(q.z), float(q.w)};
  set("scale", place.scale, 1);
}

} // namespace picture::gltf
