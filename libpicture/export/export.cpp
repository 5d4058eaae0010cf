#include "libpicture/export/export.h"

#include "libpicture/files/atomic_file.h"
#include "lower_case.h"

namespace picture {

namespace {

constexpr ExportFormat table[] = {
    {"glTF", "glb", exportGlb}, {"glTF", "gltf", exportGltf}, {"STL", "stl", exportStl},
    {"PLY", "ply", exportPly},  {"OBJ", "obj", exportObj},
};

} // namespace

std::span<const ExportFormat> exportFormats() { return table; }

const ExportFormat* exportFormatNamed(std::string_view suffix) {
  const std::string lower = lowerCase(suffix);
  for (const ExportFormat& format : table)
    if (lower == format.suffix) return &format;
  return nullptr;
}

const ExportFormat* exportFormatOf(std::string_view path) {
  const size_t dot = path.rfind('.');
  if (dot == path.npos || path.find('/', dot) != path.npos) return nullptr;
  return exportFormatNamed(path.substr(dot + 1));
}

void writeExported(const Exported& exported) {
  for (size_t i = exported.files.size(); i-- > 0;)
    writeFile(exported.files[i].path, exported.files[i].pieces);
}

} // namespace picture
