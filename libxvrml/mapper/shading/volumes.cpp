#include "mapper/shading/volumes.h"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <vector>

#include "image/decoders.h"
#include "image/picture_urls.h"
#include "xvrml/appearance.h"

namespace xvrml::mapper {
namespace {

// Returns whether a volume is made of a picture, or repeats as the TextureProperties say.
bool holds(const Node& volume, const Node& part) {
  if (const auto* stack = nodeCast<nodes::ComposedTexture3D>(&volume))
    if (std::any_of(stack->texture.begin(), stack->texture.end(),
                    [&](const NodeRef& slice) { return renderedNode(slice.get()) == &part; }))
      return true;
  const FieldInfo* field = volume.type().find("textureProperties");
  return field && renderedNode(static_cast<const NodeRef*>(volume.storage(*field))->get()) == &part;
}

template <class T> RTid addTo(Textures& textures, const Volume& volume, const Node& node) {
  const auto& n = static_cast<const T&>(node);
  return textures.add(volume, {n.repeatS, n.repeatT, n.repeatR}, n.textureProperties);
}

} // namespace

bool isVolume(Node* texture) {
  Node* node = renderedNode(texture);
  return node && node->type().is("texture3D");
}

RTid Volumes::of(Node& node) {
  Entry& entry = entries_[&node];
  if (!entry.stale) return entry.id;
  textures_.drop(entry.id);
  entry = {NodeRef(&node), make(node), false};
  return entry.id;
}

bool Volumes::changed(const Node& node) {
  bool concerns = node.type().is("texture3D");
  for (auto& [volume, entry] : entries_) {
    if (volume != &node && !holds(*volume, node)) continue;
    entry.stale = concerns = true;
  }
  return concerns;
}

void Volumes::clear() {
  for (auto& [node, entry] : entries_) textures_.drop(entry.id);
  entries_.clear();
}

RTid Volumes::make(const Node& node) {
  RTid id = 0;
  try {
    const Volume volume = read(node);
    if (nodeCast<nodes::ComposedTexture3D>(&node))
      id = addTo<nodes::ComposedTexture3D>(textures_, volume, node);
    else if (nodeCast<nodes::ImageTexture3D>(&node))
      id = addTo<nodes::ImageTexture3D>(textures_, volume, node);
    else
      id = addTo<nodes::PixelTexture3D>(textures_, volume, node);
  } catch (const std::exception& failure) {
    world_.diagnostics.warn(node.source, node.type().name + ": no picture: " + failure.what());
  }
  report(world_.diagnostics, node.source, node.type().name);
  return id;
}

Volume Volumes::read(const Node& node) {
  if (const auto* file = nodeCast<nodes::ImageTexture3D>(&node)) return readFile(*file);
  if (const auto* stack = nodeCast<nodes::ComposedTexture3D>(&node)) return stackOf(*stack);
  const auto* pixels = nodeCast<nodes::PixelTexture3D>(&node);
  if (!pixels) throw std::runtime_error("it is no volume that can be drawn");
  return volumeOf(pixels->image, textures_.roomForPicture());
}

Volume Volumes::readFile(const nodes::ImageTexture3D& node) {
  Volume volume;
  if (node.url.empty()) return volume;
  const std::string error =
      openFirst(node.url, node, world_, [&](const std::string& path, std::string& why) {
        try {
          const ImageRoom room = textures_.roomForPicture();
          volume = decodeVolume(readPictureFile(path, room), room);
        } catch (const std::exception& failure) { why = failure.what(); }
        return !volume.pixels.empty();
      });
  if (volume.pixels.empty()) throw std::runtime_error(error);
  return volume;
}

Volume Volumes::stackOf(const nodes::ComposedTexture3D& node) {
  const ImageRoom room = textures_.roomForPicture();
  std::vector<Image> slices;
  uint64_t bytes = 0;
  for (size_t i = 0; i < node.texture.size(); ++i) {
    const std::string where = "texture " + std::to_string(i);
    const Node* slice = renderedNode(node.texture[i].get());
    if (!slice) throw std::runtime_error(where + " is NULL, expected a picture");
    TexturePicture picture = texturePicture(*slice, world_, Decode::yes);
    if (!picture.error.empty()) throw std::runtime_error(where + ": " + picture.error);
    if (picture.image.pixels.empty())
      throw std::runtime_error(where + " has no pixels of bytes, expected a picture");
    bytes += picture.image.pixels.size();
    if (bytes > room.bytes || (room.budget && 2 * bytes > room.budget->left()))
      throw std::runtime_error(where + " and those before it take too much memory, see the limit "
                                       "'imagePixels'");
    slices.push_back(std::move(picture.image));
  }
  return stacked(slices, room);
}

} // namespace xvrml::mapper
