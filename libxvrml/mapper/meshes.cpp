#include "mapper/meshes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include <xxhash.h>

#include "mapper/graph/cost.h"

namespace xvrml::mapper {
namespace {

// In primitives; fewer are never worth an instance (cost.h).
constexpr uint64_t minimumComparedPrimitives = 5;

template <class T> uint64_t hashed(std::span<const T> values, uint64_t seed) {
  return XXH3_64bits_withSeed(values.data(), values.size_bytes(), seed + values.size());
}

uint64_t contentHash(const Mesh& m) {
  const uint64_t flags =
      uint64_t(m.kind) | uint64_t(m.solid) << 8 | uint64_t(m.ccw) << 9 | uint64_t(m.texGen) << 16;
  const uint64_t colorless =
      hashed(m.texPlaces,
             hashed(m.texCoords, hashed(m.normals, hashed(m.indices, hashed(m.points, flags)))));
  return hashed(m.fogCoords, hashed(m.alphas, hashed(m.colors, colorless)));
}

double reachOf(const Mesh& m) {
  float reach = m.kind == Mesh::Kind::sphere ? m.radius : 0;
  for (const Vec3f& p : m.points) // NaN fails every comparison and is ignored
    for (const float v : {p.x, p.y, p.z})
      reach = std::abs(v) > reach && std::isfinite(v) ? std::abs(v) : reach;
  return double(reach);
}

uint64_t ownBytes(const Mesh& m) {
  return m.ownPoints.capacity() * sizeof(Vec3f) + m.ownNormals.capacity() * sizeof(Vec3f) +
         m.ownColors.capacity() * sizeof(Color) + m.ownAlphas.capacity() * sizeof(float) +
         m.ownFogCoords.capacity() * sizeof(float) + m.ownTexCoords.capacity() * sizeof(Vec2f) +
         m.ownTexPlaces.capacity() * sizeof(Vec4f) + m.ownIndices.capacity() * sizeof(uint32_t);
}

// Takes the triangles out of a large mesh that is about to be released, if they are the faces of
// its node.
std::unique_ptr<MeshTopology> topologyOf(Mesh& m) {
  if (!m.plain || m.ownIndices.size() < (1 << 14)) return nullptr;
  return std::make_unique<MeshTopology>(MeshTopology{std::move(m.ownIndices), m.points.size()});
}

template <class T> bool equalBytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

} // namespace

int32_t Meshes::add(Node& geometry, TextureNeed need) {
  const auto [known, fresh] = index_.insert(&geometry, int32_t(entries_.size()));
  if (fresh && !free_.empty()) {
    *known = free_.back();
    free_.pop_back();
  } else if (fresh) {
    entries_.emplace_back();
  }
  const int32_t mesh = *known;
  if (fresh) entries_[size_t(mesh)].geometry = NodeRef(&geometry);
  require(mesh, need);
  count(mesh, 1);
  return mesh;
}

void Meshes::drop(int32_t mesh) {
  count(mesh, -1);
  Entry& entry = entries_[size_t(mesh)];
  if (entry.users > 0) return;
  leave(mesh);
  forgetCorners();
  index_.erase(entry.geometry.get());
  entry = Entry();
  dropped_.push_back(mesh);
}

void Meshes::recycle() {
  free_.insert(free_.end(), dropped_.begin(), dropped_.end());
  dropped_.clear();
}

void Meshes::count(int32_t mesh, int32_t users) {
  Entry& entry = entries_[size_t(mesh)];
  entry.users += uint32_t(users);
  if (entry.group != none_) groups_[size_t(entry.group)].users += uint32_t(users);
}

int32_t Meshes::equal(int32_t mesh) const {
  const int32_t group = entries_[size_t(mesh)].group;
  return group == none_ ? mesh : groups_[size_t(group)].first;
}

uint32_t Meshes::users(int32_t mesh) const {
  const Entry& entry = entries_[size_t(mesh)];
  return entry.group == none_ ? entry.users : groups_[size_t(entry.group)].users;
}

int32_t Meshes::find(const Node* geometry) const {
  const int32_t* known = index_.find(geometry);
  return known ? *known : none_;
}

MeshOptions Meshes::optionsFor(TextureNeed need) const {
  return {.needTexCoords = need != TextureNeed::none,
          .exactShapes = exactShapes_,
          .pointSize = pointSize_,
          .lineWidth = lineWidth_,
          .needTexPlaces = need >= TextureNeed::volume};
}

bool Meshes::awaits(Node& geometry, TextureNeed need) {
  if (find(&geometry) != none_ || lengthOfFaces(geometry) / 3 > affordable()) return false;
  const auto make = [need, options = optionsFor(need),
                     limits = world_.options.limits](const NodeRef& copy) {
    Diagnostics found;
    MeshOptions own = options;
    own.limits = &limits;
    own.diagnostics = &found;
    auto mesh = std::make_unique<Mesh>(buildMesh(*copy, own));
    const uint64_t bytes = ownBytes(*mesh);
    mesh->takeAll();
    const uint64_t most = std::max(primitivesOf(*mesh), mostTriangles(*copy));
    return Built{std::move(mesh), bytes, most, found.list(), need};
  };
  return jobs_.ask(geometry, make) == GeometryJobs<Built>::State::pending;
}

bool Meshes::require(int32_t mesh, TextureNeed need) {
  Entry& entry = entries_[size_t(mesh)];
  if (entry.need >= need) return false;
  entry.need = need;
  if (!entry.known) return false;
  changed(mesh);
  return true;
}

void Meshes::setExactShapes(bool exact) {
  if (exactShapes_ == exact) return;
  exactShapes_ = exact;
  rebuildAll();
}

void Meshes::setThickness(float points, float lines) {
  if (points == pointSize_ && lines == lineWidth_) return;
  pointSize_ = points;
  lineWidth_ = lines;
  rebuildAll();
}

void Meshes::rebuildAll() {
  jobs_ = {};
  for (size_t mesh = 0; mesh < entries_.size(); ++mesh)
    if (entries_[mesh].geometry) changed(int32_t(mesh));
}

void Meshes::changed(int32_t mesh, bool vectorsOnly) {
  leave(mesh);
  forgetCorners();
  Entry& entry = entries_[size_t(mesh)];
  if (!vectorsOnly) entry.topology.reset();
  entry.mesh.reset();
  entry.known = false;
}

void Meshes::setDynamic(int32_t mesh, bool dynamic) {
  Entry& entry = entries_[size_t(mesh)];
  if (entry.dynamic == dynamic) return;
  entry.dynamic = dynamic;
  if (dynamic)
    leave(mesh);
  else
    entry.known = false; // grouped when it is built again
}

namespace {
// Returns whether the mesh of a geometry node has balls or rods in place of points or lines.
bool isThick(const Mesh& mesh, Node& geometry) {
  if (mesh.kind != Mesh::Kind::triangles) return false;
  const Node* rendered = renderedNode(&geometry);
  return rendered && rendered->type().is("lines");
}
} // namespace

// Returns how many triangles the budget left allows a mesh.
uint64_t Meshes::affordable() const {
  return quota_.budget().left() / (bytesWhileBuilt + bytesOfPrimitive);
}

// A job has no limit but that of the world. Its mesh is taken if the budget's would not have
// mattered.
std::optional<Meshes::Built> Meshes::takeBuilt(const Entry& entry) {
  std::optional<Built> built = jobs_.take(*entry.geometry);
  if (!built || built->need != entry.need || built->most > entry.triangles) return {};
  for (const Diagnostic& problem : built->problems) world_.diagnostics.add(problem);
  ++readBeside_;
  return built;
}

Meshes::Built Meshes::build(Entry& entry) {
  Limits limits = world_.options.limits;
  if (!entry.known) entry.triangles = affordable();
  const bool scarce = entry.triangles < limits.triangles;
  if (!entry.said)
    if (std::optional<Built> built = takeBuilt(entry)) return std::move(*built);
  if (scarce) limits.triangles = entry.triangles;
  const std::string name = scarce ? quota_.budget().name() : std::string();
  Diagnostics silent; // problems of the geometry were reported by the first build
  MeshOptions options = optionsFor(entry.need);
  options.limits = &limits;
  options.diagnostics = entry.said ? &silent : &world_.diagnostics;
  options.limitName = name;
  options.former = entry.topology.get();
  auto mesh = std::make_unique<Mesh>(buildMesh(*entry.geometry, options));
  const uint64_t bytes = ownBytes(*mesh);
  return {std::move(mesh), bytes, 0, {}, entry.need};
}

const Mesh& Meshes::get(int32_t mesh) {
  // Equal meshes share the arrays of the first of their group.
  if (const int32_t first = equal(mesh); first != mesh) return get(first);
  Entry& entry = entries_[size_t(mesh)];
  if (entry.mesh) return *entry.mesh;
  Built built = build(entry);
  entry.mesh = std::move(built.mesh);
  if (!quota_.take(built.bytes, entry.geometry->source)) *entry.mesh = Mesh();
  entry.said = true;
  built_.push_back(mesh);
  if (entry.known) return *entry.mesh;
  entry.known = true;
  entry.extent.reach = reachOf(*entry.mesh);
  entry.extent.kind = entry.mesh->kind;
  entry.extent.alpha = !entry.mesh->alphas.empty();
  entry.extent.byNormal = looksUpByNormal(*entry.geometry);
  entry.extent.placed = hasTexPlaces(*entry.geometry);
  entry.extent.thick = isThick(*entry.mesh, *entry.geometry);
  entry.extent.primitives = primitivesOf(*entry.mesh);
  if (!entry.dynamic && entry.extent.kind == Mesh::Kind::triangles &&
      entry.extent.primitives >= minimumComparedPrimitives)
    join(mesh);
  if (equal(mesh) == mesh) return *entry.mesh;
  quota_.give(built.bytes);
  entry.mesh.reset();
  return get(mesh);
}

bool Meshes::sameContent(int32_t a, int32_t b) {
  const Mesh &m = get(a), &n = get(b);
  // Places are given to one class of shaders.
  if (!m.texPlaces.empty() && takesPhysicalPlaces(a) != takesPhysicalPlaces(b)) return false;
  return m.kind == n.kind && m.solid == n.solid && m.ccw == n.ccw && m.texGen == n.texGen &&
         equalBytes(m.points, n.points) && equalBytes(m.indices, n.indices) &&
         equalBytes(m.normals, n.normals) && equalBytes(m.texCoords, n.texCoords) &&
         equalBytes(m.texPlaces, n.texPlaces) && equalBytes(m.colors, n.colors) &&
         equalBytes(m.alphas, n.alphas) && equalBytes(m.fogCoords, n.fogCoords);
}

int32_t Meshes::newGroup(uint64_t hash) {
  int32_t id = freeGroup_;
  if (id == none_) {
    id = int32_t(groups_.size());
    groups_.emplace_back();
  } else {
    freeGroup_ = groups_[size_t(id)].next;
  }
  groups_[size_t(id)] = Group{hash, 0, none_, none_};
  byContent_.insert(hash, uint32_t(id));
  return id;
}

// Adds a mesh to its group of equal content. Equal hashes are only a hint; the arrays are compared.
void Meshes::join(int32_t mesh) {
  Entry& entry = entries_[size_t(mesh)];
  const uint64_t hash = contentHash(*entry.mesh);
  const uint32_t known = byContent_.find(hash, [&](uint32_t group) {
    return groups_[group].hash == hash && sameContent(mesh, groups_[group].first);
  });
  const int32_t id = known == IndexTable::none ? newGroup(hash) : int32_t(known);
  Group& group = groups_[size_t(id)];
  if (group.first == none_) {
    group.first = mesh;
  } else { // insert after the first
    entry.previous = group.first;
    entry.next = entries_[size_t(group.first)].next;
    if (entry.next != none_) entries_[size_t(entry.next)].previous = mesh;
    entries_[size_t(group.first)].next = mesh;
  }
  entry.group = id;
  group.users += entry.users;
}

void Meshes::leave(int32_t mesh) {
  Entry& entry = entries_[size_t(mesh)];
  if (entry.group == none_) return;
  Group& group = groups_[size_t(entry.group)];
  group.users -= entry.users;
  if (entry.next != none_) entries_[size_t(entry.next)].previous = entry.previous;
  if (entry.previous != none_) entries_[size_t(entry.previous)].next = entry.next;
  if (group.first == mesh) group.first = entry.next;
  if (group.first == none_) {
    byContent_.erase(group.hash, uint32_t(entry.group));
    group.next = freeGroup_;
    freeGroup_ = entry.group;
  }
  entry.group = entry.next = entry.previous = none_;
}

Meshes::Extent Meshes::extent(int32_t mesh) {
  if (!entries_[size_t(mesh)].known) get(mesh);
  return entries_[size_t(mesh)].extent;
}

void Meshes::release() {
  jobs_.sweep();
  for (const int32_t mesh : built_) {
    Entry& entry = entries_[size_t(mesh)];
    if (entry.dynamic && entry.mesh) entry.topology = topologyOf(*entry.mesh);
    entry.mesh.reset();
  }
  built_.clear();
  forgetCorners();
  quota_.clear();
}

void growByPoint(Bounds& bounds, const Vector& p) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return;
  for (int i = 0; i < 3; ++i) {
    bounds.minimum[i] = bounds.empty ? p[i] : std::min(bounds.minimum[i], p[i]);
    bounds.maximum[i] = bounds.empty ? p[i] : std::max(bounds.maximum[i], p[i]);
  }
  bounds.empty = false;
}

