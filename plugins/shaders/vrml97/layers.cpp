// layers.cpp: Computes the modes, sources and functions of the layers of a MultiTexture (ISO/IEC
// 19775-1 tables 18.3 to 18.5). Results are clamped to 0..1, as the standard's fixed functions do.
#include "vrml97/layers.h"

#include "vrml97/batch.h"

namespace vrml97 {
namespace {

float unit(float x) { return smaller(larger(x, 0.0f), 1.0f); }
float mix(float x, float y, float share) { return x * share + y * (1 - share); }

// Combines one component. x: of the texel, y: of the other argument; xa: the texel's alpha.
float combine(LayerMode mode, float x, float y, float xa, const LayerColors& colors) {
  switch (mode) {
  case LayerMode::replace:
  case LayerMode::selectArg1: return x;
  case LayerMode::selectArg2:
  case LayerMode::off: return y;
  case LayerMode::modulate2x: return 2 * x * y;
  case LayerMode::modulate4x: return 4 * x * y;
  case LayerMode::add: return x + y;
  case LayerMode::addSigned: return x + y - .5f;
  case LayerMode::addSigned2x: return 2 * (x + y - .5f);
  case LayerMode::subtract: return x - y;
  case LayerMode::addSmooth: return x + y - x * y;
  case LayerMode::blendDiffuseAlpha: return mix(x, y, colors.diffuse.a);
  case LayerMode::blendTextureAlpha: return mix(x, y, xa);
  case LayerMode::blendFactorAlpha: return mix(x, y, colors.factor.a);
  case LayerMode::blendCurrentAlpha: return mix(x, y, colors.current.a);
  case LayerMode::modulateAlphaAddColor: return x + xa * y;
  case LayerMode::modulateInvAlphaAddColor: return x + (1 - xa) * y;
  case LayerMode::modulateInvColorAddAlpha: return (1 - x) * y + xa;
  default: break;
  }
  return x * y;
}

float dot3(const Rgba& x, const Rgba& y) {
  float sum = 0;
  for (int c = 0; c < 3; c++) sum += (x.c[c] - .5f) * (y.c[c] - .5f);
  return 4 * sum;
}

// The modes that mix a colour with an alpha mean a product where they combine alphas.
LayerMode alphaModeOf(LayerMode mode) {
  return mode >= LayerMode::modulateAlphaAddColor && mode <= LayerMode::modulateInvColorAddAlpha
             ? LayerMode::modulate
             : mode;
}

template <class Enum> Enum enumOf(float number) {
  return number >= 0 && number < float(Enum::count) ? Enum(int(number)) : Enum(0);
}

} // namespace

Layer layerOf(const X3dParams& p, uint32_t index, uint32_t components) {
  const uint32_t first = numbersPerLayer * index;
  if (p.layers.count == 0 && index == 0) { // ISO/IEC 14772-1 table 4.6
    const bool multiplies = components <= 2 || p.front.multiplyTexture != 0;
    return {multiplies ? LayerMode::modulate : LayerMode::replace, LayerMode::replace,
            LayerSource::current, LayerFunction::none};
  }
  if (p.layers.count < first + numbersPerLayer) return {};
  const float* n = p.layers.data + first;
  return {enumOf<LayerMode>(n[0]), enumOf<LayerMode>(n[1]), enumOf<LayerSource>(n[2]),
          enumOf<LayerFunction>(n[3])};
}

Rgba combined(const Layer& layer, const Rgba& texel, bool hasAlpha, const LayerColors& colors) {
  if (layer.color == LayerMode::off) return colors.current;
  const Rgba& other = layer.source == LayerSource::diffuse    ? colors.diffuse
                      : layer.source == LayerSource::specular ? colors.specular
                      : layer.source == LayerSource::factor   ? colors.factor
                                                              : colors.current;
  Rgba result;
  const float dot = unit(dot3(texel, other));
  for (int c = 0; c < 3; c++)
    result.c[c] = layer.color == LayerMode::dotProduct3
                      ? dot
                      : unit(combine(layer.color, texel.c[c], other.c[c], texel.a, colors));
  const LayerMode alpha = alphaModeOf(layer.alpha);
  if (!hasAlpha)
    result.a =
        alpha == LayerMode::selectArg2 || alpha == LayerMode::modulate ? other.a : colors.current.a;
  else
    result.a = alpha == LayerMode::dotProduct3
                   ? dot
                   : unit(combine(alpha, texel.a, other.a, texel.a, colors));
  if (layer.function == LayerFunction::complement)
    for (float& c : result.c) c = 1 - c;
  if (layer.function == LayerFunction::alphaReplicate)
    for (float& c : result.c) c = result.a;
  return result;
}

} // namespace vrml97
