#include "mapper/shading/cube_maps.h"

#include <exception>
#include <optional>

#include "image/decoders.h"
#include "image/picture_urls.h"
#include "xvrml/radiance.h"

namespace xvrml::mapper {
namespace {

constexpr const char* pictures[cubeFaces] = {"cubeFront", "cubeBack", "cubeLeft",
                                             "cubeRight", "cubeTop",  "cubeBottom"};
enum Lookup { none, byReflection, byTheNormal }; // values of cubeLookup

} // namespace

bool isCubeMap(Node* texture) {
  Node* node = renderedNode(texture);
  return node && node->type().is("environmentTexture");
}

bool setCubeLayer(ShaderSetup& shader, Node* texture, CubeMaps& cubes, bool byNormal) {
  const bool cube = isCubeMap(texture);
  const bool mirror = nodeCast<nodes::GeneratedCubeMapTexture>(renderedNode(texture));
  const CubeMap map = cube && !mirror ? cubes.of(texture) : CubeMap();
  bool any = map.sphere != 0;
  for (size_t i = 0; i < cubeFaces; ++i) {
    any |= map.faces[i] != 0;
    if (map.faces[i] != 0 || !shader.fresh()) shader.texture(pictures[i], map.faces[i]);
  }
  if (map.sphere != 0 || !shader.fresh()) shader.texture("cubeMap", map.sphere);
  if (any || !shader.fresh())
    shader.integer("cubeLookup", !any ? none : byNormal ? byTheNormal : byReflection);
  if (mirror || !shader.fresh()) shader.integer("mirror", mirror ? 1 : 0);
  return cube;
}

CubeMap CubeMaps::of(Node* node) {
  Node* cube = renderedNode(node);
  if (!cube) return {};
  if (auto* six = nodeCast<nodes::ComposedCubeMapTexture>(cube)) return composed(*six);
  if (auto* file = nodeCast<nodes::ImageCubeMapTexture>(cube)) {
    const auto [it, fresh] = files_.try_emplace(cube, Entry{NodeRef(cube), {}, false});
    Entry& entry = it->second;
    if (fresh || entry.stale) {
      drop(entry.map);
      entry.stale = false;
      entry.map = read(*file);
    }
    return entry.map;
  }
  if (refused_.insert(cube).second)
    world_.diagnostics.warn(cube->source, cube->type().name +
                                              " has no pictures that shine; use "
                                              "ComposedCubeMapTexture or ImageCubeMapTexture");
  return {};
}

void CubeMaps::changed(const Node& node) {
  if (const auto found = files_.find(&node); found != files_.end()) found->second.stale = true;
}

void CubeMaps::clear() {
  for (auto& [node, entry] : files_) drop(entry.map);
  files_.clear();
}

void CubeMaps::drop(CubeMap& map) {
  for (const RTid face : map.faces) textures_.drop(face);
  textures_.drop(map.sphere);
  map = {};
}

CubeMap CubeMaps::composed(const nodes::ComposedCubeMapTexture& node) {
  const NodeRef* const faces[cubeFaces] = {&node.front, &node.back, &node.left,
                                           &node.right, &node.top,  &node.bottom};
  CubeMap map;
  for (size_t i = 0; i < cubeFaces; ++i) map.faces[i] = textures_.ofFace(faces[i]->get());
  return map;
}

CubeMap CubeMaps::read(const nodes::ImageCubeMapTexture& node) {
  std::optional<CubeMap> map;
  const std::string error =
      openFirst(node.url, node, world_, [&](const std::string& path, std::string& why) {
        try {
          map = decode(path);
        } catch (const std::exception& failure) { why = failure.what(); }
        return map.has_value();
      });
  if (map)
    report(world_.diagnostics, node.source, "ImageCubeMapTexture");
  else if (!node.url.empty())
    world_.diagnostics.warn(node.source, "ImageCubeMapTexture: no picture: " + error);
  return map.value_or(CubeMap());
}

CubeMap CubeMaps::decode(const std::string& path) {
  const ImageRoom room = textures_.roomForPicture();
  const std::vector<uint8_t> bytes = readPictureFile(path, room);
  CubeMap map;
  const auto add = [&](const auto& pictures) {
    if (pictures.size() == 1) map.sphere = textures_.add(pictures[0]);
    for (size_t i = 0; pictures.size() == cubeFaces && i < cubeFaces; ++i)
      map.faces[i] = textures_.add(pictures[i]);
  };
  try {
    const CubePictures pictures = decodeCube(bytes, room);
    add(pictures.images);
    add(pictures.radiance);
  } catch (...) {
    drop(map);
    throw;
  }
  return map;
}

} // namespace xvrml::mapper
