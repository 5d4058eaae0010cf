// texture.cpp: linear and nearest texture look-up in pictures and volumes. Bytes stay bytes in
// memory; a table decodes each texel before filtering, because filtering encoded values would
// darken every edge.
#include "shading/texture.h"
#include "srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace openrt {
namespace {

using Decoding = std::array<float, 256>;

Decoding makeDecoding(bool srgb) {
  Decoding table;
  for (int i = 0; i < 256; i++)
    table[i] = static_cast<float>(srgb ? decodeSrgb(i / 255.0) : i / 255.0);
  return table;
}

const Decoding& decoding(bool srgb) {
  static const Decoding linear = makeDecoding(false), encoded = makeDecoding(true);
  return srgb ? encoded : linear;
}

// The look-up of a chunk of a batch along one axis: the two neighbouring texels, and the weight of
// the second. The loops run over all lanes without calls, so that compilers vectorise them.
constexpr uint32_t chunk = 64;
struct TexelLookup {
  int32_t first[chunk], second[chunk];
  float weight[chunk];
};

// Converts coordinates to texels, 0..size. The integer part is removed by conversion to int; beyond
// 2^23 a float has no fraction.
void place(uint32_t n, const float* u, const Texture::Axis& axis, float* out) {
  const auto size = static_cast<float>(axis.size);
  if (axis.mirror) {
    for (uint32_t i = 0; i < n; i++) {  // all steps up to the last product are exact
      const float u0 = std::fabs(u[i]); // what is at -u is at u
      const float half = u0 < 8388608.0f ? 0.5f * u0 : 0.0f; // false for NaN
      const float period = 2.0f * (half - static_cast<float>(static_cast<int32_t>(half))); // 0..2
      out[i] = (period > 1.0f ? 2.0f - period : period) * size;
    }
    return;
  }
  if (axis.clamp) {
    for (uint32_t i = 0; i < n; i++) {
      const float finite = std::fabs(u[i]) <= std::numeric_limits<float>::max() ? u[i] : 0.0f;
      const float positive = finite > 0.0f ? finite : 0.0f;
      out[i] = (positive < 1.0f ? positive : 1.0f) * size;
    }
    return;
  }
  for (uint32_t i = 0; i < n; i++) {
    const float small = std::fabs(u[i]) < 8388608.0f ? u[i] : 0.0f; // false for NaN
    const float fraction = small - static_cast<float>(static_cast<int32_t>(small));
    out[i] = (fraction < 0.0f ? fraction + 1.0f : fraction) * size;
  }
}

void lookUpLinear(uint32_t n, const float* u, const Texture::Axis& axis, TexelLookup& p) {
  float texels[chunk];
  place(n, u, axis, texels);
  const int32_t last = axis.size - 1, before = axis.clamp ? 0 : last, after = axis.clamp ? last : 0;
  for (uint32_t i = 0; i < n; i++) {
    const float x = texels[i] + 0.5f; // minus half a texel, plus one, so that it is never negative
    const auto whole = static_cast<int32_t>(x);
    p.weight[i] = x - static_cast<float>(whole);
    p.first[i] = whole > 0 ? whole - 1 : before;
    p.second[i] = whole > last ? after : whole;
  }
}

void nearest(uint32_t n, const float* u, const Texture::Axis& axis, TexelLookup& p) {
  float texels[chunk];
  place(n, u, axis, texels);
  const int32_t last = axis.size - 1;
  for (uint32_t i = 0; i < n; i++) {
    const auto whole = static_cast<int32_t>(texels[i]);
    p.first[i] = whole < last ? whole : last;
  }
}

void sampleNothing(const Texture&, uint32_t n, const float* const[2], float* const rgba[4]) {
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < n; i++) rgba[c][i] = 1.0f;
}

constexpr bool isAlpha(int component, int components) {
  return component == 3 || (component == 1 && components == 2);
}

template <int components> void spread(const float* value, uint32_t i, float* const rgba[4]) {
  constexpr bool grey = components <= 2;
  rgba[0][i] = value[0];
  rgba[1][i] = value[grey ? 0 : 1];
  rgba[2][i] = value[grey ? 0 : 2];
  rgba[3][i] = components == 2 ? value[1] : components == 4 ? value[3] : 1.0f;
}