void growByBox(Bounds& bounds, const Bounds& box, const Matrix& matrix) {
  if (box.empty) return;
  for (int corner = 0; corner < 8; ++corner) {
    auto side = [&](int axis) {
      return corner & (1 << axis) ? box.maximum[axis] : box.minimum[axis];
    };
    growByPoint(bounds, transformPoint(matrix, {side(0), side(1), side(2)}));
  }
}

// A sphere that is left whole is visited as a mesh.
template <class Visit>
void Meshes::eachCorner(int32_t mesh, const HalfSpaces& kept, const Visit& visit) {
  const Mesh& m = get(mesh);
  // A sphere that is left whole is found without memory.
  const uint64_t most = std::max<uint64_t>(quota_.budget().left() / bytesWhileCut, 1);
  Mesh rest;
  const bool whole = cut(m, kept, most, rest) == Cut::whole;
  if (whole && m.kind == Mesh::Kind::sphere) return visit(m);
  for (const Vec3f& corner : whole ? std::span<const Vec3f>(corners(mesh)) : rest.points)
    visit(vector(corner));
}

// Puts functions together: the one for an argument's type is called.
template <class... Functions> struct Overloaded : Functions... { using Functions::operator()...; };

void Meshes::grow(Bounds& bounds, int32_t mesh, const Matrix& matrix, const HalfSpaces& kept) {
  const auto sphere = [&](const Mesh& whole) {
    // The extent of an ellipsoid along a world axis is the length of that row of the linear part.
    const Vector center = transformPoint(matrix, Vector(0));
    Vector reach;
    for (int i = 0; i < 3; ++i)
      reach[i] = whole.radius * Vector(matrix.x[0][i], matrix.x[1][i], matrix.x[2][i]).length();
    growByPoint(bounds, center - reach);
    growByPoint(bounds, center + reach);
  };
  const auto point = [&](const Vector& corner) {
    growByPoint(bounds, transformPoint(matrix, corner));
  };
  eachCorner(mesh, kept, Overloaded{sphere, point});
}

