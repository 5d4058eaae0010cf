// face_sets.cpp: IndexedFaceSet, and Cube where its faces have materials of their own.
#include <algorithm>
#include <cmath>

#include "geometry/texture_mapping.h"
#include "parse/vrml1/shapes.h"

namespace xvrml::vrml1 {
namespace {

// Returns the largest index; -1 if there is none.
int32_t largest(const MFInt32& indices) {
  return indices.empty() ? -1 : *std::max_element(indices.begin(), indices.end());
}

// Returns the indices of the chosen faces. perCorner: `indices` is parallel to coordIndex.
MFInt32 chosenFrom(const MFInt32& indices, bool perCorner, const MFInt32& coordIndex,
                   const std::vector<uint32_t>& chosen) {
  MFInt32 result;
  if (indices.empty()) return result;
  if (!perCorner) {
    for (const uint32_t face : chosen) result.push_back(indices[face]);
    return result;
  }
  size_t next = 0;
  uint32_t face = 0;
  for (size_t i = 0; i < coordIndex.size(); ++i) {
    if (coordIndex[i] < 0) continue;
    const bool mine = next < chosen.size() && chosen[next] == face;
    if (mine) result.push_back(i < indices.size() ? indices[i] : 0);
    if (i + 1 < coordIndex.size() && coordIndex[i + 1] >= 0) continue;
    if (mine) {
      result.push_back(-1);
      ++next;
    }
    ++face;
  }
  return result;
}

// Returns the material of each face: its own, or that of its first corner. `mixed` becomes true if
// the corners of a face have materials that differ in more than their colour.
std::vector<uint32_t> classes(const MFInt32& indices, bool perCorner, const MFInt32& coordIndex,
                              const std::vector<uint32_t>& first, bool& mixed) {
  std::vector<uint32_t> result;
  if (!perCorner) {
    for (const int32_t index : indices) result.push_back(first[size_t(index)]);
    return result;
  }
  bool open = false;
  for (size_t i = 0; i < coordIndex.size(); ++i) {
    if (coordIndex[i] < 0) {
      open = false;
      continue;
    }
    const uint32_t found = first[size_t(std::max(indices[i], 0))];
    if (!open) result.push_back(found);
    mixed = mixed || result.back() != found;
    open = true;
  }
  return result;
}

} // namespace

MFNode Shapes::faces(Faces& faces, State& state) {
  const size_t count = faceCount(faces.coordIndex);
  if (count == 0) return {};
  const Binding bound = binding(state, Slot::materialBinding, Binding::overall);
  if (bound == Binding::overall || looks_.list(state).count == 1)
    return {faceSet(faces, state, dress(faces, state, false), {}, nullptr)};
  const Indices indices = materials(state, faces.coordIndex, faces.materialIndex, bound);
  const Looks::List& list = looks_.list(state);
  if (list.uniform) return {faceSet(faces, state, dress(faces, state, false), indices, nullptr)};
  bool mixed = false;
  const std::vector<uint32_t> classOf =
      classes(indices.values, indices.perCorner, faces.coordIndex, list.first, mixed);
  if (mixed)
    graph_.warnOnce(faces.from, "mixed materials",
                    "materials of one face differ in more than their colour: transparency, "
                    "highlights and own light are those of its first vertex");
  std::map<uint32_t, std::vector<uint32_t>> parts;
  for (uint32_t face = 0; face < classOf.size(); ++face) parts[classOf[face]].push_back(face);
  const Dress dressed = dress(faces, state, parts.size() > 1);
  MFNode shapes;
  for (const auto& [first, chosen] : parts) {
    if (graph_.isStopped()) break;
    shapes.push_back(faceSet(faces, state, dressed, indices, parts.size() > 1 ? &chosen : nullptr));
  }
  return shapes;
}

// Makes a Shape of all faces, or of the chosen ones. materials: none if one material is for all.
NodeRef Shapes::faceSet(const Faces& faces, State& state, const Dress& dress,
                        const Indices& materials, const std::vector<uint32_t>* chosen) {
  const auto select = [&](const MFInt32& indices, bool perCorner) {
    return chosen ? chosenFrom(indices, perCorner, faces.coordIndex, *chosen) : indices;
  };
  auto* set = graph_.make<nodes::IndexedFaceSet>(faces.from);
  const NodeRef geometry(set);
  set->coord = faces.coord;
  set->coordIndex = select(faces.coordIndex, true);
  set->normal = dress.normal;
  set->normalPerVertex = dress.normals.perCorner;
  set->normalIndex = select(dress.normals.values, dress.normals.perCorner);
  set->texCoord = dress.texCoord;
  set->texCoordIndex = select(dress.texCoordIndex, true);
  const TreeNode* hints = state.node(Slot::shapeHints);
  if (!hints) hints = &defaultNode(Kind::shapeHints);
  const std::string& ordering = hints->get<SFString>("vertexOrdering");
  set->ccw = ordering != "CLOCKWISE";
  set->solid = ordering != "UNKNOWN_ORDERING" && hints->get<SFString>("shapeType") == "SOLID";
  set->convex = hints->get<SFString>("faceType") == "CONVEX";
  if (!set->normal) set->creaseAngle = hints->get<float>("creaseAngle");
  size_t material = 0;
  Use use = Use::surface;
  MFInt32 colours = select(materials.values, materials.perCorner);
  int32_t first = -1;
  for (const int32_t index : colours) {
    if (index < 0) continue;
    if (first < 0) first = index;
    if (index != first) use = Use::colours;
  }
  if (first >= 0) material = size_t(first);
  if (use == Use::colours) {
    material = looks_.list(state).first[material];
    set->color = looks_.colours(faces.from, state, Use::surface);
    set->colorPerVertex = materials.perCorner;
    if (!materials.perCorner || colours != set->coordIndex) set->colorIndex = std::move(colours);
  }
  return shape(faces.from, looks_.appearance(faces.from, state, material, use),
               graph_.finish(geometry));
}

// split: the faces become several Shapes.
Shapes::Dress Shapes::dress(const Faces& faces, State& state, bool split) {
  Dress result;
  if (faces.hasNormals) dressNormals(faces, state, result);
  dressTexture(faces, state, split, result);
  return result;
}

// "The DEFAULT normal binding is equal to PER_VERTEX_INDEXED; if insufficient normals exist in the
// state, vertex normals will be generated automatically." (IndexedFaceSet)
void Shapes::dressNormals(const Faces& faces, State& state, Dress& dress) {
  const NodeRef node = normals(state);
  if (!node) return;
  const auto count = static_cast<int64_t>(nodeCast<nodes::Normal>(node)->vector.size());
  const Binding bound = binding(state, Slot::normalBinding, Binding::perVertexIndexed);
  Indices indices;
  indices.perCorner = bound == Binding::perVertex || bound == Binding::perVertexIndexed;
  indices.values = boundIndices(faces.coordIndex, faces.normalIndex, bound);
  if (largest(indices.values) >= count) {
    const TreeNode* chosen = state.node(Slot::normalBinding);
    if (chosen && chosen->get<SFString>("value") != "DEFAULT")
      graph_.warnOnce(faces.from, "normals",
                      "there are fewer normals than the shape refers to; normals are computed");
    return;
  }
  if (indices.perCorner && indices.values == faces.coordIndex) indices.values.clear();
  dress.normal = node;
  dress.normals = std::move(indices);
}

// Texture coordinates are those of the state, or those of VRML97's default mapping, which VRML 1.0
// has, too. They become explicit where VRML97 would compute others: for a part of the faces, and
// for a transformation that no TextureTransform can say.
void Shapes::dressTexture(const Faces& faces, State& state, bool split, Dress& dress) {
  if (!looks_.isTextured(state)) return;
  const TextureChain* chain = looks_.unspeakable(state);
  dress.texCoord = faces.texCoord;
  if (dress.texCoord) {
    dress.texCoordIndex = faces.texCoordIndex;
  } else if (const NodeRef given = textureCoordinates(state)) {
    const bool own = !isAbsent(faces.texCoordIndex);
    const MFInt32& indices = own ? faces.texCoordIndex : faces.coordIndex;
    const auto count =
        static_cast<int64_t>(nodeCast<nodes::TextureCoordinate>(given)->point.size());
    if (largest(indices) < count) {
      dress.texCoord = given;
      if (own) dress.texCoordIndex = indices;
    } else if (own) {
      graph_.warnOnce(faces.from, "texture coordinates",
                      "there are fewer texture coordinates than the shape refers to; the picture "
                      "is laid over the whole shape");
    }
  }
  if (chain && dress.texCoord) dress.texCoord = changed(faces.from, *chain, dress.texCoord);
  const auto* coord = nodeCast<nodes::Coordinate>(faces.coord);
  if (!dress.texCoord && (split || chain) && coord) {
    std::vector<uint32_t> used;
    for (const int32_t index : faces.coordIndex)
      if (index >= 0 && size_t(index) < coord->point.size()) used.push_back(uint32_t(index));
    auto* mapped = graph_.make<nodes::TextureCoordinate>(faces.from);
    mapped->point = defaultTextureMapping(coord->point, used);
    for (Vec2f& point : mapped->point)
      if (chain) point = chain->apply(point);
    dress.texCoord = graph_.finish(mapped);
  }
}

// A Cube is a Box, or a set of faces if its faces have materials of their own: front, back, left,
// right, top, bottom.
MFNode Shapes::cube(const TreeNode& node, State& state) {
  const auto half = [&](const char* edge) { return std::abs(node.get<float>(edge)) / 2; };
  // VRML97 wants a Box to be thick; one that is flat keeps a trace of its thickness.
  const float thin = std::max({half("width"), half("height"), half("depth")}) * 1e-6f;
  const float x = std::max(half("width"), thin), y = std::max(half("height"), thin),
              z = std::max(half("depth"), thin);
  if (thin == 0) return {};
  const Binding bound = binding(state, Slot::materialBinding, Binding::overall);
  const bool whole = bound == Binding::overall || bound == Binding::perVertex ||
                     bound == Binding::perVertexIndexed || looks_.list(state).count == 1;
  if (whole) {
    auto* box = graph_.make<nodes::Box>(node);
    box->size = {2 * x, 2 * y, 2 * z};
    return {shape(node, looks_.appearance(node, state, 0, Use::surface), graph_.finish(box))};
  }
  Faces cube{node, {}, {}, {}, {}, {}, {}, false};
  auto* coord = graph_.make<nodes::Coordinate>(node);
  coord->point = {{-x, -y, z},  {x, -y, z},  {x, y, z},  {-x, y, z},
                  {-x, -y, -z}, {x, -y, -z}, {x, y, -z}, {-x, y, -z}};
  cube.coord = graph_.finish(coord);
  cube.coordIndex = {0, 1, 2, 3, -1, 5, 4, 7, 6, -1, 4, 0, 3, 7, -1,
                     1, 5, 6, 2, -1, 3, 2, 6, 7, -1, 4, 5, 1, 0, -1};
  if (looks_.isTextured(state)) {
    auto* map = graph_.make<nodes::TextureCoordinate>(node);
    map->point = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    cube.texCoord = graph_.finish(map);
    for (int face = 0; face < 6; ++face)
      cube.texCoordIndex.insert(cube.texCoordIndex.end(), {0, 1, 2, 3, -1});
  }
  MFNode shapes = faces(cube, state);
  for (const NodeRef& made : shapes) { // a Cube has its own order of vertices, and flat faces
    auto* set = nodeCast<nodes::IndexedFaceSet>(nodeCast<nodes::Shape>(made)->geometry);
    set->ccw = true;
    set->convex = true;
    set->creaseAngle = 0;
  }
  return shapes;
}

} // namespace xvrml::vrml1
