// round.h: helpers for Cone and Cylinder: vertices around the y axis with exact normals and the
// standard's texture coordinates.
#pragma once

#include "geometry/mesh.h"

namespace xvrml {

// With 64 sides a circle's silhouette is off by at most 0.12 % of the radius.
inline constexpr int roundSegments = 64;

// Returns (x, z) on the unit circle at fraction s of a turn: from the back (-z), counterclockwise
// as seen from above.
Vec2f aroundAxis(double s);

void addVertex(Mesh& mesh, const Vec3f& point, const Vec3f& normal, const Vec2f& texCoord);
// Adds a triangle unless its area is zero.
void addTriangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c);
// Adds a disc at height y that faces up or down. Its texture is the disc inscribed in the texture
// square.
void addDisc(Mesh& mesh, float y, float radius, bool up);
// Returns whether the ray tracer takes a body of this radius and height as an equation (rtQuadric,
// rtAsphere). Others are drawn with facets.
bool hasExactSize(double radius, double height);
// Add the exact surfaces of the same bodies: the side of a cone or cylinder about the y axis, from
// y = low to y = high, and a disc that faces up or down.
void addExactSide(Mesh& mesh, double lowRadius, double highRadius, double low, double high);
void addExactDisc(Mesh& mesh, double y, double radius, bool up);
// Sets kind and views. Returns an empty mesh if there are no triangles.
Mesh finishRound(Mesh&& mesh);

} // namespace xvrml
