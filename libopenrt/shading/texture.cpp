// texture.cpp: bilinear and nearest look-up. Bytes stay bytes in memory and are decoded by a table texel by texel, before they
// are mixed: mixing encoded values would darken every edge. See texture.h.
#include "shading/texture.h"

#include <array>
#include <cmath>
#include <utility>

namespace openrt {
namespace {

using Decoding = std::array<float, 256>;

// IEC 61966-2-1.
double srgbToLinear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

Decoding makeDecoding(bool srgb) {
  Decoding table;
  for (int i = 0; i < 256; i++) table[i] = static_cast<float>(srgb ? srgbToLinear(i / 255.0) : i / 255.0);
  return table;
}

const Decoding& decoding(bool srgb) {
  static const Decoding linear = makeDecoding(false), encoded = makeDecoding(true);
  return srgb ? encoded : linear;
}

// Coordinate in texels, 0..size.
float place(float u, const Texture::Axis& axis) {
  if (!std::isfinite(u)) u = 0;
  if (axis.clamp)
    u = u < 0 ? 0 : u > 1 ? 1 : u;
  else
    u -= std::floor(u);
  return u * static_cast<float>(axis.size);
}

struct Pair { // the two texels that a place lies between, and the share of the second
  int32_t first, second;
  float share;
};

Pair between(float u, const Texture::Axis& axis) {
  const float x = place(u, axis) - 0.5f, whole = std::floor(x);
  Pair p{static_cast<int32_t>(whole), static_cast<int32_t>(whole) + 1, x - whole};
  const int32_t last = axis.size - 1;
  if (p.first < 0) p.first = axis.clamp ? 0 : last;
  if (p.second > last) p.second = axis.clamp ? last : 0;
  return p;
}

int32_t nearestTexel(float u, const Texture::Axis& axis) {
  const auto i = static_cast<int32_t>(place(u, axis));
  return i < axis.size ? i : axis.size - 1;
}

void sampleNothing(const Texture&, uint32_t n, const float* const[2], float* const rgba[4]) {
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < n; i++) rgba[c][i] = 1.0f;
}

constexpr bool isAlpha(int component, int components) { return component == 3 || (component == 1 && components == 2); }

template <int components> void spread(const float* value, uint32_t i, float* const rgba[4]) {
  constexpr bool grey = components <= 2;
  rgba[0][i] = value[0];
  rgba[1][i] = value[grey ? 0 : 1];
  rgba[2][i] = value[grey ? 0 : 2];
  rgba[3][i] = components == 2 ? value[1] : components == 4 ? value[3] : 1.0f;
}

bool fits(const edit::TextureT& d, const ArrayPtr& texels) {
  constexpr uint32_t maxSide = 1u << 24; // sides are exact in float
  if (!texels || d.components < 1 || d.components > 4 || d.width < 1 || d.height < 1 || d.width > maxSide || d.height > maxSide)
    return false;
  const uint64_t bytes = uint64_t(d.width) * d.height * d.components * (d.isFloat ? sizeof(float) : 1);
  return texels->size() >= bytes;
}

} // namespace

template <class Texel, int components, bool nearest>
void Texture::sampleAs(const Texture& texture, uint32_t n, const float* const uv[2], float* const rgba[4]) {
  const Texel* texels = texture.texels_->as<Texel>();
  const float* decode = texture.decode_;
  const float* alpha = decoding(false).data();
  const auto width = static_cast<size_t>(texture.axis_[0].size);
  const auto at = [&](size_t index, int c) -> float {
    if constexpr (std::is_same_v<Texel, float>)
      return texels[index + static_cast<size_t>(c)];
    else
      return (isAlpha(c, components) ? alpha : decode)[static_cast<size_t>(texels[index + static_cast<size_t>(c)])];
  };
  const auto index = [&](int32_t x, int32_t y) { return (static_cast<size_t>(y) * width + static_cast<size_t>(x)) * components; };
  for (uint32_t i = 0; i < n; i++) {
    float value[components];
    if constexpr (nearest) {
      const size_t k = index(nearestTexel(uv[0][i], texture.axis_[0]), nearestTexel(uv[1][i], texture.axis_[1]));
      for (int c = 0; c < components; c++) value[c] = at(k, c);
    } else {
      const Pair s = between(uv[0][i], texture.axis_[0]), t = between(uv[1][i], texture.axis_[1]);
      const size_t k00 = index(s.first, t.first), k10 = index(s.second, t.first);
      const size_t k01 = index(s.first, t.second), k11 = index(s.second, t.second);
      for (int c = 0; c < components; c++) {
        const float below = at(k00, c) * (1 - s.share) + at(k10, c) * s.share;
        const float above = at(k01, c) * (1 - s.share) + at(k11, c) * s.share;
        value[c] = below * (1 - t.share) + above * t.share;
      }
    }
    spread<components>(value, i, rgba);
  }
}

template <class Texel> void Texture::choose(bool nearest) {
  static constexpr Sampler samplers[4][2] = {{sampleAs<Texel, 1, false>, sampleAs<Texel, 1, true>},
                                             {sampleAs<Texel, 2, false>, sampleAs<Texel, 2, true>},
                                             {sampleAs<Texel, 3, false>, sampleAs<Texel, 3, true>},
                                             {sampleAs<Texel, 4, false>, sampleAs<Texel, 4, true>}};
  sample_ = samplers[components_ - 1][nearest];
}

Texture::Texture(const edit::TextureT& d, ArrayPtr texels)
    : texels_(std::move(texels)), decode_(decoding(d.srgb).data()), sample_(sampleNothing) {
  if (!fits(d, texels_)) return;
  components_ = d.components;
  axis_[0] = {static_cast<int32_t>(d.width), d.wrapS == edit::Wrap::Clamp};
  axis_[1] = {static_cast<int32_t>(d.height), d.wrapT == edit::Wrap::Clamp};
  if (d.isFloat)
    choose<float>(d.nearest);
  else
    choose<uint8_t>(d.nearest);
}

} // namespace openrt
