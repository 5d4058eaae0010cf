// texture_places.cpp: texture coordinates in space: those of nodes, and those that geometry without
// such nodes has.
#include "geometry/texture_places.h"

#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"
#include "geometry/builders.h"
#include "geometry/sphere_facets.h"
#include "geometry/texture_generator.h"
#include "geometry/vector_math.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

constexpr uint32_t sphereRows = 64; // the silhouette is off by at most 0.03 % of the radius

float number(double v) { return std::isfinite(v) ? float(std::clamp(v, -1e30, 1e30)) : 0.0f; }

void add(TexCoordValues& values, const Vec4f& p) {
  const bool valid =
      std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.w);
  const Vec4f place = valid ? p : Vec4f();
  const double q = place.w != 0 ? double(place.w) : 1;
  values.places.push_back(place);
  values.own.push_back({number(place.x / q), number(place.y / q)});
}

// Returns whether the geometry has texture coordinates of two numbers.
bool isPlacedOnPicture(Node& geometry) {
  const NodeRef* texCoord = texCoordOf(geometry);
  Node* given = texCoord ? firstTextureCoordinate(*texCoord) : nullptr;
  if (const auto* flat = nodeCast<nodes::TextureCoordinate>(given)) return !flat->point.empty();
  return nodeCast<nodes::NurbsTextureCoordinate>(given) != nullptr;
}

Vec4f inBox(const Vec3f& p, const Box3& box) {
  const auto part = [](double from, double v, double to) {
    return to != from ? number((v - from) / (to - from)) : 0.0f;
  };
  return {part(box.minimum.x, p.x, box.maximum.x), part(box.minimum.y, p.y, box.maximum.y),
          part(box.maximum.z, p.z, box.minimum.z), 1};
}

} // namespace

TexCoordValues textureCoordinates(const NodeRef& node) {
  TexCoordValues values;
  Node* given = firstTextureCoordinate(node);
  if (const auto* flat = nodeCast<nodes::TextureCoordinate>(given)) {
    values.points = flat->point;
    return values;
  }
  if (const auto* inSpace = nodeCast<nodes::TextureCoordinate3D>(given))
    for (const Vec3f& p : inSpace->point) add(values, {p.x, p.y, p.z, 1});
  else if (const auto* homogeneous = nodeCast<nodes::TextureCoordinate4D>(given))
    for (const Vec4f& p : homogeneous->point) add(values, p);
  values.points = values.own;
  return values;
}

bool hasTexPlaces(Node& geometry) {
  Node* node = renderedNode(&geometry);
  const NodeRef* texCoord = node ? texCoordOf(*node) : nullptr;
  Node* given = texCoord ? firstTextureCoordinate(*texCoord) : nullptr;
  return nodeCast<nodes::TextureCoordinate3D>(given) || nodeCast<nodes::TextureCoordinate4D>(given);
}

void placeInVolume(Node& geometry, const MeshOptions& options, Mesh& mesh) {
  if (!options.needTexPlaces) return;
  facetSphere(mesh, sphereRows);
  if (mesh.kind != Mesh::Kind::triangles) return;
  mesh.exact.clear();
  if (!mesh.texPlaces.empty()) return;
  const bool onPicture = !mesh.texCoords.empty() && isPlacedOnPicture(geometry);
  const Box3 box = boundsOf(mesh.points, mesh.indices);
  mesh.ownTexPlaces.reserve(mesh.points.size());
  for (size_t i = 0; i < mesh.points.size(); ++i)
    mesh.ownTexPlaces.push_back(onPicture ? Vec4f{mesh.texCoords[i].x, mesh.texCoords[i].y, 0, 1}
                                          : inBox(mesh.points[i], box));
  mesh.texPlaces = mesh.ownTexPlaces;
}

} // namespace xvrml
