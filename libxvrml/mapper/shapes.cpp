// shapes.cpp: writes the content of an open object: instances of the objects below and shapes with
// their arrays, matrix and surface. Part of class Objects.
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/texture_generator.h"
#include "mapper/graph/objects.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

namespace {
static_assert(int(TexGen::sphereReflection) == RT_TEX_GEN_SPHERE_REFLECTION);

constexpr double farthestFloat = 1e38;
constexpr double farthestDrawn = 1e20; // by the renderer (decision 62)

RTenum modeOf(Mesh::Kind kind) {
  return kind == Mesh::Kind::lines    ? RT_LINES
         : kind == Mesh::Kind::points ? RT_POINTS
                                      : RT_TRIANGLES;
}

// Returns the mesh with its colours decoded to linear light, in `storage` if it has any.
const Mesh& withLinearColors(const Mesh& mesh, Mesh& storage) {
  if (mesh.colors.empty()) return mesh;
  storage.kind = mesh.kind;
  storage.points = mesh.points;
  storage.indices = mesh.indices;
  storage.normals = mesh.normals;
  storage.texCoords = mesh.texCoords;
  storage.texPlaces = mesh.texPlaces;
  storage.alphas = mesh.alphas;
  storage.fogCoords = mesh.fogCoords;
  storage.solid = mesh.solid;
  storage.ccw = mesh.ccw;
  storage.texGen = mesh.texGen;
  for (const Color& color : mesh.colors) storage.ownColors.push_back(convert(color, true));
  storage.colors = storage.ownColors;
  return storage;
}

// Draws a surface without facets under the current matrix.
void drawExact(const ExactSurface& exact) {
  const double* n = exact.numbers.data();
  if (exact.kind == ExactSurface::Kind::quadric) return rtQuadric(n, n + 10, n + 13);
  rtPushMatrix();
  rtTranslated(0, exact.height, 0);
  if (exact.facing != ExactSurface::Facing::z)
    rtRotated(exact.facing == ExactSurface::Facing::up ? -90 : 90, 1, 0, 0);
  rtAsphere(n[0], n[1], exact.numbers.size() - 4, n + 4, n[2], n[3]);
  rtPopMatrix();
}
} // namespace

void Objects::enter(ItemId id, int32_t at, const Matrix& matrix) {
  const Item& item = graph_.items[id];
  if (at == none && !item.draws) return;
  if (at != none && places_.all[size_t(at)].split) {
    Place& place = places_.all[size_t(at)];
    const bool turnsToViewer = item.kind == Kind::billboard && live_;
    place.base = matrix;
    place.instance =
        instantiate(partOfPlace(size_t(at)),
                    compose(graph_.below(matrix, item), places_.billboardRotations[size_t(at)]), 0,
                    item.moves || turnsToViewer);
  } else if (at == none && item.objectReason != ObjectReason::none) {
    const RTid instance = instantiate(partOfItem(id), graph_.below(matrix, item), 0, item.moves);
    if (item.moves) keep(id, instance, matrix);
  } else {
    stack_.push_back({id, at, graph_.below(matrix, item)});
  }
}

void Objects::expand(const Step& step) {
  const Item& item = graph_.items[step.item];
  if (item.kind == Kind::shape) return writeShape(step.item, step.matrix);
  const bool oneLevel = item.kind == Kind::lod; // an LOD without a place of its own, see summarise
  for (size_t c = oneLevel ? std::min(item.children.size(), size_t(1)) : item.children.size();
       c-- > 0;) {
    const int32_t at = step.place == none
                           ? none
                           : places_.children[places_.all[size_t(step.place)].firstChild + c];
    enter(item.children[c], at, step.matrix);
  }
}

void Objects::drain() {
  while (!stack_.empty()) {
    const Step step = stack_.back();
    stack_.pop_back();
    expand(step);
  }
}

// Notes how far something of this extent reaches under this matrix, and warns once for each node if
// that is beyond what the renderer draws. Whether it is drawn does not depend on that: instances
// move later, when what is around them is not measured again. The renderer leaves out what is too
// large or too far away. node: null for the world. isShape: nothing below has been told of.
void Objects::measure(const Matrix& matrix, double reach, const Node* node, bool isShape) {
  double far = 0;
  for (int i = 0; i < 3; ++i) {
    const double turned =
        std::abs(matrix.x[0][i]) + std::abs(matrix.x[1][i]) + std::abs(matrix.x[2][i]);
    far = std::max(far, std::abs(matrix.x[3][i]) + turned * reach);
    if (!(far <= farthestFloat)) far = std::numeric_limits<double>::infinity(); // also for NaN
  }
  const bool isFloat = far <= farthestFloat;
  if (isFloat) {
    Part& part = parts_[size_t(writing_)];
    part.reach = std::max(part.reach, far);
  }
  if (far <= farthestDrawn || (isFloat && reach > farthestDrawn && !isShape) ||
      !toldFar_.insert(node).second)
    return;
  const std::string what = node ? node->type().name : "the world";
  world_.diagnostics.warn(
      node ? node->source : SourcePosition(),
      isFloat ? what + " reaches beyond 1e20, by its coordinates or the Transforms around it; what "
                       "is there may be missing in pictures"
              : what + " is larger than 1e38, or further away, by the Transforms around it; what "
                       "is there is left out");
}

