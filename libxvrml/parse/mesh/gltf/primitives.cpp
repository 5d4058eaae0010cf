// primitives.cpp: writes the Shapes of meshes: faces, lines or points with their attributes.
// deform.cpp moves the vertices of morph targets, skins.cpp gathers those of skins.
#include "parse/mesh/gltf/primitives.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace xvrml::gltf {
namespace {

// The modes of a primitive (glTF 2.0, 5.24.4).
enum Mode : uint64_t { points, lines, lineLoop, lineStrip, triangles, triangleStrip, triangleFan };

// Returns the numbers as values of a field with as many components.
template <class T> std::vector<T> valuesOf(const Values& values) {
  static_assert(sizeof(T) % sizeof(float) == 0);
  std::vector<T> out(values.size());
  if (!out.empty())
    std::memcpy(static_cast<void*>(out.data()), values.numbers.data(), out.size() * sizeof(T));
  return out;
}

// Appends the polylines of a mode.
MFInt32 lineIndex(const std::vector<uint32_t>& index, uint64_t mode, size_t count, uint64_t& bad) {
  MFInt32 out;
  const auto add = [&](size_t from, size_t to) { // [from, to) of the index
    const bool good = to - from >= 2 &&
                      std::all_of(index.begin() + ptrdiff_t(from), index.begin() + ptrdiff_t(to),
                                  [&](uint32_t i) { return i < count; });
    bad += !good;
    if (!good) return;
    for (size_t i = from; i < to; ++i) out.push_back(int32_t(index[i]));
    if (mode == lineLoop) out.push_back(int32_t(index[from]));
    out.push_back(-1);
  };
  if (mode == lines) {
    out.reserve(index.size() / 2 * 3);
    for (size_t i = 0; i + 1 < index.size(); i += 2) add(i, i + 2);
  } else {
    add(0, index.size());
  }
  return out;
}

// u, v with the origin at the picture's upper left, as they are in the file, to s, t with the
// origin at the lower left. KHR_texture_transform scales, rotates counter-clockwise as seen in the
// picture, then moves.
void toTexCoord(const TexCoordUse& use, Vec2f& uv) {
  const double u = double(uv.x) * use.scale[0], v = double(uv.y) * use.scale[1];
  const double c = std::cos(use.rotation), s = std::sin(use.rotation);
  uv = {float(c * u + s * v + use.offset[0]), float(1 - (c * v - s * u + use.offset[1]))};
}

} // namespace

Primitives::Primitives(const MeshFile& file, NodeStream& nodes, const Item& root,
                       Accessors& accessors, Materials& materials)
    : file_(file), nodes_(nodes), accessors_(accessors), materials_(materials),
      scratch_(file.budget), meshes_(root.list("meshes")), written_(meshes_.size()) {}

void Primitives::addTo(const Deformation& deformation, size_t mesh) {
  const std::vector<Item> primitives = meshes_[mesh].list("primitives");
  for (size_t i = 0; i < primitives.size(); ++i) {
    if (!primitives[i]) continue;
    scratch_ = Scratch(file_.budget);
    if (primitives[i].count("mode", triangles) == points) {
      primitives[i].warn("points have no skin; they stay where the mesh has them");
      continue;
    }
    Vertices vertices;
    if (!readVertices(primitives[i], vertices)) continue;
    morph(primitives[i], deformation.weights, vertices);
    deformation.skins->add({deformation.node, i}, deformation.skin,
                           primitives[i].object("attributes"), std::move(vertices));
  }
}

void Primitives::write(size_t number, const Deformation& deformation) {
  const Item& mesh = meshes_[number];
  const bool shared = deformation.weights.empty() && !deformation.skins && !keepMorphs_;
  if (shared && !written_[number].empty()) return nodes_.use(written_[number]);
  const std::vector<Item> primitives = mesh.list("primitives");
  const std::string_view def = nodes_.define(mesh.text("name"), "Mesh");
  if (shared) written_[number] = def;
  nodes_.open("Group", def);
  nodes_.openField("children");
  for (size_t i = 0; i < primitives.size(); ++i)
    if (primitives[i])
      writePrimitive(primitives[i], deformation,
                     deformation.skins ? deformation.skins->find({deformation.node, i}) : nullptr);
  nodes_.closeField();
  nodes_.close();
}

