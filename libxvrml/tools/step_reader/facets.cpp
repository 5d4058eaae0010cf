// facets.cpp: triangles, normals and colours of parts.
#include "facets.h"

#include <algorithm>
#include <cmath>

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <RWMesh_FaceIterator.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "origins.h"

namespace xvrml::decoding {
namespace {

constexpr double metres = .001;     // in a millimetre, the unit in which Open CASCADE computes
constexpr double partOfSize = .001; // the chord error over the diagonal of a part's box
constexpr double turn = .35;        // radians between neighbouring triangles at most
constexpr double leastCosine = .2;  // between the normal of a vertex and of its triangle
// The colour of parts that have none is linear and becomes that of a Material, .8.
constexpr Model::Material plain = {.6038f, .6038f, .6038f, 1};

gp_XYZ pointOf(const std::vector<float>& points, size_t vertex) {
  return {points[3 * vertex], points[3 * vertex + 1], points[3 * vertex + 2]};
}

void append(std::vector<float>& to, const gp_XYZ& v) {
  for (int i = 1; i <= 3; ++i) to.push_back(float(v.Coord(i)));
}

bool isFinite(const gp_XYZ& v) {
  return std::isfinite(v.X()) && std::isfinite(v.Y()) && std::isfinite(v.Z());
}

// Returns the box of a shape's triangles, in millimetres; void if it has none.
Bnd_Box boxOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, true);
  if (box.IsOpen()) box.SetVoid();
  return box;
}

// Appends the triangles of a face, with points that count from an origin. A vertex whose surface
// has no normal (the tip of a cone), or a strange one, has that of the triangle.
void addFace(const RWMesh_FaceIterator& face, const gp_XYZ& origin, Primitive& to) {
  const size_t first = to.points.size() / 3;
  for (int i = face.NodeLower(); i <= face.NodeUpper(); ++i) {
    append(to.points, face.NodeTransformed(i).XYZ() * metres - origin);
    append(to.normals, face.HasNormals() ? face.NormalTransformed(i).XYZ() : gp_XYZ(0, 0, 0));
  }
  for (int i = face.ElemLower(); i <= face.ElemUpper(); ++i) {
    const Poly_Triangle triangle = face.TriangleOriented(i);
    size_t corner[3];
    gp_XYZ p[3];
    for (int k = 0; k < 3; ++k) {
      corner[k] = first + size_t(triangle.Value(k + 1) - face.NodeLower());
      p[k] = pointOf(to.points, corner[k]);
    }
    gp_XYZ across = (p[1] - p[0]).Crossed(p[2] - p[0]);
    const double length = across.Modulus();
    if (!(length > 0) || !isFinite(across)) continue;
    across /= length;
    for (size_t& c : corner) {
      const gp_XYZ normal = pointOf(to.normals, c);
      if (isFinite(normal) && normal.Dot(across) >= leastCosine) continue;
      const gp_XYZ point = pointOf(to.points, c);
      c = to.points.size() / 3;
      append(to.points, point);
      append(to.normals, across);
    }
    for (const size_t c : corner) to.corners.push_back(uint32_t(c));
  }
}

Model::Material colorOf(const RWMesh_FaceIterator& face) {
  if (!face.HasFaceColor()) return plain;
  const Quantity_ColorRGBA& color = face.FaceColor();
  const auto part = [](double value) { return float(std::clamp(value, 0.0, 1.0)); };
  const Quantity_Color& rgb = color.GetRGB();
  return {part(rgb.Red()), part(rgb.Green()), part(rgb.Blue()), part(color.Alpha())};
}

} // namespace

size_t Facets::materialOf(const Model::Material& material) {
  auto& all = model_.materials;
  const auto found = std::find(all.begin(), all.end(), material);
  if (found != all.end()) return size_t(found - all.begin());
  all.push_back(material);
  return all.size() - 1;
}

double Facets::chordErrorOf(const TopoDS_Shape& shape) const {
  if (chordError_ > 0) return chordError_;
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  const double size = box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
  return size > 0 && std::isfinite(size) ? size * partOfSize : partOfSize;
}

std::optional<size_t> Facets::meshOf(const TDF_Label& part, const std::string& name,
                                     const XCAFPrs_Style& style) {
  TopoDS_Shape shape;
  if (!XCAFDoc_ShapeTool::GetShape(part, shape) || shape.IsNull()) return {};
  shape.Location(TopLoc_Location(), false);
  IMeshTools_Parameters parameters;
  parameters.Deflection = chordErrorOf(shape);
  parameters.Angle = turn;
  parameters.InParallel = false; // no thread may be made in the cage
  BRepMesh_IncrementalMesh(shape, parameters);
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    TopLoc_Location place;
    model_.leftOut += BRep_Tool::Triangulation(TopoDS::Face(faces.Current()), place).IsNull();
  }
  Mesh mesh{name};
  gp_XYZ origin;
  if (const Bnd_Box box = boxOf(shape); !box.IsVoid())
    origin = originFor(box.CornerMin().XYZ() * metres, box.CornerMax().XYZ() * metres);
  mesh.origin = {origin.X(), origin.Y(), origin.Z()};
  for (RWMesh_FaceIterator face(part, TopLoc_Location(), true, style); face.More(); face.Next()) {
    if (face.IsEmptyMesh()) continue;
    const size_t material = materialOf(colorOf(face));
    auto of = std::find_if(mesh.primitives.begin(), mesh.primitives.end(),
                           [&](const Primitive& one) { return one.material == material; });
    if (of == mesh.primitives.end())
      of = mesh.primitives.insert(of, Primitive{.material = material});
    addFace(face, origin, *of);
  }
  std::erase_if(mesh.primitives, [](const Primitive& one) { return one.corners.empty(); });
  if (mesh.primitives.empty()) return {};
  model_.meshes.push_back(std::move(mesh));
  return model_.meshes.size() - 1;
}

} // namespace xvrml::decoding
