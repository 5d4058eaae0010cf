// other_formats.cpp: recognises file formats by the signatures in their specifications.
#include "parse/other_formats.h"
#include "lower_case.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace xvrml {
namespace {

// Number of bytes of a text in which a format's keyword is searched.
constexpr size_t searched = 4096;

bool holds(std::string_view bytes, std::string_view word) {
  return bytes.substr(0, searched).find(word) != bytes.npos;
}

std::string_view withoutBlanks(std::string_view bytes) {
  const size_t first = bytes.find_first_not_of(" \t\r\n");
  return first == bytes.npos ? std::string_view() : bytes.substr(first);
}

// The main chunk of a 3D Studio file contains its own length, and begins with the version or the
// editor's chunk. Either may be wrong: files are cut off, or padded.
bool is3ds(std::string_view bytes) {
  uint32_t length = 0;
  if (bytes.size() < 8 || !bytes.starts_with("MM")) return false;
  std::memcpy(&length, bytes.data() + 2, sizeof length);
  const std::string_view first = bytes.substr(6, 2);
  return length == bytes.size() || first == std::string_view("\x02\x00", 2) || first == "\x3d\x3d";
}

// A USD package is a ZIP archive whose first file is a USD scene.
bool isUsdz(std::string_view bytes) {
  return bytes.starts_with("PK\x03\x04") && holds(bytes.substr(0, 512), ".usd");
}

constexpr std::string_view exportIt =
    "export it as VRML97 (.wrl), for example from MeshLab or Blender, or hand its mesh to Python's "
    "xvrml.interop.from_trimesh";

struct Signature {
  bool (*matches)(std::string_view bytes);
  OtherFormat format;
};

const Signature signatures[] = {
    {[](std::string_view b) { return b.starts_with("#Inventor"); },
     {"a binary Open Inventor file",
      "save it as text (#Inventor V2.1 ascii), or as VRML97 (.wrl)"}},
    {[](std::string_view b) { return withoutBlanks(b).starts_with('<') && holds(b, "<COLLADA"); },
     {"a COLLADA document", exportIt}},
    {is3ds, {"a 3D Studio mesh", exportIt}},
    {[](std::string_view b) { return b.starts_with("Kaydara FBX Binary"); },
     {"an FBX scene", exportIt}},
    {[](std::string_view b) { return b.starts_with("BLENDER"); },
     {"a Blender file", "export it as VRML97 (.wrl) from Blender"}},
    {[](std::string_view b) { return b.starts_with("#usda") || b.starts_with("PXR-USDC"); },
     {"a USD scene", exportIt}},
    {[](std::string_view b) { return b.starts_with("(kicad_pcb"); },
     {"a KiCad board", "export it from KiCad: File > Export > VRML, or kicad-cli pcb export vrml"}},
    {[](std::string_view b) {
       return b.starts_with("\x89PNG") || b.starts_with("\xff\xd8\xff") || b.starts_with("GIF8");
     },
     {"a picture", "name the world that shows it, or write one with an ImageTexture"}},
    {isUsdz, {"a USD package (.usdz)", exportIt}},
    {[](std::string_view b) { return b.starts_with("PK\x03\x04"); },
     {"a ZIP archive", "unpack it and name the .wrl file in it"}},
    {[](std::string_view b) { return b.starts_with("%PDF"); },
     {"a PDF document", "name a .wrl file"}},
    {[](std::string_view b) {
       const std::string_view text = withoutBlanks(b);
       return beginsWithoutCase(text, "<!doctype html") || beginsWithoutCase(text, "<html");
     },
     {"a web page", "download the .wrl file itself: the server answered with a page instead"}},
};

} // namespace

const OtherFormat* otherFormat(std::string_view bytes) {
  for (const Signature& signature : signatures)
    if (signature.matches(bytes)) return &signature.format;
  return nullptr;
}

} // namespace xvrml
