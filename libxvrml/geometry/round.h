// round.h: the parts of Cone and Cylinder: vertices around the y axis with exact normals and the
// textures of the standard.
#pragma once

#include "geometry/mesh.h"

namespace xvrml {

// Silhouettes of a circle of 64 sides are off by 0.12 % of the radius at most.
inline constexpr int roundSegments = 64;

// (x, z) of the unit circle at fraction s of the way round: from the back (-z), counterclockwise as
// seen from above.
Vec2f aroundAxis(double s);

void addVertex(Mesh& mesh, const Vec3f& point, const Vec3f& normal, const Vec2f& texCoord);
// Leaves out what has no area.
void addTriangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c);
// A disc at height y that faces up or down; the texture is a disc cut out of the square.
void addDisc(Mesh& mesh, float y, float radius, bool up);
// Kind and views; an empty mesh if there are no triangles.
Mesh finishRound(Mesh&& mesh);

} // namespace xvrml
