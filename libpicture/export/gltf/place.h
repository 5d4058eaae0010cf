// place.h: The matrices of nodes as translations, rotations and scales, which glTF wants. Pure
// functions. [any thread]
#pragma once

#include <vector>

#include "libpicture/export/gltf/document.h"
#include "libpicture/vec.h"
#include "xvrml/types.h"

namespace picture::gltf {

// A rotation as a unit quaternion x y z w.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
// Returns the rotation of a field. One without an axis, or by no finite angle, is none.
Quaternion quaternionOf(const xvrml::Rotation& rotation);
// Returns the rotation in the first three columns of a column-major matrix, which may scale alike
// in all directions.
Quaternion quaternionOf(const double matrix[16]);
// Returns the rotation that turns (0, 0, -1) to a direction of any length.
Quaternion quaternionToward(const xvrml::Vec3f& direction);
Quaternion inverse(const Quaternion& q);
Quaternion operator*(const Quaternion& a, const Quaternion& b); // b acts first
Vec rotated(const Quaternion& q, const Vec& v);
inline double dot(const Quaternion& a, const Quaternion& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
// Returns the rotation at a fraction of the way from one to another, on the side on which the
// quaternions stand (K. Shoemake, "Animating Rotation with Quaternion Curves", 1985).
Quaternion between(const Quaternion& a, const Quaternion& b, double fraction);

// The place of a node: scale acts first, translation last.
struct Place {
  Vec translation;
  Quaternion rotation;
  Vec scale{1, 1, 1};
};

// The fields of a Transform or CADPart.
struct TransformFields {
  xvrml::Vec3f center, translation, scale{1, 1, 1};
  xvrml::Rotation rotation, scaleOrientation;
};

// Where the fields that can be animated are in a list of places.
struct Places {
  std::vector<Place> chain; // each holds the next one; all together are the matrix of the Transform
  size_t scaleAt = 0;       // place with the field scale; translation and rotation are in the first
};
// Returns the places that make up the matrix T C R SR S -SR -C of a Transform (ISO/IEC 14772-1
// 6.52): one, or several where a single one cannot say it. moves: the fields translation, rotation
// and scale shall be places of their own, because they are animated; the first translation is then
// that of the Transform plus its center.
Places placesOf(const TransformFields& fields, bool moves);

// Sets the members of a node, without those that have their defaults.
void setPlace(Json& node, const Place& place);

} // namespace picture::gltf
