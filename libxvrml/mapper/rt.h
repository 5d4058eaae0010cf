// rt.h: helpers for OpenRT calls: errors become diagnostics with a position, parameters are set by
// name. [the thread that holds the context]
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "geometry/matrix.h"
#include "openrt/openrt.h"
#include "xvrml/diagnostics.h"

namespace xvrml::mapper {

// Reports all pending rtGetError errors at `where`. Returns true if there were none.
bool report(Diagnostics& diagnostics, const SourcePosition& where, std::string_view what);

inline void load(const Matrix& m) { rtLoadMatrixd(data(m)); }

// Converts a colour of the world for the renderer: to linear (IEC 61966-2-1), or unchanged.
Color convert(Color c, bool linear);

struct ShaderClass {
  RTid id = 0;                                        // 0: the class does not exist
  RTenum role = 0;                                    // RT_SURFACE ...
  std::unordered_map<std::string, RTenum> parameters; // RT_PARAM_* by name
  bool has(const char* parameter) const { return parameters.contains(parameter); }
};

// Shader classes by name, loaded on first use.
class ShaderClasses {
 public:
  const ShaderClass& find(const std::string& name, const std::string& library);
  RTid get(const std::string& name, const std::string& library) { return find(name, library).id; }

 private:
  std::unordered_map<std::string, ShaderClass> classes_;
};

// Sets the parameters of a shader, which is bound for the lifetime of this object. Every setter
// takes the name of a parameter that the class declares.
class ShaderSetup {
 public:
  explicit ShaderSetup(RTid shaderClass) : shader_(rtNewShader(shaderClass)) {
    rtBindShader(shader_);
  }
  // Changes an existing shader. sets: counts the parameters that are set.
  ShaderSetup(RTid shader, uint64_t& sets) : shader_(shader), sets_(&sets) {
    rtBindShader(shader_);
  }
  ~ShaderSetup() { rtBindShader(0); }
  ShaderSetup(const ShaderSetup&) = delete;
  ShaderSetup& operator=(const ShaderSetup&) = delete;
  RTid id() const { return shader_; }
  bool fresh() const { return !sets_; }

  void integer(const char* name, int v) { rtParameter1i(handle(name), v); }
  void number(const char* name, float v) { rtParameter1f(handle(name), v); }
  // Clamps to the field's range. Parsers have warned about values outside it.
  void number(const char* name, float v, float low,
              float high = std::numeric_limits<float>::max()) {
    number(name, std::clamp(v, low, high));
  }
  void vector(const char* name, Vec3f v) { rtParameter3f(handle(name), v.x, v.y, v.z); }
  void color(const char* name, Color c) { rtParameter3f(handle(name), c.r, c.g, c.b); }
  void floats(const char* name, std::span<const float> v) {
    rtParameterfv(handle(name), v.size(), v.data());
  }
  void texture(const char* name, RTid texture) { rtParameterTexture(handle(name), texture); }
  void matrix(const char* name, const Matrix& m) {
    float f[16];
    for (int i = 0; i < 16; ++i) f[i] = float(data(m)[i]);
    rtParameter16f(handle(name), f);
  }

 private:
  int handle(const char* name) {
    if (sets_) ++*sets_;
    return rtParameterHandle(name);
  }
  RTid shader_;
  uint64_t* sets_ = nullptr;
};

} // namespace xvrml::mapper
