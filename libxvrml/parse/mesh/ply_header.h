// ply_header.h: the header of a PLY file: which elements follow, and what their numbers mean.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "parse/mesh/mesh_file.h"

namespace xvrml {

enum class PlyOrder : uint8_t { text, little, big };
enum class PlyType : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
uint64_t plyTypeBytes(PlyType type);

// The meaning of a property. `other` is read over.
enum class PlyUse : uint8_t {
  other,
  x,
  y,
  z,
  nx,
  ny,
  nz,
  red,
  green,
  blue,
  s,
  t,
  vertex1,
  vertex2,
  indices,   // list: the corners of a face
  texCoords, // list: two numbers for each corner
  count
};

struct PlyProperty {
  PlyUse use = PlyUse::other;
  bool isList = false;
  PlyType countType = PlyType::uint8; // type of a list's length
  PlyType type = PlyType::float32;
  double scale = 1; // integers that stand for 0 to 1
};

struct PlyElement {
  std::string_view name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyOrder order = PlyOrder::text;
  std::vector<PlyElement> elements;
  std::string texture; // "comment TextureFile NAME"; empty: none
  bool faceColors = false, cornerTexCoords = false;
  size_t bytes = 0;      // length of the header
  uint64_t vertices = 0; // announced
};

// Reads the header. Throws MeshFault if the file cannot be read.
PlyHeader readPlyHeader(const MeshFile& file);

} // namespace xvrml
