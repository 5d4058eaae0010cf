#include "libpicture/export/pictures.h"

#include <algorithm>

#include "libpicture/files/formats.h"

namespace picture {

using xvrml::Image;

namespace {

// Returns the rows from the top, which nodes keep from the bottom.
std::vector<uint8_t> fromTheTop(const Image& image) {
  const size_t row = size_t(image.width) * size_t(image.components);
  std::vector<uint8_t> bytes(row * size_t(image.height));
  for (size_t y = 0; y < size_t(image.height); ++y)
    std::copy_n(image.pixels.begin() + ptrdiff_t((size_t(image.height) - 1 - y) * row), row,
                bytes.begin() + ptrdiff_t(y * row));
  return bytes;
}

} // namespace

std::optional<size_t> Pictures::of(const xvrml::Node* texture) {
  if (!texture) return {};
  const auto [found, fresh] = nodes_.try_emplace(texture);
  if (fresh) found->second = read(*texture);
  return found->second;
}

std::optional<size_t> Pictures::read(const xvrml::Node& texture) {
  xvrml::TexturePicture picture = xvrml::texturePicture(texture, world_);
  if (const auto known = paths_.find(picture.path); !picture.path.empty() && known != paths_.end())
    return known->second;
  if (!picture.error.empty())
    remarks_.change("a " + texture.type().name + " has no picture: " + picture.error);
  if (!picture.radiance.rgb.empty()) remarks_.change("radiances of a picture above 1 become white");
  const Image image = shownImage(picture);
  if (image.components == 0) return {};
  if (texture.type().name == "MovieTexture")
    remarks_.change("a MovieTexture becomes the picture that it shows now");
  PictureFile file;
  file.components = image.components;
  file.transparent = hasTransparentPixel(image);
  file.isPng = picture.type != "image/jpeg";
  if (picture.type == "image/png" || picture.type == "image/jpeg")
    file.bytes.assign(picture.file.begin(), picture.file.end());
  else
    file.bytes = pngOf(fromTheTop(image), image.width, image.height, image.components);
  files_.push_back(std::move(file));
  if (!picture.path.empty()) paths_.emplace(picture.path, files_.size() - 1);
  return files_.size() - 1;
}

std::vector<std::string> Pictures::inputs() const {
  std::vector<std::string> list;
  for (const auto& [path, place] : paths_)
    if (!path.starts_with("data:")) list.push_back(path);
  return list;
}

} // namespace picture
