#include "libpicture/export/gltf/meshes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace picture::gltf {

using xvrml::DrawnShape;
using xvrml::GeometryArrays;
using xvrml::Vec2f;
using xvrml::Vec3f;

namespace {

// Collects the elements of an accessor. T consists of floats.
template <class T, class At> Elements floatsOf(size_t count, const char* type, const At& at) {
  Elements elements;
  elements.count = count;
  elements.type = type;
  elements.target = vertexTarget;
  elements.bytes.resize(count * sizeof(T));
  for (size_t i = 0; i < count; ++i) {
    const T value = at(i);
    std::memcpy(&elements.bytes[i * sizeof(T)], &value, sizeof(T));
  }
  return elements;
}

Box boxOf(const Vertices& vertices) {
  Box box{vertices.point(0), vertices.point(0)};
  for (size_t i = 1; i < vertices.size(); ++i) {
    const Vec3f p = vertices.point(i);
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

template <class T> std::string bytesOf(std::span<const uint32_t> indices) {
  std::string bytes(indices.size() * sizeof(T), '\0');
  for (size_t i = 0; i < indices.size(); ++i) {
    const T index = T(indices[i]);
    std::memcpy(&bytes[i * sizeof(T)], &index, sizeof(T));
  }
  return bytes;
}

// The largest index of a type stands for the start of a new strip, so no vertex has it.
Elements indicesOf(std::span<const uint32_t> indices, size_t vertices) {
  const bool isShort = vertices <= 65535;
  Elements elements;
  elements.count = indices.size();
  elements.component = isShort ? unsignedShort : unsignedInt;
  elements.target = indexTarget;
  elements.bytes = isShort ? bytesOf<uint16_t>(indices) : bytesOf<uint32_t>(indices);
  return elements;
}

int modeOf(GeometryArrays::Kind kind) {
  constexpr int points = 0, lines = 1, triangles = 4;
  return kind == GeometryArrays::Kind::points  ? points
         : kind == GeometryArrays::Kind::lines ? lines
                                               : triangles;
}

float leastSide(const Box& box) {
  const Vec3f &a = box.low, &b = box.high;
  return std::min({b.x - a.x, b.y - a.y, b.z - a.z});
}

} // namespace

// Returns what a geometry has, without writing it.
Meshes::Geometry Meshes::describe(const GeometryArrays& arrays) {
  Geometry geometry;
  geometry.solid = arrays.solid;
  const Vertices vertices(arrays);
  if (vertices.leftOut() > 0)
    remarks_.change("triangles, lines or points with numbers that are not finite are left out");
  if (vertices.empty()) return geometry;
  geometry.kind = arrays.kind;
  geometry.box = boxOf(vertices);
  if (vertices.hasColors())
    geometry.colors = vertices.hasAlphas() ? VertexColors::transparent : VertexColors::opaque;
  return geometry;
}

// Writes what all materials show, for the first one that is visible.
void Meshes::write(const GeometryArrays& arrays, Geometry& geometry) {
  if (geometry.points >= 0) return;
  const Vertices vertices(arrays);
  const size_t count = vertices.size();
  const auto& [low, high] = geometry.box;
  Elements points = floatsOf<Vec3f>(count, "VEC3", [&](size_t i) { return vertices.point(i); });
  points.minimum = {low.x, low.y, low.z};
  points.maximum = {high.x, high.y, high.z};
  geometry.points = int64_t(document_.add(std::move(points)));
  if (vertices.hasNormals() && arrays.kind == GeometryArrays::Kind::triangles)
    geometry.normals = int64_t(document_.add(
        floatsOf<Vec3f>(count, "VEC3", [&](size_t i) { return vertices.normal(i); })));
  geometry.indices = int64_t(document_.add(indicesOf(vertices.indices(), count)));
}

// Returns the accessor of the colours. They are written for the first material that shows them.
size_t Meshes::colorsOf(const DrawnShape& shape, Geometry& geometry) {
  if (geometry.colorValues) return *geometry.colorValues;
  const Vertices vertices(shape.mesh());
  const size_t count = vertices.size();
  if (geometry.colors == VertexColors::opaque)
    geometry.colorValues = document_.add(floatsOf<xvrml::Color>(
        count, "VEC3", [&](size_t i) { return linearOf(vertices.color(i)); }));
  else
    geometry.colorValues = document_.add(floatsOf<xvrml::ColorRGBA>(count, "VEC4", [&](size_t i) {
      const xvrml::Color c = linearOf(vertices.color(i));
      return xvrml::ColorRGBA{c.r, c.g, c.b, vertices.alpha(i)};
    }));
  return *geometry.colorValues;
}

// Returns the accessor of u v, whose origin is at the upper left.
size_t Meshes::texCoords(const DrawnShape& shape, const std::array<float, 6>& transform,
                         Geometry& geometry) {
  const auto [found, fresh] = geometry.texCoords.try_emplace(transform);
  if (!fresh) return found->second;
  const Vertices vertices(shape.mesh());
  const auto& [a, b, c, d, e, f] = transform;
  return found->second = document_.add(floatsOf<Vec2f>(vertices.size(), "VEC2", [&](size_t i) {
    const Vec2f st = vertices.texCoord(i);
    const Vec2f uv{a * st.x + c * st.y + e, 1 - (b * st.x + d * st.y + f)};
    return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : Vec2f{};
  }));
}

Json Meshes::primitiveOf(const DrawnShape& shape, Geometry& geometry, const MaterialUse& material) {
  Json attributes = {{"POSITION", geometry.points}};
  if (geometry.normals >= 0) attributes["NORMAL"] = geometry.normals;
  if (material.showsVertexColors) attributes["COLOR_0"] = colorsOf(shape, geometry);
  if (material.textured)
    attributes["TEXCOORD_0"] = texCoords(shape, material.bakedTransform, geometry);
  Json primitive = {{"attributes", std::move(attributes)},
                    {"indices", geometry.indices},
                    {"material", *material.material}};
  if (const int mode = modeOf(geometry.kind); mode != 4) primitive["mode"] = mode;
  return primitive;
}

// Adds the looks that a Switch chooses between to a primitive. A primitive has one set of
// attributes, so a look that needs others is left out. Sets what the attributes must have.
Json Meshes::mappingsOf(const xvrml::nodes::Switch& chooser, const MaterialOf& materialOf,
                        MaterialUse& attributes) {
  std::map<size_t, std::vector<size_t>> variants; // by material
  std::set<size_t> taken;
  for (const Look& look : looksOf(chooser)) {
    const MaterialUse use = materialOf(look.parts);
    const bool fits =
        use.material && use.showsVertexColors == attributes.showsVertexColors &&
        (!use.textured || !attributes.textured || use.bakedTransform == attributes.bakedTransform);
    if (!fits) {
      remarks_.change("a choice of a Switch that needs other colours of vertices or coordinates of "
                      "textures is left out");
      continue;
    }
    if (use.textured) attributes.bakedTransform = use.bakedTransform;
    attributes.textured = attributes.textured || use.textured;
    const size_t variant = variants_.of(look.name);
    if (taken.insert(variant).second) variants[*use.material].push_back(variant);
  }
  Json mappings = Json::array();
  for (const auto& [material, indices] : variants)
    mappings.push_back({{"material", material}, {"variants", indices}});
  return mappings;
}

std::optional<MeshUse> Meshes::use(const DrawnShape& shape, const xvrml::nodes::Switch* chooser) {
  // ClipPlanes leave other parts of a geometry at each place.
  const bool cut = !shape.kept().empty();
  Geometry own;
  Geometry* geometry = &own;
  if (cut) {
    own = describe(shape.mesh());
  } else {
    const auto [found, fresh] = geometries_.try_emplace(&shape.geometry);
    if (fresh) found->second = describe(shape.mesh());
    geometry = &found->second;
  }
  if (geometry->kind == GeometryArrays::Kind::empty) return {};
  const bool lines = geometry->kind != GeometryArrays::Kind::triangles;
  const auto materialOf = [&](const xvrml::AppearanceParts& parts) {
    return materials_.use(parts, geometry->colors, lines, !lines && !geometry->solid,
                          leastSide(geometry->box));
  };
  MaterialUse material = materialOf(shape.appearance());
  if (!material.material) return {};
  const auto mesh = [&] {
    write(shape.mesh(), *geometry);
    const Json mappings = chooser ? mappingsOf(*chooser, materialOf, material) : Json::array();
    Json primitive = primitiveOf(shape, *geometry, material);
    if (!mappings.empty())
      primitive["extensions"]["KHR_materials_variants"] = {{"mappings", mappings}};
    Json object = {{"primitives", Json::array({std::move(primitive)})}};
    if (!shape.geometry.defName.empty()) object["name"] = shape.geometry.defName;
    return document_.add("meshes", object);
  };
  if (cut) return MeshUse{mesh(), geometry->box};
  const auto [known, fresh] = meshes_.try_emplace({&shape.geometry, *material.material, chooser});
  if (fresh) known->second = mesh();
  return MeshUse{known->second, geometry->box};
}

} // namespace picture::gltf
