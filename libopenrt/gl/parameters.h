// parameters.h: sets parameters of the bound shader by name.
#pragma once

#include <array>
#include <cstdint>

#include "openrt/openrt.h"

namespace rtgl {

inline void set(const char* name, float value) { rtParameter1f(rtParameterHandle(name), value); }
inline void set(const char* name, int32_t value) { rtParameter1i(rtParameterHandle(name), value); }
inline void set(const char* name, const std::array<float, 3>& v) {
  rtParameter3f(rtParameterHandle(name), v[0], v[1], v[2]);
}
inline void setTexture(const char* name, RTid texture) {
  rtParameterTexture(rtParameterHandle(name), texture);
}
inline void setTextureTransform(const float (&t)[6]) {
  const float m[16] = {t[0], t[1], 0, 0, t[2], t[3], 0, 0, 0, 0, 1, 0, t[4], t[5], 0, 1};
  rtParameter16f(rtParameterHandle("textureTransform"), m);
}

} // namespace rtgl
