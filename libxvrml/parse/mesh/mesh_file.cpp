// mesh_file.cpp: chooses the reader of a mesh, and reports what ends its reading.
#include "parse/mesh/mesh_file.h"

#include <fmt/format.h>

namespace xvrml {

void Scratch::take(uint64_t bytes) {
  if (share_.take(bytes)) return;
  throw MeshFault{nullptr,
                  fmt::format("reading this mesh takes more memory than {}; the rest of it "
                              "is left out",
                              share_.budget()->name())};
}

void FaultCount::report(Locator& locator, Severity severity, std::string_view message) const {
  if (count_ == 0) return;
  const std::string text = fmt::format("{} {}{}", count_, message,
                                       count_ > 1 && first_ ? "; the first one is here" : "");
  severity == Severity::error ? locator.error(first_, text) : locator.warn(first_, text);
}

bool findMeshEncoding(std::string_view bytes, Encoding& encoding) {
  struct Row {
    bool (*matches)(std::string_view bytes);
    Encoding encoding;
  };
  constexpr Row rows[] = {{isGltf, Encoding::gltf},     {isPly, Encoding::ply},
                          {isBinaryStl, Encoding::stl}, {isAsciiStl, Encoding::stl},
                          {isOff, Encoding::off},       {isObj, Encoding::obj}};
  for (const Row& row : rows) {
    if (!row.matches(bytes)) continue;
    encoding = row.encoding;
    return true;
  }
  return false;
}

bool findMeshSuffix(std::string_view path, Encoding& encoding) {
  constexpr std::pair<std::string_view, Encoding> rows[] = {
      {".stl", Encoding::stl},   {".ply", Encoding::ply},  {".obj", Encoding::obj},
      {".gltf", Encoding::gltf}, {".glb", Encoding::gltf}, {".off", Encoding::off}};
  std::string lower(path);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  if (lower.ends_with(".gz")) lower.resize(lower.size() - 3);
  for (const auto& [suffix, of] : rows) {
    if (!lower.ends_with(suffix)) continue;
    encoding = of;
    return true;
  }
  return false;
}

void readMesh(Encoding encoding, const MeshFile& file) {
  try {
    switch (encoding) {
    case Encoding::stl: return readStl(file);
    case Encoding::ply: return readPly(file);
    case Encoding::obj: return readObj(file);
    case Encoding::off: return readOff(file);
    default: return readGltf(file);
    }
  } catch (const MeshFault& fault) { file.locator.error(fault.at, fault.message); }
}

} // namespace xvrml
