// point_set.cpp: builds the points of a PointSet (clause 6.36).
#include <numeric>

#include "geometry/builders.h"
#include "geometry/vector_math.h"

namespace xvrml {

Mesh buildPointSet(const nodes::PointSet& node, const MeshOptions&, Faults& faults) {
  Mesh mesh;
  Coordinates given = coordinates(node.coord);
  const std::span<const Vec3f> points = given.points;
  ColorValues values = colorValues(node.color);
  const std::span<const Color> colors = values.rgb;
  if (points.empty() || points.size() >= UINT32_MAX) return mesh;
  std::vector<float> fogCoords = fogCoordinates(node.fogCoord, points.size());
  for (uint32_t i = 0; i < points.size(); i++) {
    if (isFinite(points[i]))
      mesh.ownIndices.push_back(i);
    else
      faults.add(Fault::notFinite, i);
  }
  if (mesh.ownIndices.size() < points.size()) { // keep only points that can be drawn
    for (uint32_t& index : mesh.ownIndices) {
      mesh.ownPoints.push_back(points[index]);
      if (!colors.empty())
        mesh.ownColors.push_back(index < colors.size() ? colors[index] : Color{1, 1, 1});
      if (!values.alphas.empty())
        mesh.ownAlphas.push_back(index < colors.size() ? values.alphas[index] : 1.0f);
      if (!fogCoords.empty()) mesh.ownFogCoords.push_back(fogCoords[index]);
    }
    std::iota(mesh.ownIndices.begin(), mesh.ownIndices.end(), 0);
    mesh.viewOwn();
  } else {
    mesh.ownPoints = std::move(given.own); // keeps its storage
    mesh.points = points;
    mesh.indices = mesh.ownIndices;
    mesh.ownFogCoords = std::move(fogCoords);
    mesh.fogCoords = mesh.ownFogCoords;
    if (!colors.empty() && (colors.size() < points.size() || !values.alphas.empty())) {
      mesh.ownColors.assign(colors.begin(), colors.end());
      mesh.ownColors.resize(points.size(), Color{1, 1, 1});
      mesh.colors = mesh.ownColors;
      if (!values.alphas.empty()) {
        mesh.ownAlphas = std::move(values.alphas);
        mesh.ownAlphas.resize(points.size(), 1.0f);
        mesh.alphas = mesh.ownAlphas;
      }
    } else if (!colors.empty())
      mesh.colors = colors.first(points.size());
  }
  if (!colors.empty() && colors.size() < points.size())
    faults.add(Fault::colorMissing, colors.size());
  if (!allFinite(mesh.colors)) {
    mesh.ownColors.assign(mesh.colors.begin(), mesh.colors.end());
    for (Color& color : mesh.ownColors)
      if (!isFinite(color)) color = {};
    mesh.colors = mesh.ownColors;
  }
  if (mesh.indices.empty()) return Mesh();
  mesh.kind = Mesh::Kind::points;
  mesh.solid = false;
  return mesh;
}

} // namespace xvrml
