// textures.cpp: Implements the API functions for textures. Runs on the application's thread.
#include <cmath>
#include <cstring>

#include "api/guard.h"
#include "picture_size.h"

using namespace openrt;

namespace {

TextureState& bound(Context& c) {
  require(c.boundTexture != 0, RT_INVALID_OPERATION, "no texture is bound");
  return c.scene.texture(c.boundTexture);
}

struct ImageSize {
  int width, height, depth;
};

void setImage(Context& c, int components, const ImageSize& size, RTenum type, const void* pixels) {
  TextureState& state = bound(c);
  require(type == RT_UNSIGNED_BYTE || type == RT_FLOAT, RT_INVALID_ENUM,
          "the type must be RT_UNSIGNED_BYTE or RT_FLOAT");
  require(components >= 1 && components <= 4, RT_INVALID_VALUE, "an image has 1 to 4 components");
  require(isVolumeSize(size.width, size.height, size.depth), RT_INVALID_VALUE,
          "an image has 1 to 65536 pixels a side and at most 2^28 in all");
  require(pixels != nullptr, RT_INVALID_VALUE, "the pixels are NULL");
  const size_t values = static_cast<size_t>(size.width) * static_cast<size_t>(size.height) *
                        static_cast<size_t>(size.depth) * static_cast<size_t>(components);
  auto texels = std::make_shared<Array>(values * (type == RT_FLOAT ? sizeof(float) : 1));
  std::memcpy(texels->data(), pixels, texels->size());
  if (type == RT_FLOAT)
    for (size_t i = 0; i < values; i++)
      require(std::isfinite(texels->as<float>()[i]), RT_INVALID_VALUE, "a texel is not finite");
  c.scene.textures.markDirty(c.boundTexture, state);
  edit::TextureT& d = state.description;
  d.components = static_cast<uint32_t>(components);
  d.width = static_cast<uint32_t>(size.width);
  d.height = static_cast<uint32_t>(size.height);
  d.depth = static_cast<uint32_t>(size.depth);
  d.isFloat = type == RT_FLOAT;
  state.texels = std::move(texels);
}

edit::Wrap wrapOf(int value) {
  switch (value) {
  case RT_REPEAT: return edit::Wrap::Repeat;
  case RT_CLAMP_TO_EDGE: return edit::Wrap::Clamp;
  case RT_MIRRORED_REPEAT: return edit::Wrap::Mirror;
  case RT_CLAMP_TO_BORDER: return edit::Wrap::Border;
  default:
    fail(RT_INVALID_ENUM, "the wrap must be RT_REPEAT, RT_MIRRORED_REPEAT, RT_CLAMP_TO_EDGE or "
                          "RT_CLAMP_TO_BORDER");
  }
}

// Replaces the description of the bound texture.
void describe(Context& c, TextureState& state, const edit::TextureT& changed) {
  const bool hasImage =
      state.texels || changed.texels != 0; // without an image there is nothing to send
  if (hasImage) c.scene.textures.markDirty(c.boundTexture, state);
  state.description = changed;
}

void setBorder(Context& c, RTenum name, const float* rgba) {
  TextureState& state = bound(c);
  if (name != RT_TEXTURE_BORDER_COLOR)
    fail(RT_INVALID_ENUM, "unknown texture parameter " + std::to_string(name) + " of floats");
  require(rgba != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
  for (int i = 0; i < 4; i++)
    require(rgba[i] >= 0 && rgba[i] <= 1, RT_INVALID_VALUE, "a colour has numbers of 0 to 1");
  edit::TextureT changed = state.description;
  changed.border.assign(rgba, rgba + 4);
  describe(c, state, changed);
}

void setParameter(Context& c, RTenum name, int value) {
  TextureState& state = bound(c);
  edit::TextureT changed = state.description;
  switch (name) {
  case RT_TEXTURE_WRAP_S: changed.wrapS = wrapOf(value); break;
  case RT_TEXTURE_WRAP_T: changed.wrapT = wrapOf(value); break;
  case RT_TEXTURE_WRAP_R: changed.wrapR = wrapOf(value); break;
  case RT_TEXTURE_MAG_FILTER:
    require(value == RT_NEAREST || value == RT_LINEAR, RT_INVALID_ENUM,
            "the filter must be RT_NEAREST or RT_LINEAR");
    changed.nearest = value == RT_NEAREST;
    break;
  case RT_TEXTURE_SRGB:
    require(value == 0 || value == 1, RT_INVALID_VALUE, "the value must be 0 or 1");
    changed.srgb = value == 1;
    break;
  default: fail(RT_INVALID_ENUM, "unknown texture parameter " + std::to_string(name));
  }
  describe(c, state, changed);
}

} // namespace

void rtGenTextures(size_t count, RTid* ids) {
  guarded("rtGenTextures", [&](Context& c) {
    require(ids || count == 0, RT_INVALID_VALUE, "the pointer is NULL");
    for (size_t i = 0; i < count; i++) ids[i] = c.scene.newTexture();
  });
}

void rtDeleteTexture(RTid texture) {
  guarded("rtDeleteTexture", [&](Context& c) {
    c.scene.deleteTexture(texture);
    if (c.boundTexture == texture) c.boundTexture = 0;
  });
}

void rtBindTexture(RTid texture) {
  guarded("rtBindTexture", [&](Context& c) {
    if (texture != 0) c.scene.texture(texture);
    c.boundTexture = texture;
  });
}

void rtTexImage2D(int components, int width, int height, RTenum type, const void* pixels) {
  guarded("rtTexImage2D", [&](Context& c) {
    setImage(c, components, {width, height, 1}, type, pixels);
  });
}

void rtTexImage3D(int components, int width, int height, int depth, RTenum type,
                  const void* pixels) {
  guarded("rtTexImage3D", [&](Context& c) {
    setImage(c, components, {width, height, depth}, type, pixels);
  });
}

void rtTexParameteri(RTenum name, int value) {
  guarded("rtTexParameteri", [&](Context& c) { setParameter(c, name, value); });
}

void rtTexParameterfv(RTenum name, const float rgba[4]) {
  guarded("rtTexParameterfv", [&](Context& c) { setBorder(c, name, rgba); });
}
