// texture_generator.cpp: modes by the vertex and its normal in the frame of the geometry. A mesh
// has one set of coordinates for all viewers, so modes of the camera's frame have those of the
// geometry's frame, too; the mesh tells the renderer which they stand for (Mesh::texGen).
#include "geometry/texture_generator.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/vector_math.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

enum class Kind { position, normal, sphere, reflection, noise };
struct Mode {
  const char* name;
  Kind kind;
  bool camera = false;         // the standard means the camera's frame
  TexGen texGen = TexGen::off; // what a renderer makes there
};
constexpr Mode modes[] = {
    {"COORD", Kind::position},
    {"COORD-EYE", Kind::position, true, TexGen::position},
    {"CAMERASPACEPOSITION", Kind::position, true, TexGen::position},
    {"CAMERASPACENORMAL", Kind::normal, true, TexGen::normal},
    {"CAMERASPACEREFLECTIONVECTOR", Kind::normal, true, TexGen::reflection},
    {"SPHERE", Kind::sphere, true, TexGen::sphereNormal},
    {"SPHERE-LOCAL", Kind::sphere},
    {"SPHERE-REFLECT", Kind::sphere, true, TexGen::sphereReflection},
    {"SPHERE-REFLECT-LOCAL", Kind::reflection},
    {"NOISE", Kind::noise},
    {"NOISE-EYE", Kind::noise, true},
};

void warn(const MeshOptions& options, const Node& node, const std::string& text) {
  if (options.diagnostics)
    options.diagnostics->warn(node.source, "TextureCoordinateGenerator: " + text);
}

// Returns a number of -1..1 for a point of the integer lattice.
double latticeValue(int64_t x, int64_t y, int64_t z) {
  uint64_t h = uint64_t(x) * 0x9e3779b97f4a7c15u ^ uint64_t(y) * 0xc2b2ae3d27d4eb4fu ^
               uint64_t(z) * 0x165667b19e3779f9u;
  h = (h ^ h >> 29) * 0xbf58476d1ce4e5b9u;
  h ^= h >> 32;
  return double(h & 0xffffffffu) / 2147483647.5 - 1;
}

// Returns noise between lattice points, by the smooth steps of K. Perlin, "Improving Noise",
// SIGGRAPH 2002.
double noise(double x, double y, double z) {
  constexpr double most = 1e15;
  const double at[3] = {x, y, z};
  int64_t whole[3];
  double share[3];
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(at[i]) < most)) return 0;
    const double low = std::floor(at[i]), f = at[i] - low;
    whole[i] = int64_t(low);
    share[i] = f * f * f * (f * (6 * f - 15) + 10);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    for (int i = 0; i < 3; ++i) weight *= corner >> i & 1 ? share[i] : 1 - share[i];
    sum += weight * latticeValue(whole[0] + (corner & 1), whole[1] + (corner >> 1 & 1),
                                 whole[2] + (corner >> 2 & 1));
  }
  return sum;
}

struct Point {
  double x, y, z;
};

Point unit(Point p) {
  const double length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  return {p.x / length, p.y / length, p.z / length};
}

Vec4f placeOf(const Point& p) {
  const auto number = [](double v) {
    return std::isfinite(v) ? float(std::clamp(v, -1e30, 1e30)) : 0.0f;
  };
  return {number(p.x), number(p.y), number(p.z), 1};
}

// Returns what maps the sphere of unit vectors to texture coordinates of 0 to 1.
Point halved(const Point& p) { return {p.x / 2 + .5, p.y / 2 + .5, p.z / 2 + .5}; }

class Generator {
 public:
  Generator(Kind kind, const MFFloat& parameter) : kind_(kind) {
    for (size_t i = 0; i < std::min<size_t>(parameter.size(), 6); ++i)
      if (std::isfinite(parameter[i])) numbers_[i] = double(parameter[i]);
    if (kind == Kind::noise && parameter.size() < 3) numbers_[0] = numbers_[1] = numbers_[2] = 1;
  }
  Vec4f at(const Vec3f& point, const Vec3f& normal) const {
    const Point p{point.x, point.y, point.z}, n{normal.x, normal.y, normal.z};
    switch (kind_) {
    case Kind::position: return placeOf(p);
    case Kind::normal: return placeOf(n);
    case Kind::sphere: return placeOf(halved(n));
    case Kind::reflection: {
      const Point d = unit({p.x - numbers_[1], p.y - numbers_[2], p.z - numbers_[3]});
      const double twice = 2 * (d.x * n.x + d.y * n.y + d.z * n.z);
      return placeOf(halved({d.x - twice * n.x, d.y - twice * n.y, d.z - twice * n.z}));
    }
    case Kind::noise: break;
    }
    const Point q{p.x * numbers_[0] + numbers_[3], p.y * numbers_[1] + numbers_[4],
                  p.z * numbers_[2] + numbers_[5]};
    return placeOf({noise(q.x, q.y, q.z), noise(q.x + 19.1, q.y + 47.3, q.z + 7.7),
                    noise(q.x + 31.7, q.y + 5.9, q.z + 71.3)});
  }

 private:
  Kind kind_;
  double numbers_[6] = {};
};