void Primitives::writePrimitive(const Item& primitive, const Deformation& deformation,
                                Skins::Part* part) {
  scratch_ = Scratch(file_.budget);
  Vertices vertices;
  if (part) {
    vertices.colors = std::move(part->colors);
    vertices.alphas = std::move(part->alphas);
  } else if (deformation.skins && primitive.count("mode", triangles) != points) {
    return; // it could not be read
  } else {
    if (!readVertices(primitive, vertices)) return;
    morph(primitive, deformation.weights, vertices);
  }
  writeGeometry(primitive, std::move(vertices), deformation, part);
}

// Reads an attribute of three numbers for each vertex; empty if there is none. count: the number
// of vertices; 0: any.
MFVec3f Primitives::readVectors(const Item& attributes, std::string_view name, size_t count) {
  const auto accessor = attributes.index(name, accessors_.size());
  if (!accessor) return {};
  const Values values = accessors_.read(*accessor);
  if (values.components != 3 || (count > 0 && values.size() != count)) {
    if (values.components > 0)
      attributes.error(fmt::format("{} should have VEC3 for each vertex; it is left out", name));
    return {};
  }
  scratch_.take(values.numbers.size() * sizeof(float));
  return valuesOf<Vec3f>(values);
}

bool Primitives::readVertices(const Item& primitive, Vertices& vertices) {
  const Item attributes = primitive.object("attributes");
  if (primitive.extension("KHR_draco_mesh_compression") && !attributes.has("POSITION"))
    return false;
  if (!attributes.has("POSITION")) {
    primitive.warn("the primitive has no POSITION, so there is nothing to draw");
    return false;
  }
  vertices.points = readVectors(attributes, "POSITION", 0);
  if (vertices.points.empty() || vertices.points.size() > INT32_MAX / 8) return false;
  vertices.normals = readVectors(attributes, "NORMAL", vertices.points.size());
  readColors(attributes, vertices);
  return true;
}

void Primitives::readColors(const Item& attributes, Vertices& vertices) {
  const auto accessor = attributes.index("COLOR_0", accessors_.size());
  if (!accessor) return;
  const Values values = accessors_.read(*accessor);
  const size_t n = values.components;
  if ((n != 3 && n != 4) || values.size() != vertices.points.size()) {
    if (n > 0) attributes.error("COLOR_0 should have VEC3 or VEC4 for each vertex; it is left out");
    return;
  }
  scratch_.take(values.numbers.size() * sizeof(float));
  vertices.colors.reserve(values.size());
  bool opaque = true;
  for (size_t i = 0; i < values.size(); ++i) {
    const float* c = &values.numbers[i * n];
    const auto part = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
    vertices.colors.push_back({part(c[0]), part(c[1]), part(c[2])});
    opaque = opaque && (n == 3 || c[3] >= 1);
  }
  for (size_t i = 0; !opaque && i < values.size(); ++i)
    vertices.alphas.push_back(std::clamp(values.numbers[i * n + 3], 0.0f, 1.0f));
}

MFInt32 Primitives::faceIndex(const std::vector<uint32_t>& index, uint64_t mode, uint64_t& bad,
                              size_t count) const {
  MFInt32 out;
  const size_t faces = mode == triangles  ? index.size() / 3
                       : index.size() < 3 ? 0
                                          : index.size() - 2;
  out.reserve(4 * faces);
  for (size_t i = 0; i < faces; ++i) {
    uint32_t corner[3];
    if (mode == triangles)
      std::copy_n(&index[3 * i], 3, corner);
    else if (mode == triangleFan) // glTF 2.0, 3.7.2.1
      corner[0] = index[i + 1], corner[1] = index[i + 2], corner[2] = index[0];
    else
      corner[0] = index[i], corner[1] = index[i + 1 + i % 2], corner[2] = index[i + 2 - i % 2];
    if (corner[0] >= count || corner[1] >= count || corner[2] >= count) {
      ++bad;
      continue;
    }
    // Strips hold triangles without area where they turn.
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[0] == corner[2]) continue;
    for (const uint32_t c : corner) out.push_back(int32_t(c));
    out.push_back(-1);
  }
  return out;
}

