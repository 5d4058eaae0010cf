// layers.h: the layers of pictures of a surface (MultiTexture, ISO/IEC 19775-1 18.4.3): each is
// combined with the colour that those before it leave. [render]
#pragma once

#include "vrml97/x3d_params.h"

namespace vrml97 {

// Table 18.3, in its order. REPLACE is as SELECTARG1.
enum class LayerMode : uint8_t {
  modulate,
  replace,
  modulate2x,
  modulate4x,
  add,
  addSigned,
  addSigned2x,
  subtract,
  addSmooth,
  blendDiffuseAlpha,
  blendTextureAlpha,
  blendFactorAlpha,
  blendCurrentAlpha,
  modulateAlphaAddColor,
  modulateInvAlphaAddColor,
  modulateInvColorAddAlpha,
  off,
  selectArg1,
  selectArg2,
  dotProduct3,
  count
};
enum class LayerSource : uint8_t { current, diffuse, specular, factor, count }; // table 18.4
enum class LayerFunction : uint8_t { none, complement, alphaReplicate, count }; // table 18.5

struct Layer {
  LayerMode color = LayerMode::modulate, alpha = LayerMode::modulate;
  LayerSource source = LayerSource::current;
  LayerFunction function = LayerFunction::none;
};
// Returns a layer of the parameter `layers`. Numbers without a meaning count as 0. Without `layers`
// the first texture is that of VRML97, by its number of components.
Layer layerOf(const X3dParams& p, uint32_t index, uint32_t components);

struct Rgba {
  float c[3], a;
};
// The colours that a layer may be combined with.
struct LayerColors {
  Rgba current, diffuse, specular, factor;
};
// Returns the colour after a layer with this texel. A texel without alpha (hasAlpha false) leaves
// the alpha as it is, except where the mode takes that of the other argument.
Rgba combined(const Layer& layer, const Rgba& texel, bool hasAlpha, const LayerColors& colors);

} // namespace vrml97
