// gltf.cpp: glTF 2.0 (Khronos, ISO/IEC 12113) as one binary file, or as a text with its buffer and
// pictures beside it.
#include <bit>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

#include "base64.h"
#include "libpicture/export/beside.h"
#include "libpicture/export/export.h"
#include "libpicture/export/gltf/scene.h"
#include "libpicture/export/pictures.h"
#include "libpicture/export/walk_options.h"

namespace picture {

namespace {

static_assert(std::endian::native == std::endian::little); // as all numbers of glTF

using gltf::Document;

// A document with the pictures that its materials show.
struct Made {
  explicit Made(const xvrml::World& world, const ExportSettings& settings)
      : pictures(world, remarks), surfaces(pictures, settings.shaderPath, remarks),
        materials(document, pictures, surfaces) {
    gltf::Meshes meshes(document, materials, remarks);
    gltf::Motions motions(world, remarks);
    gltf::Scene scene(document, meshes, motions, remarks);
    xvrml::render(world, scene, walkOptions());
    scene.finish();
    meshes.finish();
    motions.write(document);
    if (world.head.version.encoding == xvrml::Encoding::step) document.turnZUp();
  }
  Document document;
  Remarks remarks;
  Pictures pictures;
  Surfaces surfaces;
  gltf::Materials materials;
};

std::string wordsOf(std::initializer_list<uint32_t> words) {
  std::string bytes;
  for (const uint32_t word : words) bytes.append(reinterpret_cast<const char*>(&word), 4);
  return bytes;
}

std::string dataUrl(const char* type, std::string_view bytes) {
  std::string url = fmt::format("data:{};base64,", type);
  appendBase64(bytes, url);
  return url;
}

// A text without files beside it has its buffer, which holds the pictures, as a data: URL.
std::string standaloneText(Document& document) {
  const std::vector<std::string> pieces = document.takeBuffer();
  std::string bytes;
  bytes.reserve(document.bufferBytes());
  for (const std::string& piece : pieces) bytes += piece;
  return document.text(dataUrl("application/octet-stream", bytes));
}

} // namespace

Exported exportGlb(const xvrml::World& world, const ExportSettings& settings) {
  Made made(world, settings);
  made.materials.writeImages([](size_t) { return std::string(); });
  std::string text = made.document.text("");
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const uint64_t buffer = made.document.bufferBytes();
  const uint64_t total = 12 + 8 + text.size() + (buffer > 0 ? 8 + buffer : 0);
  if (total > UINT32_MAX)
    throw std::runtime_error(
        fmt::format("a .glb file has at most 4 GiB, this one would have {} bytes: write a .gltf "
                    "file",
                    total));
  constexpr uint32_t magic = 0x46546C67, version = 2, jsonChunk = 0x4E4F534A, binChunk = 0x004E4942;
  Exported exported;
  Exported::File& file = exported.files.emplace_back();
  file.path = settings.path;
  file.pieces.push_back(
      wordsOf({magic, version, uint32_t(total), uint32_t(text.size()), jsonChunk}));
  file.pieces.push_back(std::move(text));
  if (buffer > 0) {
    file.pieces.push_back(wordsOf({uint32_t(buffer), binChunk}));
    for (std::string& piece : made.document.takeBuffer()) file.pieces.push_back(std::move(piece));
  }
  exported.remarks = made.remarks.sentences("glTF");
  return exported;
}

Exported exportGltf(const xvrml::World& world, const ExportSettings& settings) {
  Made made(world, settings);
  Exported exported;
  exported.remarks = made.remarks.sentences("glTF");
  exported.files.push_back({settings.path, {}});
  if (!hasFilesBeside(settings.path)) {
    made.materials.writeImages([](size_t) { return std::string(); });
    exported.files[0].pieces.push_back(standaloneText(made.document));
    return exported;
  }
  NamesBeside names(settings.path, made.pictures.inputs());
  made.materials.writeImages([&](size_t i) {
    const PictureFile& picture = made.pictures.files()[i];
    const std::string name = names.choose(fmt::format("_{}", i), picture.isPng ? ".png" : ".jpg");
    exported.files.push_back({names.pathOf(name), {picture.bytes}});
    return name;
  });
  std::string buffer;
  if (made.document.bufferBytes() > 0) {
    buffer = names.choose("", ".bin");
    exported.files.push_back({names.pathOf(buffer), made.document.takeBuffer()});
  }
  exported.files[0].pieces.push_back(made.document.text(buffer));
  return exported;
}

} // namespace picture