// dynamic: events or the camera will move the instance.
RTid Objects::instantiate(int32_t id, const Matrix& matrix, uint32_t number, bool dynamic) {
  const Part& used = parts_[size_t(id)];
  const NodeRef node = used.kind == Part::Kind::mesh ? NodeRef(&graph_.meshes.geometry(used.mesh))
                                                     : graph_.items[used.item].node;
  const SourcePosition where = node ? node->source : SourcePosition();
  measure(matrix, used.reach, node.get(), used.kind == Part::Kind::mesh);
  if (!finite(matrix) && !dynamic) return 0;
  const uint64_t flattenedInstances =
      std::max<uint64_t>(used.flattenedInstances + (used.drawCalls > 0), 1);
  const uint64_t records = addSaturating(used.records, used.drawCalls);
  const uint64_t furtherRecords = records > flattenedInstances ? records - flattenedInstances : 0;
  const uint64_t bytes = addSaturating(multiplySaturating(flattenedInstances, bytesOfInstance),
                                       multiplySaturating(furtherRecords, bytesOfRecord));
  if (!quota_.take(bytes, where)) return 0;
  rtLoadName(number);
  load(placing(matrix));
  const RTid instance = rtInstantiateObject(parts_[size_t(id)].object);
  if (instance == 0) {
    quota_.give(bytes);
    report(world_.diagnostics, {}, "a group cannot be placed");
    return 0;
  }
  if (dynamic) rtInstanceHint(instance, RT_DYNAMIC);
  Part& part = parts_[size_t(writing_)];
  part.uses.push_back(id);
  part.bytes += bytes;
  part.flattenedInstances = addSaturating(part.flattenedInstances, flattenedInstances);
  part.records = addSaturating(part.records, records);
  ++parts_[size_t(id)].instances;
  ++instances_;
  return instance;
}

void Objects::keep(ItemId item, RTid instance, const Matrix& base) {
  if (instance == 0) return;
  trackedInstances_[item].push_back({instance, writing_, base});
  parts_[size_t(writing_)].moving.push_back(item);
}

SurfaceUse Objects::useOf(const Item& item) const {
  Node& geometry = graph_.meshes.geometry(item.mesh);
  const bool lines = item.lines && !item.viaMesh;
  return {.lines = lines,
          .thick = lines && graph_.meshes.extent(item.mesh).thick,
          .vertexAlpha = hasVertexAlpha(geometry),
          .byNormal = looksUpByNormal(geometry),
          .placed = hasTexPlaces(geometry)};
}

// Writes a shape. Its number is the name of everything it draws, so that the id channel tells
// shapes apart even within a shared object.
void Objects::writeShape(ItemId id, const Matrix& matrix) {
  const Item& item = graph_.items[id];
  Node* appearance = static_cast<nodes::Shape&>(*item.node).appearance.get();
  if (item.viaMesh) {
    const int32_t part = partOfMesh(graph_.meshes.equal(item.mesh));
    if (graph_.meshes.takesPhysicalPlaces(item.mesh) &&
        textureNeed(appearance) == TextureNeed::volume)
      world_.diagnostics.warn(item.node->source,
                              "its geometry shows a volume with a PhysicalMaterial or "
                              "UnlitMaterial, too: here only the first slice is seen");
    const RTid instance = instantiate(part, matrix, item.number, false);
    if (instance != 0)
      rtInstanceShader(instance, surfaces_.surfaceFor(appearance, useOf(item)).shader);
    if (item.recolored) keep(id, instance, matrix);
  } else {
    const Meshes::Extent extent = graph_.meshes.extent(item.mesh);
    if (extent.primitives == 0) return;
    measure(matrix, extent.reach, item.node.get(), true);
    if (!finite(matrix)) return;
    const Surface surface = surfaces_.surfaceFor(appearance, useOf(item));
    rtLoadName(item.number);
    load(matrix);
    HalfSpaces kept;
    for (const HalfSpace& halfSpace : kept_) kept.push_back(inside(halfSpace, matrix));
    if (!draw(item.mesh, surface, textureNeed(appearance) != TextureNeed::none, kept)) return;
  }
  ++parts_[size_t(writing_)].shapes;
  report(world_.diagnostics, item.node->source, "Shape");
}