// Reads the indices of a primitive as those of a face or line set. Returns whether it has anything
// to draw.
bool Primitives::readIndices(const Item& primitive, uint64_t mode, size_t count,
                             MFInt32& coordIndex) {
  std::vector<uint32_t> index;
  if (const auto accessor = primitive.index("indices", accessors_.size())) {
    index = accessors_.readIndices(*accessor, scratch_);
  } else if (!primitive.has("indices")) {
    scratch_.take(count * sizeof(uint32_t));
    index.resize(count);
    for (size_t i = 0; i < count; ++i) index[i] = uint32_t(i);
  }
  if (index.size() > INT32_MAX / 8) {
    primitive.error("too many indices");
    return false;
  }
  scratch_.take(4 * index.size() * sizeof(int32_t));
  uint64_t bad = 0;
  if (mode >= triangles)
    coordIndex = faceIndex(index, mode, bad, count);
  else if (mode > points)
    coordIndex = lineIndex(index, mode, count, bad);
  if (bad > 0)
    primitive.error(fmt::format("{} triangles or lines name a vertex that is not there (there are "
                                "{}); they are left out",
                                bad, count));
  return mode == points || !coordIndex.empty();
}

void Primitives::writeGeometry(const Item& primitive, Vertices&& vertices,
                               const Deformation& deformation, const Skins::Part* part) {
  const uint64_t mode = primitive.count("mode", triangles);
  const size_t count = part ? part->count : vertices.points.size();
  if (mode > triangleFan) return primitive.error(fmt::format("{} is no mode of a primitive", mode));
  const bool faces = mode >= triangles;
  MFInt32 coordIndex;
  if (!readIndices(primitive, mode, count, coordIndex)) return;
  const auto material = primitive.index("material", materials_.size());
  const bool smooth = part ? part->smooth : !vertices.normals.empty();
  nodes_.open("Shape");
  faces ? materials_.writeSurface(material) : materials_.writeUnlit(material);
  nodes_.openIn("geometry", faces            ? "IndexedFaceSet"
                            : mode == points ? "PointSet"
                                             : "IndexedLineSet");
  // A Color node stands for the base colour, which glTF multiplies.
  const Color base = materials_.baseColor(material);
  for (Color& c : vertices.colors) c = encoded({c.r * base.r, c.g * base.g, c.b * base.b});
  // The opacities of a ColorRGBA stand in place of the material's.
  if (const auto alpha = materials_.baseAlpha(material))
    for (float& a : vertices.alphas) a *= *alpha;
  else
    vertices.alphas.clear();
  const Item attributes = primitive.object("attributes");
  if (!faces) vertices.normals.clear();
  const bool own =
      !deformation.weights.empty() || deformation.skins || keepMorphs_ || base != Color{1, 1, 1};
  if (part) {
    nodes_.useIn("coord", deformation.skins->coordinate());
    if (faces && smooth) nodes_.useIn("normal", deformation.skins->normal());
  } else {
    writeVertices(attributes, vertices, own);
  }
  const bool colored = !vertices.colors.empty();
  writeColors(attributes, std::move(vertices), own);
  bool textured = false;
  if (faces) {
    textured = writeTexCoords(attributes, material, count);
    if (materials_.isDoubleSided(material)) nodes_.set("solid", false);
    if (!smooth) nodes_.set("creaseAngle", 0.0f); // flat, as 3.7.2.1 asks
  }
  if (part && part->count < deformation.skins->vertices()) {
    if (colored) nodes_.set("colorIndex", MFInt32(coordIndex));
    if (textured) nodes_.set("texCoordIndex", MFInt32(coordIndex));
    for (int32_t& index : coordIndex)
      if (index >= 0) index += int32_t(part->first);
  }
  if (mode != points) nodes_.set("coordIndex", std::move(coordIndex));
  nodes_.closeIn();
  nodes_.close();
}

