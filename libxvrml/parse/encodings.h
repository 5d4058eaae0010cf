// encodings.h: the table of the encodings in which worlds are read, and the functions that it
// names. [the thread that loads]
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/budget.h"
#include "graph/load_state.h"
#include "parse/mesh/mesh_file.h"
#include "xvrml/file_head.h"

namespace xvrml {

// A file that is being read as a world, and where its content goes.
struct WorldFile {
  std::string_view bytes;
  const std::shared_ptr<const std::string>& name;
  LoadState& state;
  ParsedFile& content;
  const BudgetPtr& budget;
};

// Readers of worlds. Faults of the file are reported; what could be read is kept.
void readVrml(const WorldFile& file);
void readVrml1(const WorldFile& file);
void readX3dXml(const WorldFile& file);
void readX3dJson(const WorldFile& file);
// Readers of meshes.
void readStl(const MeshFile& file);
void readPly(const MeshFile& file);
void readObj(const MeshFile& file);
void readGltf(const MeshFile& file);
void readOff(const MeshFile& file);
void readStep(const MeshFile& file);

// Recognise a file by its content: by signatures and grammars. The suffix of the path counts only
// where the content says too little.
bool isX3dXml(std::string_view text, std::string_view path);
bool isX3dJson(std::string_view text, std::string_view path);
bool isBinaryStl(std::string_view bytes, std::string_view path = {});
bool isAsciiStl(std::string_view bytes, std::string_view path = {});
bool isPly(std::string_view bytes, std::string_view path = {});
bool isObj(std::string_view bytes, std::string_view path = {});
bool isGltf(std::string_view bytes, std::string_view path = {}); // also binary (.glb)
bool isOff(std::string_view bytes, std::string_view path = {});
bool isStep(std::string_view bytes, std::string_view path = {});

struct EncodingInfo {
  Encoding encoding;
  std::string_view name; // as users call it
  int major, minor;      // version of the standard that its nodes follow
  // Null: the header says it (Source::version).
  bool (*recognises)(std::string_view text, std::string_view path) = nullptr;
  void (*read)(const WorldFile& file) = nullptr;
  // Not null: the encoding is one of meshes, which are read by this function instead.
  void (*readMesh)(const MeshFile& file) = nullptr;
  std::string_view meshSuffixes = {}; // separated by blanks; decide where the content does not
  bool mayBeBinary = false;

  FileVersion version() const { return {encoding, major, minor}; }
};

// The first row that recognises a file is its encoding. Nodes made from a mesh follow X3D 4.0,
// which has physical materials.
inline constexpr EncodingInfo encodingTable[] = {
    {Encoding::gltf, "glTF", 4, 0, isGltf, nullptr, readGltf, ".gltf .glb", true},
    {Encoding::ply, "PLY", 4, 0, isPly, nullptr, readPly, ".ply", true},
    {Encoding::stl, "STL", 4, 0, isBinaryStl, nullptr, readStl, ".stl", true},
    {Encoding::stl, "STL", 4, 0, isAsciiStl, nullptr, readStl, ".stl", true},
    {Encoding::off, "OFF", 4, 0, isOff, nullptr, readOff, ".off"},
    {Encoding::step, "STEP", 4, 0, isStep, nullptr, readStep, ".step .stp .stpz"},
    {Encoding::obj, "Wavefront OBJ", 4, 0, isObj, nullptr, readObj, ".obj"},
    {Encoding::x3dXml, "X3D XML", 3, 3, isX3dXml, readX3dXml},
    {Encoding::x3dJson, "X3D JSON", 3, 3, isX3dJson, readX3dJson},
    {Encoding::vrml97, "VRML97", 2, 0, nullptr, readVrml},
    {Encoding::x3dClassic, "X3D ClassicVRML", 3, 3, nullptr, readVrml},
    {Encoding::vrml1, "VRML 1.0", 1, 0, nullptr, readVrml1},
};

// Returns the row of an encoding; null if there is none.
const EncodingInfo* encodingInfo(Encoding encoding);
// Returns the row that recognises a file; null if its header must say.
const EncodingInfo* recogniseEncoding(std::string_view text, std::string_view path);
// Returns the row of a mesh by the suffix of its name (also before .gz); null if it is no mesh's.
const EncodingInfo* meshNamedBy(std::string_view path);
// Reads a file in the encoding of its head.
void readWorldFile(const WorldFile& file);

} // namespace xvrml
