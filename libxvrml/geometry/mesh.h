// mesh.h: the tessellated form of a geometry node: flat arrays for the OpenRT mapper. Built by pure
// functions, one file per node, on the caller's thread. Degenerate and out-of-range parts are
// dropped with one warning per node.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "xvrml/diagnostics.h"
#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

struct Color4 {
  float r = 1, g = 1, b = 1, a = 1;
};

// A surface that the ray tracer draws by its equation: rtQuadric or rtAsphere (openrt/geometry.h),
// whose arguments it holds. None of them is out of range.
struct ExactSurface {
  enum class Kind : uint8_t { quadric, asphere } kind = Kind::quadric;
  // Quadric: ten coefficients, lower and upper corner of the box. Asphere: curvature, conic
  // constant, inner radius, semi-aperture, terms.
  std::vector<double> numbers;
  // An asphere's height and direction of its axis: along z, or for the ends of round bodies up or
  // down the y axis.
  enum class Facing : uint8_t { z, up, down } facing = Facing::z;
  double height = 0;
};

// Texture coordinates that a renderer makes in the camera's frame, in the order of RT_TEX_GEN_*
// (openrt/geometry.h).
enum class TexGen : uint8_t { off, position, normal, reflection, sphereNormal, sphereReflection };

// How the textures of a shape are placed: it has none, pictures, or volumes, which have three
// coordinates (ISO/IEC 19775-1 clause 33). physicalVolume: a volume on a PhysicalMaterial or
// UnlitMaterial.
enum class TextureNeed : uint8_t { none, picture, volume, physicalVolume };

struct Mesh {
  enum class Kind : uint8_t { empty, triangles, lines, points, sphere };
  Kind kind = Kind::empty;
  // Views of the node's own arrays where these can be used unchanged, else of the vectors below.
  // One entry per vertex; all but points are empty or as long as points.
  std::span<const Vec3f> points;
  std::span<const uint32_t> indices; // 3 per triangle, 2 per line segment, 1 per point
  std::span<const Vec3f> normals;    // empty: flat, with the face normal
  std::span<const Vec2f> texCoords;
  // Homogeneous texture coordinates in space, of which texCoords are the first two.
  std::span<const Vec4f> texPlaces;
  std::span<const Color> colors;
  std::span<const float> alphas;    // opacity, 0 to 1, of the colours of a ColorRGBA
  std::span<const float> fogCoords; // finite shares of the fog
  // Takes the place of texCoords, which are those of the same mode in the frame of the geometry.
  TexGen texGen = TexGen::off;
  bool solid = true; // back faces are culled
  bool ccw = true;
  float radius = 0;   // radius of a sphere
  bool plain = false; // points are the node's, and triangles its faces in their order
  // If not empty, what the ray tracer draws in place of the triangles.
  std::vector<ExactSurface> exact;

  std::vector<Vec3f> ownPoints, ownNormals;
  std::vector<uint32_t> ownIndices;
  std::vector<Vec2f> ownTexCoords;
  std::vector<Vec4f> ownTexPlaces;
  std::vector<Color> ownColors;
  std::vector<float> ownAlphas, ownFogCoords;
  void viewOwn(); // makes all views refer to the owned vectors
  void takeAll(); // copies what the views show of the node's arrays, so that the node may go

  Mesh() = default;
  Mesh(Mesh&&) = default; // moved vectors keep their storage, so views stay valid
  Mesh& operator=(Mesh&&) = default;
  Mesh(const Mesh&) = delete;
};

// The triangles of a plain mesh.
struct MeshTopology {
  std::vector<uint32_t> indices;
  size_t points = 0; // number of points
};

struct MeshOptions {
  // The shape has a texture: make default texture coordinates if the node has none.
  bool needTexCoords = false;
  const Limits* limits = nullptr;
  Diagnostics* diagnostics = nullptr;
  // The name of limits->triangles in messages; empty: the limit 'triangles'.
  std::string_view limitName = {};
  // Cylinders and cones get exact surfaces beside their triangles.
  bool exactShapes = false;
  // If not null, those of the mesh that was built of this node before; only the node's points or
  // normals have changed since. A mesh that is still built of them takes them.
  MeshTopology* former = nullptr;
  // Diameters in the units of the node: points become balls, and lines rods (thick.h). 0: they are
  // thin.
  float pointSize = 0, lineWidth = 0;
  // The shape has a volume: make texPlaces if the node has none.
  bool needTexPlaces = false;
};

// Builds the mesh of any geometry node (Box ... Text). Its kind is empty for other nodes and if
// there is nothing to draw. The node must outlive the mesh. The coord, color, normal and texCoord
// children may be prototype instances (renderedNode).
Mesh buildMesh(Node& geometry, const MeshOptions& options);

// Returns whether the node's colours are those of a ColorRGBA, so that they have opacities.
bool hasVertexAlpha(Node& geometry);

} // namespace xvrml
