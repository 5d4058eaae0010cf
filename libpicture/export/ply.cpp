// ply.cpp: PLY, binary with the least significant byte first: the triangles of a world in its
// coordinates, with normals and colours, or a cloud of points if it has no triangles.
#include <bit>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "libpicture/export/export.h"
#include "libpicture/export/pictures.h"
#include "libpicture/export/placed_vertices.h"
#include "libpicture/export/surface.h"
#include "libpicture/export/walk_options.h"

namespace picture {

namespace {

static_assert(std::endian::native == std::endian::little);

using xvrml::Color;
using xvrml::Vec3f;

// The elements of a file, as they are in it.
struct Parts {
  uint64_t vertices = 0, faces = 0;
  std::vector<std::string> vertexBytes, faceBytes;
};

void addColor(const Color& code, std::string& bytes) {
  for (const float v : {code.r, code.g, code.b})
    bytes += char(uint8_t(std::lround(255 * between0And1(v))));
}

template <class T> void add(const T& value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class Writer : public xvrml::Renderer {
 public:
  Writer(Surfaces& surfaces, Remarks& remarks) : surfaces_(surfaces), remarks_(remarks) {}
  xvrml::Visit renderShape(xvrml::nodes::Shape&, const xvrml::RenderState&) override {
    return xvrml::Visit::draw;
  }
  void draw(const xvrml::DrawnShape& shape) override {
    using Kind = xvrml::GeometryArrays::Kind;
    const Kind kind = shape.mesh().kind;
    if (kind == Kind::empty) return;
    if (kind == Kind::lines) return remarks_.leaveOut("lines");
    const PlacedVertices vertices(shape, remarks_);
    const auto colors = vertices.local().hasColors() ? VertexColors::opaque : VertexColors::none;
    const Surface surface = surfaces_.make(shape.appearance(), colors, kind == Kind::points);
    if (!surface.visible) return;
    if (surface.picture) remarks_.change("pictures of surfaces are left out");
    if (kind == Kind::points)
      addPoints(vertices, surface);
    else
      addTriangles(vertices, surface);
  }
  Parts mesh, cloud;
  uint64_t clouds = 0; // Shapes of points

 private:
  static Color colorOf(const PlacedVertices& vertices, const Surface& surface, size_t i) {
    return surface.showsVertexColors ? vertices.local().color(i) : codeOf(surface.color);
  }

  void addPoints(const PlacedVertices& vertices, const Surface& surface) {
    ++clouds;
    std::string bytes;
    for (size_t i = 0; i < vertices.size(); ++i) {
      const Vec3f p = vertices.point(i);
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      add(p, bytes);
      addColor(colorOf(vertices, surface, i), bytes);
      ++cloud.vertices;
    }
    cloud.vertexBytes.push_back(std::move(bytes));
  }

  static void addVertex(const Vec3f& point, const Vec3f& normal, const Color& color,
                        std::string& bytes) {
    add(point, bytes);
    add(normal, bytes);
    addColor(color, bytes);
  }

  // Vertices of flat triangles have the normal of the triangle, so that no two share one.
  void addTriangles(const PlacedVertices& vertices, const Surface& surface) {
    std::string points, faces;
    const bool smooth = vertices.local().hasNormals();
    uint64_t next = mesh.vertices; // number of the next vertex
    if (smooth)
      for (size_t i = 0; i < vertices.size(); ++i)
        addVertex(vertices.point(i), vertices.normal(i), colorOf(vertices, surface, i), points);
    const uint64_t first = next;
    if (smooth) next += vertices.size();
    for (size_t t = 0; t < vertices.triangles(); ++t) {
      if (!vertices.isFinite(t)) continue;
      const auto corners = vertices.triangle(t);
      faces += char(3);
      for (const uint32_t corner : corners) {
        add(int32_t(smooth ? first + corner : next), faces);
        if (smooth) continue;
        addVertex(vertices.point(corner), vertices.faceNormal(t),
                  colorOf(vertices, surface, corner), points);
        ++next;
      }
      ++mesh.faces;
    }
    if (next > INT32_MAX) throw std::runtime_error("a PLY file has at most 2,147,483,647 vertices");
    mesh.vertices = next;
    mesh.vertexBytes.push_back(std::move(points));
    mesh.faceBytes.push_back(std::move(faces));
  }

  Surfaces& surfaces_;
  Remarks& remarks_;
};

std::string headerOf(const Parts& parts) {
  std::string text = fmt::format("ply\nformat binary_little_endian 1.0\n"
                                 "comment vv: metres, y is up, colours are sRGB\n"
                                 "element vertex {}\n"
                                 "property float x\nproperty float y\nproperty float z\n",
                                 parts.vertices);
  if (parts.faces > 0) text += "property float nx\nproperty float ny\nproperty float nz\n";
  text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (parts.faces > 0)
    text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", parts.faces);
  return text + "end_header\n";
}

} // namespace

Exported exportPly(const xvrml::World& world, const ExportSettings& settings) {
  Remarks remarks;
  Pictures pictures(world, remarks);
  Surfaces surfaces(pictures, settings.shaderPath, remarks);
  Writer writer(surfaces, remarks);
  xvrml::render(world, writer, walkOptions());
  const bool hasFaces = writer.mesh.faces > 0;
  for (uint64_t i = 0; hasFaces && i < writer.clouds; ++i)
    remarks.leaveOut("points beside triangles");
  Parts& parts = hasFaces ? writer.mesh : writer.cloud;
  Exported exported;
  Exported::File& file = exported.files.emplace_back();
  file.path = settings.path;
  file.pieces.push_back(headerOf(parts));
  for (std::string& piece : parts.vertexBytes) file.pieces.push_back(std::move(piece));
  for (std::string& piece : parts.faceBytes) file.pieces.push_back(std::move(piece));
  exported.remarks = remarks.sentences("PLY");
  return exported;
}

} // namespace picture