// Returns the points that the mesh uses. Those of the last mesh are kept: worlds of many equal
// shapes ask for the same mesh again and again, so equal points are worth removing there.
const std::vector<Vec3f>& Meshes::corners(int32_t mesh) {
  const Mesh& m = get(mesh);
  const int32_t first = equal(mesh);
  if (cornersOf_ == first) return corners_;
  cornersOf_ = first;
  corners_.clear();
  // A Coordinate node may hold many points that this geometry does not use.
  if (m.indices.size() < m.points.size()) {
    for (const uint32_t index : m.indices)
      if (index < m.points.size()) corners_.push_back(m.points[index]);
  } else {
    std::vector<uint8_t> used(m.points.size());
    for (const uint32_t index : m.indices)
      if (index < used.size()) used[index] = 1;
    for (size_t i = 0; i < used.size(); ++i)
      if (used[i]) corners_.push_back(m.points[i]);
  }
  if (users(mesh) > 1) {
    const auto order = [](const Vec3f& a, const Vec3f& b) {
      return std::memcmp(&a, &b, sizeof a) < 0;
    };
    const auto same = [](const Vec3f& a, const Vec3f& b) {
      return std::memcmp(&a, &b, sizeof a) == 0;
    };
    std::sort(corners_.begin(), corners_.end(), order);
    corners_.erase(std::unique(corners_.begin(), corners_.end(), same), corners_.end());
  }
  return corners_;
}

