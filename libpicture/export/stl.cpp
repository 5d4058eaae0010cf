// stl.cpp: STL, binary: the triangles of a world in its coordinates, and nothing else.
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "libpicture/export/export.h"
#include "libpicture/export/placed_vertices.h"
#include "libpicture/export/walk_options.h"

namespace picture {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t headerBytes = 80, triangleBytes = 50;

class Triangles : public xvrml::Renderer {
 public:
  explicit Triangles(Remarks& remarks) : remarks_(remarks) {}
  xvrml::Visit renderShape(xvrml::nodes::Shape&, const xvrml::RenderState&) override {
    return xvrml::Visit::draw;
  }
  void draw(const xvrml::DrawnShape& shape) override {
    using Kind = xvrml::GeometryArrays::Kind;
    if (shape.mesh().kind == Kind::empty) return;
    if (shape.mesh().kind != Kind::triangles) return remarks_.leaveOut("lines and points");
    const PlacedVertices vertices(shape, remarks_);
    std::string bytes;
    bytes.reserve(vertices.triangles() * triangleBytes);
    for (size_t t = 0; t < vertices.triangles(); ++t)
      if (vertices.isFinite(t)) add(vertices, t, bytes);
    count += bytes.size() / triangleBytes;
    pieces.push_back(std::move(bytes));
  }
  uint64_t count = 0;
  std::vector<std::string> pieces;

 private:
  static void add(const PlacedVertices& vertices, size_t t, std::string& bytes) {
    const auto corners = vertices.triangle(t);
    const xvrml::Vec3f numbers[4] = {vertices.faceNormal(t), vertices.point(corners[0]),
                                     vertices.point(corners[1]), vertices.point(corners[2])};
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    bytes.append(2, '\0'); // attributes
  }
  Remarks& remarks_;
};

} // namespace

Exported exportStl(const xvrml::World& world, const ExportSettings& settings) {
  Remarks remarks;
  Triangles triangles(remarks);
  xvrml::render(world, triangles, walkOptions());
  if (triangles.count > UINT32_MAX)
    throw std::runtime_error("an STL file has at most 4,294,967,295 triangles");
  // A binary file may not begin with "solid", as texts do.
  std::string header = "vv: metres, y is up";
  header.resize(headerBytes, ' ');
  const auto count = uint32_t(triangles.count);
  header.append(reinterpret_cast<const char*>(&count), sizeof count);
  Exported exported;
  Exported::File& file = exported.files.emplace_back();
  file.path = settings.path;
  file.pieces.push_back(std::move(header));
  for (std::string& piece : triangles.pieces) file.pieces.push_back(std::move(piece));
  exported.remarks = remarks.sentences("STL");
  return exported;
}

} // namespace picture
