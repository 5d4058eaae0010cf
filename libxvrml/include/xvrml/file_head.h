// file_head.h: what the head of a world's file says: how it is written, the version of the
// standard, and the statements of X3D (ISO/IEC 19775-1 7.2.5). Plain values.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace xvrml {

enum class Encoding : uint8_t {
  vrml97,
  x3dClassic,
  x3dXml,
  x3dJson,
  vrml1,
  stl,
  ply,
  obj,
  gltf,
  off,
  step
};
// How many encodings there are, in the library that is loaded. [any thread]
int encodingCount();
// Returns the name of an encoding as users call it. [any thread]
std::string_view encodingName(Encoding encoding);
// Returns whether a file is a mesh. Its nodes follow X3D 4.0. [any thread]
bool isMesh(Encoding encoding);
// Returns the suffixes of names of meshes, separated by blanks: ".gltf .glb". Empty for an encoding
// of worlds. [any thread]
std::string_view meshSuffixes(Encoding encoding);
// Returns why files of an encoding cannot be read here: STEP models need a program that may not be
// installed. Empty if they can be read. [any thread]
std::string whyNotReadable(Encoding encoding);

// The encoding and the version of the standard that a file follows. VRML 1.0 is version 1.0, VRML97
// is 2.0, X3D begins with 3.0.
struct FileVersion {
  Encoding encoding = Encoding::vrml97;
  int major = 2, minor = 0;
  bool isX3d() const { return major >= 3; }
  // Returns whether colour textures multiply diffuseColor. In VRML97 they replace it.
  bool texturesMultiply() const { return major != 2; }
  bool operator==(const FileVersion&) const = default;
};

struct FileHead {
  // COMPONENT name:level
  struct Component {
    std::string name;
    int32_t level = 1;
  };
  // META "name" "content"
  struct Meta {
    std::string name, content;
  };
  // UNIT category name factor: one unit is `factor` of the standard's own (4.3.6)
  struct Unit {
    std::string category, name;
    double factor = 1;
  };

  FileVersion version;
  std::string profile; // PROFILE; empty if the file has none
  std::vector<Component> components;
  std::vector<Meta> meta;
  std::vector<Unit> units;
};

} // namespace xvrml
