// half_space.h: half-spaces and what of a mesh lies in them (X3D's ClipPlane). Pure functions, any
// thread.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/matrix.h"
#include "geometry/mesh.h"
#include "xvrml/nodes.h"

namespace xvrml {

// The points p with normal.dot(p) + offset >= 0.
struct HalfSpace {
  Vector normal{0, 1, 0}; // has any length but 0
  double offset = 0;

  double distance(const Vector& p) const { return normal.dot(p) + offset; } // in lengths of normal
  bool operator==(const HalfSpace&) const = default;
};
using HalfSpaces = std::vector<HalfSpace>;

// How many ClipPlanes cut a shape, from the root down; others have no effect (docs/limits.md).
inline constexpr size_t maximumClipPlanes = 16;

// Returns what a ClipPlane leaves, in coordinates of its parent group. Nothing if it is off, or if
// its numbers are not finite or make no plane.
std::optional<HalfSpace> halfSpaceOf(const nodes::ClipPlane& node);
// Returns the message about numbers of a ClipPlane that make no plane; "" if they do.
std::string faultOf(const nodes::ClipPlane& node);

// Returns a half-space in the coordinates that `toOutside` maps to those of `outside`.
HalfSpace inside(const HalfSpace& outside, const Matrix& toOutside);

enum class Cut : uint8_t {
  whole,   // all of the mesh is left; there is no result, so that the mesh itself is drawn
  part,    // the result is left
  nothing, // nothing is left
  tooLarge // there is no result, because it might have more than `most` parts
};
// Finds what of a mesh lies in all of the half-spaces (32 at most). Triangles and lines are cut at
// the planes, and what is interpolated along their edges stays as it was: new normals are not of
// unit length. Colours are mixed as they are. Triangles that share an edge still do. Spheres and
// exact surfaces are cut as facets. most: limit on triangles, lines or points.
Cut cut(const Mesh& mesh, std::span<const HalfSpace> halfSpaces, uint64_t most, Mesh& result);

} // namespace xvrml