bool fits(const edit::TextureT& d, const ArrayPtr& texels) {
  constexpr uint32_t maxSide = 1u << 23; // halves of texels are exact in float
  if (!texels || d.components < 1 || d.components > 4 || d.width < 1 || d.height < 1 ||
      d.depth < 1 || d.width > maxSide || d.height > maxSide || d.depth > maxSide)
    return false;
  const uint64_t bytesOfSlice =
      uint64_t(d.width) * d.height * d.components * (d.isFloat ? sizeof(float) : 1);
  return texels->size() / bytesOfSlice >= d.depth;
}

} // namespace

template <class Texel, int components, bool single>
void Texture::sampleAs(const Texture& texture, uint32_t n, const float* const uv[2],
                       float* const rgba[4]) {
  const Texel* texels = texture.texels_->as<Texel>();
  const float* decode = texture.decode_;
  const float* alpha = decoding(false).data();
  const auto width = static_cast<size_t>(texture.axis_[0].size);
  const auto at = [&](size_t index, int c) -> float {
    if constexpr (std::is_same_v<Texel, float>)
      return texels[index + static_cast<size_t>(c)];
    else
      return (isAlpha(c, components)
                  ? alpha
                  : decode)[static_cast<size_t>(texels[index + static_cast<size_t>(c)])];
  };
  const auto index = [&](int32_t x, int32_t y) {
    return (static_cast<size_t>(y) * width + static_cast<size_t>(x)) * components;
  };
  TexelLookup s, t;
  for (uint32_t begin = 0; begin < n; begin += chunk) {
    const uint32_t count = std::min(chunk, n - begin);
    (single ? nearest : lookUpLinear)(count, uv[0] + begin, texture.axis_[0], s);
    (single ? nearest : lookUpLinear)(count, uv[1] + begin, texture.axis_[1], t);
    for (uint32_t i = 0; i < count; i++) {
      float value[components];
      const size_t k00 = index(s.first[i], t.first[i]);
      if constexpr (single) {
        for (int c = 0; c < components; c++) value[c] = at(k00, c);
      } else {
        const size_t k10 = index(s.second[i], t.first[i]), k01 = index(s.first[i], t.second[i]);
        const size_t k11 = index(s.second[i], t.second[i]);
        for (int c = 0; c < components; c++) {
          const float below = at(k00, c) * (1 - s.weight[i]) + at(k10, c) * s.weight[i];
          const float above = at(k01, c) * (1 - s.weight[i]) + at(k11, c) * s.weight[i];
          value[c] = below * (1 - t.weight[i]) + above * t.weight[i];
        }
      }
      spread<components>(value, begin + i, rgba);
    }
  }
}

namespace {

// The two neighbouring texels of one coordinate, -1 for the border, and the weight of the second.
struct Neighbours {
  int32_t first, second;
  float weight;
};

Neighbours neighbours(float u, const Texture::Axis& axis, bool single) {
  if (!axis.border) {
    TexelLookup p;
    if (single) p.weight[0] = 0;
    (single ? nearest : lookUpLinear)(1, &u, axis, p);
    return {p.first[0], single ? p.first[0] : p.second[0], p.weight[0]};
  }
  const auto size = static_cast<float>(axis.size);
  const float finite = std::fabs(u) <= std::numeric_limits<float>::max() ? u : 0.0f;
  const float x = std::fmin(std::fmax(finite * size, -2.0f), size + 2.0f) - (single ? 0.0f : 0.5f);
  const float whole = std::floor(x);
  const auto inside = [&](float i) {
    return i >= 0 && i < size ? static_cast<int32_t>(i) : int32_t(-1);
  };
  return {inside(whole), inside(single ? whole : whole + 1), single ? 0.0f : x - whole};
}

} // namespace

// Samples a texture with a border, which few have.
template <class Texel, int components, bool single>
void Texture::sampleBordered(const Texture& texture, uint32_t n, const float* const uv[2],
                             float* const rgba[4]) {
  const Texel* texels = texture.texels_->as<Texel>();
  const float* alpha = decoding(false).data();
  const auto width = static_cast<size_t>(texture.axis_[0].size);
  const auto at = [&](int32_t x, int32_t y, int c) -> float {
    if (x < 0 || y < 0) return texture.border_[c];
    const Texel texel =
        texels[(static_cast<size_t>(y) * width + static_cast<size_t>(x)) * components + size_t(c)];
    if constexpr (std::is_same_v<Texel, float>)
      return texel;
    else
      return (isAlpha(c, components) ? alpha : texture.decode_)[static_cast<size_t>(texel)];
  };
  for (uint32_t i = 0; i < n; i++) {
    const Neighbours s = neighbours(uv[0][i], texture.axis_[0], single),
                     t = neighbours(uv[1][i], texture.axis_[1], single);
    float value[components];
    for (int c = 0; c < components; c++) {
      const float below =
          at(s.first, t.first, c) * (1 - s.weight) + at(s.second, t.first, c) * s.weight;
      const float above =
          at(s.first, t.second, c) * (1 - s.weight) + at(s.second, t.second, c) * s.weight;
      value[c] = below * (1 - t.weight) + above * t.weight;
    }
    spread<components>(value, i, rgba);
  }
}

