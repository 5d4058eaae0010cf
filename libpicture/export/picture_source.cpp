#include "libpicture/export/picture_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "srgb.h"

namespace picture {

using xvrml::Image;
using xvrml::RadianceImage;

namespace {

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

bool isWhole(const Image& image) {
  return image.width > 0 && image.height > 0 && image.components >= 1 && image.components <= 4 &&
         image.pixels.size() >=
             size_t(image.width) * size_t(image.height) * size_t(image.components);
}

} // namespace

Image shownImage(xvrml::TexturePicture& picture) {
  Image image =
      picture.radiance.rgb.empty() ? std::move(picture.image) : withCodes(picture.radiance);
  return isWhole(image) ? image : Image();
}

bool hasTransparentPixel(const Image& image) {
  if (image.components != 2 && image.components != 4) return false;
  for (size_t i = size_t(image.components) - 1; i < image.pixels.size();
       i += size_t(image.components))
    if (image.pixels[i] < 255) return true;
  return false;
}

} // namespace picture
