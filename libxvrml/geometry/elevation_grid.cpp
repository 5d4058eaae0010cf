// elevation_grid.cpp: ElevationGrid (clause 6.17), a grid of heights over the xz plane, and
// GeoElevationGrid (ISO/IEC 19775-1 25.3.2), one over a globe, as quadrilaterals.
#include <cmath>
#include <optional>
#include <type_traits>

#include "base/globe.h"
#include "geometry/builders.h"
#include "geometry/node_matrix.h"
#include "geometry/polygons/face_set.h"

namespace xvrml {
namespace {

// Binds values in order to the points or the quadrilaterals of the grid.
template <class T> void bind(Attribute<T>& attribute, std::span<const T> values, bool perVertex,
                             size_t points, uint32_t faces, Fault fault, Faults& faults) {
  using Per = typename Attribute<T>::Per;
  if (values.empty()) return;
  attribute.values = values;
  attribute.per = perVertex ? Per::point : Per::face;
  if (perVertex) {
    if (values.size() < points) faults.add(fault, values.size());
    return;
  }
  attribute.index.resize(faces);
  for (uint32_t face = 0; face < faces; face++)
    attribute.index[face] = face < values.size() ? face : noValue;
  if (values.size() < faces) faults.add(fault, values.size());
}

// Holds whether the rows of a grid go to the north, and not to the south as z does.
template <class Grid> constexpr bool isNorthward = std::is_same_v<Grid, nodes::GeoElevationGrid>;

// Returns the grid of either node. point: returns the place of a grid point with its column, row
// and height.
template <class Grid, class Point>
Mesh buildGrid(const Grid& node, const MeshOptions& options, Faults& faults, const Point& point) {
  if (!(node.xSpacing > 0 && node.zSpacing > 0))
    faults.note("xSpacing and zSpacing must be positive");
  if (!std::isfinite(double(node.xSpacing)) || !std::isfinite(double(node.zSpacing))) return {};
  int64_t columns = node.xDimension, rows = node.zDimension;
  if (columns <= 0 || rows <= 0) return {}; // an empty grid is allowed
  // Each is below 2^31, so products stay within 64 bits.
  if (int64_t(node.height.size()) < columns * rows) {
    faults.note("height has " + std::to_string(node.height.size()) +
                " values where xDimension and zDimension ask for " +
                std::to_string(columns * rows) +
                (int64_t(node.height.size()) < 2 * columns ? "; nothing is drawn"
                                                           : "; only whole rows are drawn"));
    rows = int64_t(node.height.size()) / columns;
  }
  if (columns < 2 || rows < 2) return {};
  if (uint64_t(2 * (columns - 1) * (rows - 1)) > triangleLimit(options) ||
      columns * rows >= int64_t(noValue / 4)) {
    faults.note("more triangles than " + std::string(triangleLimitName(options)) +
                " allows; nothing is drawn");
    return {};
  }

  FaceSet set;
  set.ownPoints.reserve(size_t(columns * rows));
  for (int64_t j = 0; j < rows; j++)
    for (int64_t i = 0; i < columns; i++)
      set.ownPoints.push_back(point(i, j, node.height[size_t(i + j * columns)]));
  set.points = set.ownPoints;
  uint32_t faces = uint32_t((columns - 1) * (rows - 1)), width = uint32_t(columns);
  set.corners.reserve(4 * size_t(faces));
  set.faceStart.reserve(size_t(faces) + 1);
  set.faceStart.push_back(0);
  for (uint32_t j = 0; j + 1 < uint32_t(rows); j++)
    for (uint32_t i = 0; i + 1 < width; i++) { // counterclockwise as seen from +y
      uint32_t a = i + j * width;
      set.corners.insert(set.corners.end(), {a, a + width, a + width + 1, a + 1});
      set.faceStart.push_back(uint32_t(set.corners.size()));
    }
  set.uncheckedFaces = faces;
  set.solid = node.solid;
  set.ccw = node.ccw != isNorthward<Grid>;
  set.creaseAngle = float(double(node.creaseAngle));
  ColorValues colors = colorValues(node.color);
  set.takeColors(colors.rgb, std::move(colors.own), std::move(colors.alphas));
  bind(set.colors, set.colors.values, node.colorPerVertex, set.points.size(), faces,
       Fault::colorMissing, faults);
  bind(set.normals, normalVectors(node.normal), node.normalPerVertex, set.points.size(), faces,
       Fault::normalMissing, faults);
  TexCoordValues texCoords = textureCoordinates(node.texCoord);
  set.takeTexCoords(texCoords.points, std::move(texCoords.own), std::move(texCoords.places));
  bind(set.texCoords, set.texCoords.values, true, set.points.size(), faces, Fault::texCoordMissing,
       faults);
  if constexpr (requires { node.fogCoord; })
    set.fogCoords = fogCoordinates(node.fogCoord, set.points.size());
  if (options.needTexCoords &&
      set.texCoords.values.empty()) { // the whole texture, S along x and T along z
    set.texCoords.own.reserve(set.points.size());
    for (int64_t j = 0; j < rows; j++)
      for (int64_t i = 0; i < columns; i++)
        set.texCoords.own.push_back({float(double(i) / double(columns - 1)),
                                     float(double(j) / double(node.zDimension - 1))});
    set.texCoords.values = set.texCoords.own;
    set.texCoords.per = Attribute<Vec2f>::Per::point;
  }
  return buildFaceMesh(std::move(set), options, faults);
}

} // namespace

Mesh buildElevationGrid(const nodes::ElevationGrid& node, const MeshOptions& options,
                        Faults& faults) {
  return buildGrid(node, options, faults, [&](int64_t i, int64_t j, float height) {
    return Vec3f{float(double(node.xSpacing) * double(i)), height,
                 float(double(node.zSpacing) * double(j))};
  });
}

// Rows go to the north, so faces run the other way than those of an ElevationGrid.
Mesh buildGeoElevationGrid(const nodes::GeoElevationGrid& node, const MeshOptions& options,
                           Faults& faults) {
  const bool eastFirst = comesEastFirst(node.geoSystem);
  const Matrix toWorld = globeToWorld(node);
  bool everywhere = true;
  Mesh mesh = buildGrid(node, options, faults, [&](int64_t i, int64_t j, double height) {
    Vec3d at = node.geoGridOrigin;
    (eastFirst ? at.x : at.y) += double(node.xSpacing) * double(i);
    (eastFirst ? at.y : at.x) += double(node.zSpacing) * double(j);
    at.z += double(node.yScale) * height;
    const std::optional<GlobePlace> place = placeOnGlobe(node.geoSystem, at);
    everywhere = everywhere && place;
    if (!place) return Vec3f();
    const Vector p = transformPoint(toWorld, {place->center.x, place->center.y, place->center.z});
    return Vec3f{float(p.x), float(p.y), float(p.z)};
  });
  if (everywhere) return mesh;
  faults.note("points outside of the geoSystem; nothing is drawn");
  return {};
}

} // namespace xvrml
