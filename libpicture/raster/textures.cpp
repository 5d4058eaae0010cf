#include "libpicture/raster/textures.h"

#include <algorithm>
#include <cmath>

#include "srgb.h"

namespace picture::raster {

using xvrml::Image;

namespace {

template <class T> bool readRepeats(const xvrml::Node& node, bool& s, bool& t) {
  const auto* texture = xvrml::nodeCast<T>(&node);
  if (!texture) return false;
  s = texture->repeatS;
  t = texture->repeatT;
  return true;
}

// The two pixels on both sides of a place along one axis, and the share of the second.
struct Between {
  int first, second;
  float share;
};

Between between(double coordinate, int size, bool repeats) {
  const double place =
      (repeats ? coordinate - std::floor(coordinate) : std::clamp(coordinate, 0.0, 1.0)) * size -
      0.5;
  const double below = std::floor(place);
  const int first = int(below), second = first + 1;
  const auto wrapped = [&](int i) {
    return repeats ? (i + size) % size : std::clamp(i, 0, size - 1);
  };
  return {wrapped(first), wrapped(second), float(place - below)};
}

Textures::Sample mixed(const Textures::Sample& a, const Textures::Sample& b, float share) {
  const float rest = 1 - share;
  return {{a.color.r * rest + b.color.r * share, a.color.g * rest + b.color.g * share,
           a.color.b * rest + b.color.b * share},
          a.alpha * rest + b.alpha * share};
}

} // namespace

Textures::Textures(const xvrml::World& world, bool linear) : world_(world) {
  for (size_t i = 0; i < values_.size(); ++i)
    values_[i] = linear ? decodeSrgb(float(i) / 255) : float(i) / 255;
}

std::optional<size_t> Textures::of(const xvrml::Node* texture) {
  if (!texture) return {};
  const auto [found, fresh] = nodes_.try_emplace(texture);
  if (!fresh) return found->second;
  xvrml::TexturePicture picture = xvrml::texturePicture(*texture, world_);
  if (const auto known = paths_.find(picture.path); !picture.path.empty() && known != paths_.end())
    return found->second = known->second;
  Image image = shownImage(picture);
  if (image.components == 0) return {};
  const Traits traits{image.components, hasTransparentPixel(image)};
  images_.push_back({std::move(image), traits});
  if (!picture.path.empty()) paths_.emplace(picture.path, images_.size() - 1);
  return found->second = images_.size() - 1;
}

Textures::Sample Textures::texel(const Image& image, int x, int y) const {
  const auto components = size_t(image.components);
  const uint8_t* from =
      image.pixels.data() + (size_t(y) * size_t(image.width) + size_t(x)) * components;
  const float red = values_[from[0]];
  const float alpha = components % 2 == 0 ? float(from[components - 1]) / 255 : 1;
  if (components < 3) return {{red, red, red}, alpha};
  return {{red, values_[from[1]], values_[from[2]]}, alpha};
}

Textures::Sample Textures::sample(const SurfacePicture& picture, double s, double t) const {
  const Image& image = images_[picture.file].image;
  const auto& [a, b, c, d, e, f] = picture.transform;
  const double u = a * s + c * t + e, v = b * s + d * t + f;
  if (!std::isfinite(u) || !std::isfinite(v)) return texel(image, 0, 0);
  bool repeatS = true, repeatT = true;
  const xvrml::Node& node = *picture.node;
  readRepeats<xvrml::nodes::ImageTexture>(node, repeatS, repeatT) ||
      readRepeats<xvrml::nodes::PixelTexture>(node, repeatS, repeatT) ||
      readRepeats<xvrml::nodes::MovieTexture>(node, repeatS, repeatT);
  const Between x = between(u, image.width, repeatS), y = between(v, image.height, repeatT);
  return mixed(mixed(texel(image, x.first, y.first), texel(image, x.second, y.first), x.share),
               mixed(texel(image, x.first, y.second), texel(image, x.second, y.second), x.share),
               y.share);
}

} // namespace picture::raster
