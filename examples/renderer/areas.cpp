// areas.cpp: lists the area of each material of a world in square metres, the largest first.
// usage: areas WORLD
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <xvrml/renderer.h>

using namespace xvrml;

namespace {

// Returns twice the area of a triangle.
double doubleArea(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
  return std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
}

struct Areas : Renderer {
  std::map<const Node*, double> byMaterial; // null: shapes without a material

  // The callback for each Shape: the walk need not go into its appearance and geometry.
  Visit renderShape(nodes::Shape&, const RenderState&) override { return Visit::draw; }

  void draw(const DrawnShape& shape) override {
    const GeometryArrays& mesh = shape.mesh();
    if (mesh.kind != GeometryArrays::Kind::triangles) return; // lines and points have no area
    const double* m = shape.matrix();
    const auto inWorld = [&](uint32_t index) {
      const Vec3f& p = mesh.points[index];
      return Vec3d{m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
                   m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
                   m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
    };
    double& area = byMaterial[shape.appearance().material];
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
      area += doubleArea(inWorld(mesh.indices[i]), inWorld(mesh.indices[i + 1]),
                         inWorld(mesh.indices[i + 2])) /
              2;
  }
};

} // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: areas WORLD\n"), 2;
  const auto world = loadWorld(argv[1]);
  Areas areas;
  render(*world, areas);
  std::vector<std::pair<double, Node*>> sorted;
  for (const auto& [material, area] : areas.byMaterial)
    sorted.emplace_back(area, const_cast<Node*>(material));
  std::sort(sorted.rbegin(), sorted.rend());
  for (const auto& [area, material] : sorted) {
    const auto [r, g, b] = materialValues(material).color;
    std::printf("%10.3f m2  %-16s  %.2f %.2f %.2f\n", area,
                !material                   ? "no material"
                : material->defName.empty() ? "-"
                                            : material->defName.c_str(),
                double(r), double(g), double(b));
  }
} catch (const LoadError& error) {
  return std::fprintf(stderr, "%s\n", error.diagnostic.text().c_str()), 1;
}