// Writes a node with an array, or a USE of one with the same array. key: of the array; empty: it is
// not shared.
template <class T> void Primitives::writeShared(std::string_view field, std::string_view type,
                                                std::string_view values, const std::string& key,
                                                T&& data) {
  if (const auto known = shared_.find(key); !key.empty() && known != shared_.end())
    return nodes_.useIn(field, known->second);
  std::string_view def;
  if (!key.empty()) def = shared_[key] = nodes_.define(key, key);
  nodes_.openIn(field, type, def);
  nodes_.set(values, std::move(data));
  nodes_.closeIn();
}

// Returns the key of the node for an attribute. Primitives that share an accessor share the node,
// if nothing has changed the values.
std::string Primitives::keyOf(const Item& attributes, std::string_view name, bool own) const {
  const auto accessor = attributes.index(name, accessors_.size());
  return own || !accessor ? std::string() : fmt::format("{}_{}", name, *accessor);
}

// Writes points and normals.
void Primitives::writeVertices(const Item& attributes, Vertices& vertices, bool own) {
  if (keepMorphs_ && !morphs_.empty() && morphs_.back().coordinate.empty()) {
    morphs_.back().coordinate = nodes_.define("Morph", "Morph");
    nodes_.openIn("coord", "Coordinate", morphs_.back().coordinate);
    nodes_.set("point", std::move(vertices.points));
    nodes_.closeIn();
  } else {
    writeShared("coord", "Coordinate", "point", keyOf(attributes, "POSITION", own),
                std::move(vertices.points));
  }
  if (!vertices.normals.empty())
    writeShared("normal", "Normal", "vector", keyOf(attributes, "NORMAL", own),
                std::move(vertices.normals));
}

void Primitives::writeColors(const Item& attributes, Vertices&& vertices, bool own) {
  if (!vertices.alphas.empty()) {
    MFColorRGBA colors;
    colors.reserve(vertices.colors.size());
    for (size_t i = 0; i < vertices.colors.size(); ++i) {
      const Color& c = vertices.colors[i];
      colors.push_back({c.r, c.g, c.b, vertices.alphas[i]});
    }
    writeShared("color", "ColorRGBA", "color", "", std::move(colors));
  } else if (!vertices.colors.empty()) {
    writeShared("color", "Color", "color", keyOf(attributes, "COLOR_0", own),
                std::move(vertices.colors));
  }
}

// Returns whether there are any.
bool Primitives::writeTexCoords(const Item& attributes, std::optional<size_t> material,
                                size_t count) {
  struct Set {
    std::string key, mapping;
    MFVec2f values;
  };
  std::vector<Set> sets;
  const std::vector<TexCoordUse> uses = materials_.texCoords(material);
  for (size_t i = 0; i < uses.size(); ++i) {
    const std::string name = fmt::format("TEXCOORD_{}", uses[i].set);
    const auto accessor = attributes.index(name, accessors_.size());
    if (!accessor) continue;
    Values values = accessors_.read(*accessor);
    if (values.components != 2 || values.size() != count) {
      if (values.components > 0)
        attributes.error(fmt::format("{} should have VEC2 for each vertex; it is left out", name));
      continue;
    }
    scratch_.take(values.numbers.size() * sizeof(float));
    Set set{fmt::format("{}_{}", name, *accessor), Materials::mappingName(i),
            valuesOf<Vec2f>(values)};
    const TexCoordUse plain{uses[i].set, {0, 0}, {1, 1}, 0};
    if (!(uses[i] == plain)) set.key.clear();
    if (uses.size() > 1) set.key.clear(); // its mapping is the material's
    for (Vec2f& uv : set.values) toTexCoord(uses[i], uv);
    sets.push_back(std::move(set));
  }
  if (sets.empty()) return false;
  const bool several = uses.size() > 1 && nodes_.knows("MultiTextureCoordinate") &&
                       nodes_.knows("TextureCoordinate", "mapping");
  if (!several) {
    writeShared("texCoord", "TextureCoordinate", "point", sets[0].key, std::move(sets[0].values));
    return true;
  }
  nodes_.openIn("texCoord", "MultiTextureCoordinate");
  nodes_.openField("texCoord");
  for (Set& set : sets) {
    nodes_.open("TextureCoordinate");
    nodes_.set("mapping", set.mapping);
    nodes_.set("point", std::move(set.values));
    nodes_.close();
  }
  nodes_.closeField();
  nodes_.closeIn();
  return true;
}

} // namespace xvrml::gltf