// Samples volumes: two neighbours along each axis, eight texels in all. Few worlds have volumes, so
// one function serves every number of components.
template <class Texel>
void Texture::sampleVolumeAs(uint32_t n, const float* const str[3], float* const rgba[4]) const {
  const Texel* texels = texels_->as<Texel>();
  const float* alpha = decoding(false).data();
  const auto width = size_t(axis_[0].size), height = size_t(axis_[1].size);
  const int components = int(components_);
  const auto at = [&](int32_t x, int32_t y, int32_t z, int c) -> float {
    if (x < 0 || y < 0 || z < 0) return border_[c];
    const Texel texel =
        texels[((size_t(z) * height + size_t(y)) * width + size_t(x)) * components_ + size_t(c)];
    if constexpr (std::is_same_v<Texel, float>)
      return texel;
    else
      return (isAlpha(c, components) ? alpha : decode_)[static_cast<size_t>(texel)];
  };
  const auto mix = [](float a, float b, float part) { return a * (1 - part) + b * part; };
  for (uint32_t i = 0; i < n; i++) {
    const Neighbours s = neighbours(str[0][i], axis_[0], nearest_),
                     t = neighbours(str[1][i], axis_[1], nearest_),
                     r = neighbours(str[2][i], axis_[2], nearest_);
    float value[4] = {};
    for (int c = 0; c < components; c++) {
      const auto row = [&](int32_t y, int32_t z) {
        return mix(at(s.first, y, z, c), at(s.second, y, z, c), s.weight);
      };
      const auto slice = [&](int32_t z) {
        return mix(row(t.first, z), row(t.second, z), t.weight);
      };
      value[c] = mix(slice(r.first), slice(r.second), r.weight);
    }
    const bool grey = components <= 2;
    for (int c = 0; c < 3; c++) rgba[c][i] = value[grey ? 0 : c];
    rgba[3][i] = components == 2 ? value[1] : components == 4 ? value[3] : 1.0f;
  }
}

void Texture::sampleVolume(uint32_t n, const float* const str[3], float* const rgba[4]) const {
  if (axis_[2].size == 1) return sample(n, str, rgba);
  if (float_)
    sampleVolumeAs<float>(n, str, rgba);
  else
    sampleVolumeAs<uint8_t>(n, str, rgba);
}

template <class Texel> void Texture::choose(bool nearest) {
  if (axis_[0].border || axis_[1].border) {
    static constexpr Sampler bordered[4][2] = {
        {sampleBordered<Texel, 1, false>, sampleBordered<Texel, 1, true>},
        {sampleBordered<Texel, 2, false>, sampleBordered<Texel, 2, true>},
        {sampleBordered<Texel, 3, false>, sampleBordered<Texel, 3, true>},
        {sampleBordered<Texel, 4, false>, sampleBordered<Texel, 4, true>}};
    sample_ = bordered[components_ - 1][nearest];
    return;
  }
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
  const auto axis = [](uint32_t size, edit::Wrap wrap) {
    return Axis{static_cast<int32_t>(size), wrap == edit::Wrap::Clamp || wrap == edit::Wrap::Mirror,
                wrap == edit::Wrap::Mirror, wrap == edit::Wrap::Border};
  };
  axis_[0] = axis(d.width, d.wrapS);
  axis_[1] = axis(d.height, d.wrapT);
  axis_[2] = axis(d.depth, d.wrapR);
  float_ = d.isFloat;
  nearest_ = d.nearest;
  if (d.border.size() == 4)
    for (uint32_t c = 0; c < components_; c++)
      border_[c] = d.border[isAlpha(int(c), int(components_)) ? 3 : c];
  if (d.isFloat)
    choose<float>(d.nearest);
  else
    choose<uint8_t>(d.nearest);
}

} // namespace openrt
