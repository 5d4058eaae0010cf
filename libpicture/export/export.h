// export.h: Writes worlds in the formats of other programs: glTF, STL, PLY and OBJ. A file holds
// the world as it is now, with prototypes expanded and Inlines loaded. The formats are a table.
// [the thread that owns the world]
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/world.h"

namespace picture {

struct ExportSettings {
  // The file that is written. Files beside it are named after it. "-" for standard output, or a
  // pipe, has no other files: a glTF text then holds its buffer and its pictures.
  std::string path;
  std::string shaderPath; // folders of shader plug-ins that are searched first
};

// The files of an export, in memory.
struct Exported {
  struct File {
    std::string path;
    std::vector<std::string> pieces; // the content, one piece after the other
  };
  std::vector<File> files; // the first one is that of the settings
  // Says what the format cannot hold, a sentence for each kind of thing, with counts.
  std::vector<std::string> remarks;
};

struct ExportFormat {
  std::string_view name;   // in messages
  std::string_view suffix; // lower case
  // Throws std::runtime_error if the world is too large for the format or for a walk.
  Exported (*make)(const xvrml::World& world, const ExportSettings& settings);
};
std::span<const ExportFormat> exportFormats();
// Return the format for a suffix in any case, and for that of a file name; null: there is none.
const ExportFormat* exportFormatNamed(std::string_view suffix);
const ExportFormat* exportFormatOf(std::string_view path);

// Writes all files atomically, the first one last. Throws std::runtime_error.
void writeExported(const Exported& exported);

// The formats of the table.
Exported exportGlb(const xvrml::World& world, const ExportSettings& settings);
Exported exportGltf(const xvrml::World& world, const ExportSettings& settings);
Exported exportStl(const xvrml::World& world, const ExportSettings& settings);
Exported exportPly(const xvrml::World& world, const ExportSettings& settings);
Exported exportObj(const xvrml::World& world, const ExportSettings& settings);

} // namespace picture
