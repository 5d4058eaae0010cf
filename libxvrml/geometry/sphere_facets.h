// sphere_facets.h: a sphere as triangles, where one of OpenRT cannot be used. Any thread.
#pragma once

#include "geometry/mesh.h"

namespace xvrml {

// Returns a sphere with this many rows of facets, and twice as many columns. Its texture is that of
// a Sphere (clause 6.43).
Mesh sphereFacets(float radius, uint32_t rows);
// Makes the sphere of the ray tracer such triangles. Another mesh stays as it is.
void facetSphere(Mesh& mesh, uint32_t rows);

} // namespace xvrml