// Draws a mesh. Returns false if the world's budget does not allow it.
bool Objects::draw(int32_t mesh, const Surface& surface, bool textured, const HalfSpaces& kept) {
  uint64_t primitives = graph_.meshes.extent(mesh).primitives;
  if (primitives == 0) return true;
  Mesh rest;
  bool isCut = false, linear = linear_;
  if (!kept.empty()) {
    Mesh lit; // the mesh with colours that mix as light does
    const Mesh& whole =
        linear_ ? withLinearColors(graph_.meshes.get(mesh), lit) : graph_.meshes.get(mesh);
    switch (cut(whole, kept, quota_.budget().left() / bytesWhileCut, rest)) {
    case Cut::whole: break;
    case Cut::part:
      isCut = true;
      linear = false;
      primitives = primitivesOf(rest);
      break;
    case Cut::nothing: return true;
    case Cut::tooLarge:
      return quota_.take(std::numeric_limits<uint64_t>::max(), graph_.meshes.geometry(mesh).source);
    }
  }
  const uint64_t bytes =
      addSaturating(multiplySaturating(primitives, bytesOfPrimitive), bytesOfShape);
  if (!quota_.take(bytes, graph_.meshes.geometry(mesh).source)) return false;
  const Mesh& m = isCut ? rest : graph_.meshes.get(mesh);
  Part& part = parts_[size_t(writing_)];
  part.bytes += bytes;
  part.primitives += primitives;
  if (m.kind == Mesh::Kind::triangles && m.exact.empty()) part.triangles += primitives;
  ++part.drawCalls;
  rtBindShader(surface.shader);
  rtLineWidth(surface.style.line);
  rtPointSize(surface.style.point);
  rtLineStipple(surface.style.factor, surface.style.pattern);
  (m.solid ? rtEnable : rtDisable)(RT_CULL_FACE);
  (m.ccw ? rtDisable : rtEnable)(RT_CW_FRONT);
  rtTexGen(textured ? RTenum(m.texGen) : RTenum(RT_TEX_GEN_OFF));
  if (m.kind == Mesh::Kind::sphere) {
    rtSphere(m.radius);
  } else if (!m.exact.empty()) {
    for (const ExactSurface& exact : m.exact) drawExact(exact);
  } else if (m.indices.size() <
             m.points.size()) { // several geometries share a Coordinate: each takes its part
    Mesh used;
    compact(m, used);
    drawArrays(used, surface, textured, linear);
  } else {
    drawArrays(m, surface, textured, linear);
  }
  rtBindShader(0);
  return true;
}

void Objects::drawArrays(const Mesh& m, const Surface& surface, bool textured, bool linear) {
  rtVertexPointer(3, RT_FLOAT, sizeof(Vec3f), m.points.data());
  rtNormalPointer(RT_FLOAT, sizeof(Vec3f), m.normals.empty() ? nullptr : m.normals.data());
  rtTexCoordPointer(2, RT_FLOAT, sizeof(Vec2f),
                    textured && !m.texCoords.empty() ? m.texCoords.data() : nullptr);
  // Texture coordinates in space are a parameter of vertices.
  const bool placed = surface.takesPlaces && textured && !m.texPlaces.empty();
  const int place = placed ? rtParameterHandle("texturePlace") : -1;
  if (place >= 0) rtParameterPointer(place, sizeof(Vec4f), &m.texPlaces[0].x);
  // Lines and points use emissiveColor.
  const bool plain = m.colors.empty() && surface.lines;
  const int components = m.alphas.empty() ? 3 : 4;
  if (!m.colors.empty() && !linear && m.alphas.empty()) {
    rtColorPointer(3, RT_FLOAT, sizeof(Color), m.colors.data());
  } else if (!m.colors.empty() || plain) {
    colors_.clear();
    colors_.reserve(size_t(components) * m.points.size());
    for (size_t i = 0; i < m.points.size(); ++i) {
      const Color c = plain ? surface.lineColor : convert(m.colors[i], linear);
      colors_.insert(colors_.end(), {c.r, c.g, c.b});
      if (components == 4) colors_.push_back(m.alphas[i]);
    }
    rtColorPointer(components, RT_FLOAT, 0, colors_.data());
  } else {
    rtColorPointer(3, RT_FLOAT, 0, nullptr);
  }
  rtFogCoordPointer(RT_FLOAT, 0, m.fogCoords.empty() ? nullptr : m.fogCoords.data());
  rtDrawElements(modeOf(m.kind), m.indices.size(), m.indices.data(), m.points.size());
  if (place >= 0) rtParameterPointer(place, 0, nullptr);
}

} // namespace xvrml::mapper
