// frame.h: what a frame consists of, as the calls of OpenGL record it: primitives with their
// matrices and materials, and what holds for the whole frame. Scene makes objects and instances of
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gl/attributes.h"
#include "gl/matrix.h"

namespace rtgl {

inline constexpr size_t maxVertices = size_t(1) << 25; // between glBegin and glEnd
// Limits of rtFrameBuffer.
inline constexpr int maxViewportSide = 65536;
inline constexpr int64_t maxPixels = int64_t(1) << 28;

struct Vertex {
  std::array<float, 3> position, normal;
  std::array<float, 2> texCoord;
  Color color;
};

// The vertices between glBegin and glEnd. A chunk does not change after finish().
struct Chunk {
  GLenum mode = GL_POINTS;
  std::vector<Vertex> vertices;
  // In a display list, the first vertices take these from what is current when the list is called.
  size_t inheritsColor = 0, inheritsNormal = 0, inheritsTexCoord = 0;
  bool setsColor = false, setsNormal = false, setsTexCoord = false;
  Current after; // what is current after the chunk, where it is set
  // One colour of all vertices is kept here, so that the vertices are the same in each colour. It
  // is inherited if inheritsColor is the number of vertices.
  Color color = {1, 1, 1, 1};
  bool colorsVary = false;
  size_t hash = 0;

  bool inherits() const {
    return (colorsVary && inheritsColor > 0) || inheritsNormal + inheritsTexCoord > 0;
  }
  void finish(); // computes color, colorsVary and hash
  // Returns the chunk with what it inherits from `current`.
  std::shared_ptr<const Chunk> resolved(const Current& current) const;
  bool operator==(const Chunk& other) const;

 private:
  mutable std::shared_ptr<const Chunk> resolved_; // the last answer of resolved()
  mutable Current resolvedFor_;
};
using ChunkPtr = std::shared_ptr<const Chunk>;

// A chunk with the state that decides which primitives are made of it.
struct Part {
  ChunkPtr chunk;
  bool flat = false, colored = false, lit = false, textured = false, cull = false;
  GLenum cullFace = GL_BACK, frontFace = GL_CCW;
  std::array<GLenum, 2> polygonMode = {GL_FILL, GL_FILL};
  float lineWidth = 1, pointSize = 1;

  size_t hash() const;
  bool operator==(const Part& other) const;
};

// The values that one shader is made of. Every member has four bytes, so that materials are
// compared as bytes.
struct Material {
  struct Side {
    float diffuse[3], ambient[3], emission[3], specular[3], shininess, alpha;
  };
  Side sides[2]; // front, back
  int32_t lit, colored, tracksAmbient, twoSide, vertexAlpha, blend, alphaTest, replace;
  uint32_t texture;
  float alphaReference;
  float textureTransform[6];
  bool operator==(const Material& other) const;
  size_t hash() const;
};

// Primitives under one matrix with one material.
struct Draw {
  std::vector<Part> parts;
  Matrix matrix;
  Material material;
};

// The lights that are on, the ambient light of all of them, and their specular colours in
// proportion to their diffuse ones.
struct LightSet {
  std::array<Light, lightCount> lights;
  std::array<float, 3> ambient = {0, 0, 0}, specularShare = {0, 0, 0};
  bool operator==(const LightSet&) const = default;
};

class Overlay;

struct Frame {
  std::vector<Draw> draws;
  std::shared_ptr<Overlay> overlay; // null: nothing lies over the picture
  std::optional<LightSet> lights;   // those of the first lit draw
  std::optional<Matrix> projection; // that of the first draw
  Fog fog;                          // that of the first draw
  Color clear = {0, 0, 0, 0};
  int left = 0, bottom = 0, width = 0, height = 0; // the viewport of the first draw
};

// Returns the hash of bytes.
size_t hashOf(const void* bytes, size_t count);

} // namespace rtgl
