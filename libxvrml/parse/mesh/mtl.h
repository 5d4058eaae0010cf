// mtl.h: the materials of OBJ files, and how they are written as nodes.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "parse/mesh/node_stream.h"

namespace xvrml {

// A picture with the options of its statement.
struct ObjTexture {
  std::string file; // empty: none
  Vec2f scale{1, 1}, offset;
  bool clamp = false;
};

// Holds what a newmtl block says. Defaults are Material's where the format has none.
struct ObjMaterial {
  Color diffuse{0.8f, 0.8f, 0.8f}, specular, emissive;
  bool hasDiffuse = false;
  float exponent = 25.6f;   // Ns
  float opacity = 1;        // d, or 1 - Tr
  bool hasDissolve = false; // d is given
  int illumination = 2;     // illum; below 2: no highlights
  // The physical extension (Pr, Pm, norm)
  bool physical = false;
  float roughness = 1, metallic = 0;
  ObjTexture diffuseMap, emissiveMap, normalMap;
  std::string library; // path of the MTL file
  std::string def;     // name of its Appearance once that is written
};

using ObjMaterials = std::unordered_map<std::string, ObjMaterial>;

// Reads the materials of a library that an OBJ file names. Anything that cannot be read is reported
// at `at`, the place of the name.
void readMtl(const MeshFile& file, std::string_view name, const char* at, ObjMaterials& materials);

// Writes the open field `appearance`. name: of the material; empty: none was chosen.
// lit: false for lines and points, which no lamp lights.
void writeObjAppearance(NodeStream& nodes, const MeshFile& file, ObjMaterials& materials,
                        const std::string& name, bool lit);

} // namespace xvrml
