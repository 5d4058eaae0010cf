// texture_picture.cpp: the pictures of texture nodes for programs. Nothing is kept: each call reads
// and decodes anew.
#include <exception>
#include <optional>
#include <utility>

#include "image/decoders.h"
#include "image/picture_urls.h"
#include "xvrml/appearance.h"
#include "xvrml/media.h"

namespace xvrml {
namespace {

// Decodes the file of a picture. Throws std::exception with the reason why it cannot be used.
void decode(TexturePicture& picture, const ImageRoom& room) {
  auto decoded = decodePicture(picture.file, room);
  if (auto* image = std::get_if<Image>(&decoded))
    picture.image = std::move(*image);
  else
    picture.radiance = std::get<RadianceImage>(std::move(decoded));
}

// Reads a file into a picture. Throws std::exception with the reason why it cannot be used.
TexturePicture readPicture(const std::string& path, const World& world, Decode mode) {
  const ImageRoom room{world.options.limits, ~uint64_t(0), budgetOf(world).get()};
  TexturePicture picture;
  picture.path = path;
  picture.file = readPictureFile(path, room);
  picture.type = mediaTypeOf(picture.file);
  // Decoding says what is wrong with other files.
  if (mode == Decode::yes || picture.type.empty()) decode(picture, room);
  return picture;
}

// Returns the picture of the first URL that can be used, else what is wrong with the first URL.
TexturePicture pictureOf(const nodes::ImageTexture& texture, const World& world, Decode mode,
                         size_t url) {
  TexturePicture none;
  for (; url < texture.url.size(); ++url) {
    std::optional<TexturePicture> found;
    const std::string error = openFirst({texture.url[url]}, texture, world,
                                        [&](const std::string& path, std::string& why) {
                                          try {
                                            found = readPicture(path, world, mode);
                                          } catch (const std::exception& failure) {
                                            why = failure.what();
                                          }
                                          return found.has_value();
                                        });
    if (found) {
      found->url = url;
      return *std::move(found);
    }
    if (none.error.empty()) none.error = error;
  }
  return none;
}

} // namespace

void decodeTexture(TexturePicture& picture, const Limits& limits) {
  if (picture.file.empty()) return;
  try {
    decode(picture, ImageRoom{limits});
  } catch (const TooManyPixels& failure) {
    picture.error = failure.what();
    picture.tooManyPixels = true;
  } catch (const std::exception& failure) { picture.error = failure.what(); }
}

TexturePicture texturePicture(const Node& texture, const World& world, Decode decode, size_t url) {
  TexturePicture picture;
  const Node* rendered = renderedNode(const_cast<Node*>(&texture));
  const Node& node = rendered ? *rendered : texture;
  if (const auto* file = nodeCast<nodes::ImageTexture>(&node)) {
    picture = pictureOf(*file, world, decode, url);
  } else if (const auto* pixels = nodeCast<nodes::PixelTexture>(&node)) {
    picture.image = pixels->image;
  } else if (nodeCast<nodes::MovieTexture>(&node)) {
    if (const Image* shown = currentImage(node))
      picture.image = *shown;
    else
      picture.error = "a MovieTexture has a picture only in a running world";
  } else {
    picture.error = node.type().name + " has no picture of its own";
  }
  return picture;
}

} // namespace xvrml
