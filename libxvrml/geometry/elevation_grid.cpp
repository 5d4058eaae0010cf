// elevation_grid.cpp: ElevationGrid (clause 6.17): a grid of heights over the xz plane as
// quadrilaterals.
#include "geometry/builders.h"
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

} // namespace

Mesh buildElevationGrid(const nodes::ElevationGrid& node, const MeshOptions& options,
                        Faults& faults) {
  if (!(node.xSpacing > 0 && node.zSpacing > 0))
    faults.note("xSpacing and zSpacing must be positive");
  if (!isFinite(node.xSpacing) || !isFinite(node.zSpacing)) return {};
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
      set.ownPoints.push_back({float(double(node.xSpacing) * double(i)),
                               node.height[size_t(i + j * columns)],
                               float(double(node.zSpacing) * double(j))});
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
  set.ccw = node.ccw;
  set.creaseAngle = node.creaseAngle;
  ColorValues colors = colorValues(node.color);
  set.takeColors(colors.rgb, std::move(colors.own), std::move(colors.alphas));
  bind(set.colors, set.colors.values, node.colorPerVertex, set.points.size(), faces,
       Fault::colorMissing, faults);
  bind(set.normals, normalVectors(node.normal), node.normalPerVertex, set.points.size(), faces,
       Fault::normalMissing, faults);
  bind(set.texCoords, textureCoordinates(node.texCoord), true, set.points.size(), faces,
       Fault::texCoordMissing, faults);
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

} // namespace xvrml