// Gives every corner of a mesh without normals a vertex with the normal of its face.
void separateFaces(Mesh& mesh) {
  std::vector<Vec3f> points, normals;
  std::vector<Color> colors;
  std::vector<float> alphas, fogCoords;
  points.reserve(mesh.indices.size());
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const Vec3f a = mesh.points[mesh.indices[t]], b = mesh.points[mesh.indices[t + 1]],
                c = mesh.points[mesh.indices[t + 2]];
    const double u[3] = {double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z},
                 v[3] = {double(c.x) - a.x, double(c.y) - a.y, double(c.z) - a.z};
    const double side = mesh.ccw ? 1 : -1;
    const Point n = unit({side * (u[1] * v[2] - u[2] * v[1]), side * (u[2] * v[0] - u[0] * v[2]),
                          side * (u[0] * v[1] - u[1] * v[0])});
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh.indices[t + k];
      points.push_back(mesh.points[vertex]);
      normals.push_back({float(n.x), float(n.y), float(n.z)});
      if (!mesh.colors.empty()) colors.push_back(mesh.colors[vertex]);
      if (!mesh.alphas.empty()) alphas.push_back(mesh.alphas[vertex]);
      if (!mesh.fogCoords.empty()) fogCoords.push_back(mesh.fogCoords[vertex]);
    }
  }
  mesh.ownPoints = std::move(points);
  mesh.ownNormals = std::move(normals);
  mesh.ownColors = std::move(colors);
  mesh.ownAlphas = std::move(alphas);
  mesh.ownFogCoords = std::move(fogCoords);
  mesh.ownIndices.resize(mesh.ownPoints.size());
  for (size_t i = 0; i < mesh.ownIndices.size(); ++i) mesh.ownIndices[i] = uint32_t(i);
  mesh.ownTexCoords.clear();
  mesh.ownTexPlaces.clear();
  mesh.viewOwn();
}

// Warns if pictures were to have different coordinates.
void checkSets(const Node* texCoord, const MeshOptions& options) {
  const auto* multi = nodeCast<nodes::MultiTextureCoordinate>(const_cast<Node*>(texCoord));
  if (!multi || !options.diagnostics) return;
  for (const NodeRef& set : multi->texCoord)
    if (set.get() != multi->texCoord[0].get()) {
      options.diagnostics->warn(multi->source,
                                "MultiTextureCoordinate: a surface has one set of coordinates; all "
                                "pictures use the first of texCoord");
      return;
    }
}

} // namespace

const NodeRef* texCoordOf(const Node& geometry) {
  const FieldInfo* field = geometry.type().find("texCoord");
  if (!field || field->type != FieldType::SFNode) return nullptr;
  return static_cast<const NodeRef*>(geometry.storage(*field));
}

Node* firstTextureCoordinate(const NodeRef& texCoord) {
  Node* node = renderedNode(texCoord.get());
  const auto* multi = nodeCast<nodes::MultiTextureCoordinate>(node);
  if (!multi) return node;
  return multi->texCoord.empty() ? nullptr : renderedNode(multi->texCoord[0].get());
}

bool looksUpByNormal(Node& geometry) {
  Node* node = renderedNode(&geometry);
  const NodeRef* texCoord = node ? texCoordOf(*node) : nullptr;
  if (!texCoord || !*texCoord) return false;
  const auto* generator =
      nodeCast<nodes::TextureCoordinateGenerator>(firstTextureCoordinate(*texCoord));
  return generator &&
         (generator->mode == "CAMERASPACENORMAL" || generator->mode == "WORLDSPACENORMAL");
}

void generateTextureCoordinates(Node& geometry, const MeshOptions& options, Mesh& mesh) {
  if (!options.needTexCoords || mesh.kind != Mesh::Kind::triangles) return;
  const NodeRef* texCoord = texCoordOf(geometry);
  if (!texCoord || !*texCoord) return;
  checkSets(renderedNode(texCoord->get()), options);
  const auto* node = nodeCast<nodes::TextureCoordinateGenerator>(firstTextureCoordinate(*texCoord));
  if (!node) return;
  const Mode* mode = std::find_if(std::begin(modes), std::end(modes),
                                  [&](const Mode& m) { return node->mode == m.name; });
  if (mode == std::end(modes))
    return warn(options, *node,
                "mode is \"" + node->mode.substr(0, 40) +
                    "\", expected COORD, SPHERE or another name of ISO/IEC 19775-1 18.4.8: the "
                    "coordinates are those without texCoord");
  mesh.texGen = mode->texGen;
  if (mode->camera && (mode->texGen == TexGen::off || options.needTexPlaces))
    warn(options, *node,
         "mode " + node->mode +
             " is computed in the frame of the shape, not of the camera: the picture does not "
             "move with the viewer");
  const bool refracts = mode->kind == Kind::reflection || mode->texGen == TexGen::sphereReflection;
  if (refracts && !node->parameter.empty() && node->parameter[0] != 0)
    warn(options, *node, "the index of refraction in parameter is not used");
  const bool byNormal = mode->kind != Kind::position && mode->kind != Kind::noise;
  if (byNormal && mesh.normals.empty()) separateFaces(mesh);
  const Generator generator(mode->kind, node->parameter);
  mesh.ownTexCoords.resize(mesh.points.size());
  if (options.needTexPlaces) mesh.ownTexPlaces.resize(mesh.points.size());
  for (size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec4f place = generator.at(mesh.points[i], byNormal ? mesh.normals[i] : Vec3f{0, 0, 0});
    mesh.ownTexCoords[i] = {place.x, place.y};
    if (options.needTexPlaces) mesh.ownTexPlaces[i] = place;
  }
  mesh.texCoords = mesh.ownTexCoords;
  mesh.texPlaces = mesh.ownTexPlaces;
}

} // namespace xvrml
