#include "material_list.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "describe.h"
#include "xvrml/appearance.h"
#include "xvrml/build.h"

namespace vv {

namespace {

using xvrml::Vec3f;

constexpr int sphereSteps = 16; // facets from pole to pole: 1 % of the area is missing

// Returns the area of a placed shape's triangles; 0 for lines and points.
double areaOf(const xvrml::PlacedShape& placed) {
  const xvrml::GeometryArrays arrays = xvrml::geometryArrays(placed, sphereSteps);
  if (arrays.kind != xvrml::GeometryArrays::Kind::triangles) return 0;
  const double* m = placed.matrix;
  const auto edge = [&](const Vec3f& a, const Vec3f& b, double out[3]) {
    const double d[3] = {double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z};
    for (int i = 0; i < 3; ++i) out[i] = m[i] * d[0] + m[4 + i] * d[1] + m[8 + i] * d[2];
  };
  double area = 0;
  for (size_t i = 0; i + 2 < arrays.indices.size(); i += 3) {
    const Vec3f& a = arrays.points[arrays.indices[i]];
    double u[3], v[3];
    edge(a, arrays.points[arrays.indices[i + 1]], u);
    edge(a, arrays.points[arrays.indices[i + 2]], v);
    area += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]) /
            2;
  }
  return area;
}

// Returns a material's name and colour, and how the rules have found it.
MaterialUse useOf(const picture::ShapeRule& shape) {
  const xvrml::AppearanceParts parts = xvrml::resolveAppearance(shape.shape->appearance.get());
  const xvrml::MaterialValues values = xvrml::materialValues(parts.material);
  MaterialUse use;
  use.name = shape.kicad.name;
  use.byColour = shape.kicad.byColour;
  if (use.name.empty() && parts.material) use.name = parts.material->defName;
  if (values.model != xvrml::MaterialValues::Model::none)
    use.colour =
        fmt::format("{:.3g},{:.3g},{:.3g}", values.color.r, values.color.g, values.color.b);
  if (shape.rule) use.rule = shape.rule->text;
  return use;
}

} // namespace

std::vector<MaterialUse> materialUses(const std::vector<picture::ShaderRule>& rules,
                                      const xvrml::World& world) {
  std::unordered_map<const xvrml::Node*, double> areas;
  for (const xvrml::PlacedShape& placed : xvrml::placedShapes(world))
    areas[placed.shape.get()] += areaOf(placed);
  std::map<std::tuple<std::string, std::string, std::string>, MaterialUse> all;
  for (const picture::ShapeRule& shape : picture::rulesOfShapes(rules, world)) {
    const auto area = areas.find(shape.shape);
    if (area == areas.end()) continue; // nothing of it is drawn
    MaterialUse use = useOf(shape);
    // Shapes with a name are told apart by it alone.
    const std::string colour = use.name.empty() ? use.colour : std::string();
    MaterialUse& sum = all.try_emplace({use.name, colour, use.rule}, use).first->second;
    ++sum.shapes;
    sum.area += area->second;
  }
  std::vector<MaterialUse> uses;
  for (auto& [key, use] : all) uses.push_back(std::move(use));
  std::stable_sort(uses.begin(), uses.end(),
                   [](const MaterialUse& a, const MaterialUse& b) { return a.area > b.area; });
  return uses;
}

std::string materialText(const std::vector<MaterialUse>& uses) {
  double all = 0, unknown = 0;
  for (const MaterialUse& use : uses) {
    all += use.area;
    if (use.rule.empty()) unknown += use.area;
  }
  const auto share = [&](double area) { return all > 0 ? 100 * area / all : 0; };
  std::string text = fmt::format("{:>7} {:>8}  {}\n", "area", "shapes", "material: rule for it");
  for (const MaterialUse& use : uses) {
    const std::string name = use.name.empty() ? "no name, colour:" + use.colour
                             : use.byColour   ? use.name + ", by colour:" + use.colour
                                              : use.name;
    text += fmt::format("{:>5.1f} % {:>8}  {}: {}\n", share(use.area), use.shapes, oneLine(name),
                        use.rule.empty() ? "no rule knows it" : oneLine(use.rule));
  }
  return text + fmt::format("{:>5.1f} % of the area is of materials that no rule but * knows\n",
                            share(unknown));
}

} // namespace vv
