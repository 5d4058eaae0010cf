#include "libpicture/export/pictures.h"

#include <algorithm>
#include <cmath>

#include "libpicture/files/formats.h"
#include "srgb.h"

namespace picture {

using xvrml::Image;
using xvrml::RadianceImage;

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

// Returns radiances from 0 to 1 as sRGB codes; brighter ones are white.
Image withCodes(const RadianceImage& picture) {
  Image image;
  image.width = picture.width;
  image.height = picture.height;
  image.components = 3;
  image.pixels.reserve(picture.rgb.size());
  for (const float v : picture.rgb)
    image.pixels.push_back(
        uint8_t(std::lround(255 * encodeSrgb(v > 0 ? std::min(double(v), 1.0) : 0.0))));
  return image;
}

bool hasTransparentPixel(const Image& image) {
  if (image.components != 2 && image.components != 4) return false;
  for (size_t i = size_t(image.components) - 1; i < image.pixels.size();
       i += size_t(image.components))
    if (image.pixels[i] < 255) return true;
  return false;
}

bool isWhole(const Image& image) {
  return image.width > 0 && image.height > 0 && image.components >= 1 && image.components <= 4 &&
         image.pixels.size() >=
             size_t(image.width) * size_t(image.height) * size_t(image.components);
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
  if (!picture.radiance.rgb.empty()) {
    picture.image = withCodes(picture.radiance);
    remarks_.change("radiances of a picture above 1 become white");
  }
  if (!isWhole(picture.image)) return {};
  if (texture.type().name == "MovieTexture")
    remarks_.change("a MovieTexture becomes the picture that it shows now");
  PictureFile file;
  file.components = picture.image.components;
  file.transparent = hasTransparentPixel(picture.image);
  file.isPng = picture.type != "image/jpeg";
  if (picture.type == "image/png" || picture.type == "image/jpeg")
    file.bytes.assign(picture.file.begin(), picture.file.end());
  else
    file.bytes = pngOf(fromTheTop(picture.image), picture.image.width, picture.image.height,
                       picture.image.components);
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
