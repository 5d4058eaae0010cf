// gltf.cpp: recognises glTF files, takes binary ones (.glb) apart, and reads version 2.0 (Khronos,
// glTF 2.0 specification; ISO/IEC 12113). Version 1.0 is converted first.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "parse/encodings.h"
#include "parse/mesh/gltf/scene.h"
#include "parse/mesh/gltf/version1.h"
#include "parse/source.h"

namespace xvrml {

using namespace gltf;

namespace {

constexpr uint32_t jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942;

uint32_t wordAt(std::string_view bytes, size_t at) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

struct Chunks {
  std::string_view json, binary;
};

// Header: "glTF", version, length; then chunks: length, type, bytes (glTF 2.0, 4.4). Bytes behind
// the length are no chunks.
Chunks chunksOf(std::string_view bytes, Locator& locator) {
  if (!bytes.starts_with("glTF")) return {withoutDosEnd(bytes), {}};
  if (bytes.size() < 12 || wordAt(bytes, 4) != 2)
    throw MeshFault{nullptr, fmt::format("this binary glTF file has version {}: expected 2",
                                         bytes.size() < 12 ? 0 : wordAt(bytes, 4))};
  Chunks chunks;
  const size_t announced = wordAt(bytes, 8);
  const size_t end = announced < 12 ? bytes.size() : std::min(announced, bytes.size());
  size_t at = 12;
  while (at < end && bytes.size() - at >= 8) {
    const uint32_t length = wordAt(bytes, at), type = wordAt(bytes, at + 4);
    at += 8;
    if (length > bytes.size() - at)
      throw MeshFault{nullptr, fmt::format("the binary glTF file ends early: a chunk of {} bytes "
                                           "does not fit into it",
                                           length)};
    std::string_view& chunk = type == jsonChunk ? chunks.json : chunks.binary;
    if ((type == jsonChunk || type == binaryChunk) && chunk.empty())
      chunk = bytes.substr(at, length);
    at += length;
  }
  if (at < bytes.size() && end < bytes.size())
    locator.warn(nullptr,
                 fmt::format("{} bytes behind the binary glTF file are left out: its header "
                             "announces {} bytes",
                             bytes.size() - at, announced));
  if (chunks.json.empty()) throw MeshFault{nullptr, "the binary glTF file has no JSON chunk"};
  return chunks;
}

// Files of version 1 are converted. Many of them have no version.
void checkVersion(const MeshFile& file, Json& document) {
  const Item root(file.locator, &document, {});
  const std::string version = root.object("asset").text("version");
  if (version.starts_with("2.")) return;
  if (!version.empty() && !version.starts_with("1."))
    throw MeshFault{
        nullptr, fmt::format("this is glTF {}: versions 1 and 2 can be read", shortened(version))};
  const bool named = root.has("meshes") && document["meshes"].is_object();
  if (version.empty() && !named)
    throw MeshFault{nullptr, "this glTF file does not say its version in asset: expected 2.0"};
  if (!document["asset"].is_object()) document["asset"] = Json::object();
  if (convertVersion1(document)) root.warn("animations and skins of glTF 1.0 are left out");
}

// Reports extensions that a file requires and that are not supported.
void checkExtensions(const Item& root) {
  constexpr std::string_view known[] = {"KHR_lights_punctual",
                                        "KHR_texture_transform",
                                        "KHR_materials_unlit",
                                        "KHR_mesh_quantization",
                                        "KHR_materials_emissive_strength",
                                        "KHR_materials_ior",
                                        "KHR_materials_clearcoat",
                                        "KHR_materials_transmission",
                                        "KHR_materials_specular",
                                        "KHR_materials_sheen",
                                        "KHR_materials_volume",
                                        "KHR_materials_iridescence",
                                        "KHR_materials_variants",
                                        "KHR_materials_pbrSpecularGlossiness"};
  for (const std::string& name : root.texts("extensionsRequired"))
    if (std::find(std::begin(known), std::end(known), name) == std::end(known))
      root.error(fmt::format("the file requires {}, which is not supported; what needs it is left "
                             "out",
                             describe(Name{name})));
}

void writeHead(const MeshFile& file, const Item& root) {
  const Item asset = root.object("asset");
  for (const char* key : {"generator", "copyright"})
    if (const std::string text = asset.text(key); !text.empty())
      file.sink.meta({"META"}, key, text);
}

} // namespace

bool isGltf(std::string_view bytes, std::string_view) {
  if (bytes.starts_with("glTF")) return true;
  // Some programs write the list of accessors before "asset".
  const std::string_view head = bytes.substr(0, 1 << 20);
  const size_t first = head.find_first_not_of(" \t\r\n");
  if (first == head.npos || head[first] != '{') return false;
  const std::string_view begin = head.substr(first, 4096);
  if (begin.find("\"X3D\"") != begin.npos) return false;
  return head.find("\"asset\"") != head.npos || begin.find("\"bufferView\"") != begin.npos;
}

void readGltf(const MeshFile& file) {
  const Chunks chunks = chunksOf(file.bytes, file.locator);
  Scratch memory(file.budget);
  Json document = parseJson(chunks.json, file.options.limits, memory);
  if (!document.is_object())
    throw MeshFault{file.bytes.data(), "expected an object as the whole of a glTF file"};
  checkVersion(file, document);
  const Item root(file.locator, &document, {});
  checkExtensions(root);
  writeHead(file, root);
  NodeStream nodes(file);
  Accessors accessors(file, root, chunks.binary);
  Scene scene(file, nodes, root, accessors);
  scene.write();
  writeAnimations(file, nodes, root, accessors, scene);
}

} // namespace xvrml