double Meshes::reach(int32_t mesh, const Matrix& matrix, const Vector& from,
                     const HalfSpaces& kept) {
  double far = 0;
  const auto use = [&](double length) {
    if (length > far && std::isfinite(length)) far = length;
  };
  const auto sphere = [&](const Mesh& whole) {
    use((transformPoint(matrix, Vector(0)) - from).length() +
        whole.radius * largestStretch(matrix));
  };
  const auto point = [&](const Vector& corner) {
    use((transformPoint(matrix, corner) - from).length());
  };
  eachCorner(mesh, kept, Overloaded{sphere, point});
  return far;
}

void Meshes::add(Outermost& outermost, int32_t mesh, const Matrix& matrix, const HalfSpaces& kept) {
  const auto sphere = [&](const Mesh& whole) { outermost.addSphere(matrix, whole.radius); };
  const auto point = [&](const Vector& corner) { outermost.add(transformPoint(matrix, corner)); };
  eachCorner(mesh, kept, Overloaded{sphere, point});
}

uint64_t primitivesOf(const Mesh& mesh) {
  if (!mesh.exact.empty()) return mesh.exact.size();
  switch (mesh.kind) {
  case Mesh::Kind::empty: return 0;
  case Mesh::Kind::triangles: return mesh.indices.size() / 3;
  case Mesh::Kind::lines: return mesh.indices.size() / 2;
  case Mesh::Kind::points: return mesh.indices.size();
  case Mesh::Kind::sphere: return 1;
  }
  return 0;
}

void compact(const Mesh& mesh, Mesh& out) {
  std::vector<uint32_t> used(mesh.indices.begin(), mesh.indices.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  while (!used.empty() && used.back() >= mesh.points.size()) used.pop_back();
  out = Mesh();
  out.kind = mesh.kind;
  out.solid = mesh.solid;
  out.ccw = mesh.ccw;
  out.texGen = mesh.texGen;
  for (const uint32_t i : used) {
    out.ownPoints.push_back(mesh.points[i]);
    if (!mesh.normals.empty()) out.ownNormals.push_back(mesh.normals[i]);
    if (!mesh.texCoords.empty()) out.ownTexCoords.push_back(mesh.texCoords[i]);
    if (!mesh.texPlaces.empty()) out.ownTexPlaces.push_back(mesh.texPlaces[i]);
    if (!mesh.colors.empty()) out.ownColors.push_back(mesh.colors[i]);
    if (!mesh.alphas.empty()) out.ownAlphas.push_back(mesh.alphas[i]);
    if (!mesh.fogCoords.empty()) out.ownFogCoords.push_back(mesh.fogCoords[i]);
  }
  out.ownIndices.reserve(mesh.indices.size());
  for (const uint32_t i : mesh.indices)
    out.ownIndices.push_back(
        uint32_t(std::lower_bound(used.begin(), used.end(), i) - used.begin()));
  out.viewOwn();
}

} // namespace xvrml::mapper
