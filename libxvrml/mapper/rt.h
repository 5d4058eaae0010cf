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
//
// The renderer refuses numbers that are not finite or out of range, with an error. The parameter
// then has its default, in a new shader as in an existing one: how a surface looks must not depend
// on the values that it had before.
class ShaderSetup {
 public:
  explicit ShaderSetup(RTid shaderClass) : class_(shaderClass), shader_(rtNewShader(shaderClass)) {
    rtBindShader(shader_);
  }
  // Changes an existing shader of this class. sets: counts the parameters that are set.
  ShaderSetup(RTid shaderClass, RTid shader, uint64_t& sets)
      : class_(shaderClass), shader_(shader), sets_(&sets) {
    rtBindShader(shader_);
  }
  ~ShaderSetup() { rtBindShader(0); }
  ShaderSetup(const ShaderSetup&) = delete;
  ShaderSetup& operator=(const ShaderSetup&) = delete;
  RTid id() const { return shader_; }
  bool fresh() const { return !sets_; }

  // A new shader gets no values that are its class's defaults: worlds have millions of shaders, and
  // most values are. Only for stock classes, whose defaults stay when libraries are reloaded.
  void leaveOutDefaults() { leavesOutDefaults_ = fresh(); }

  void integer(const char* name, int v);
  void number(const char* name, float v) { set(name, {&v, 1}); }
  // Clamps to the field's range. Parsers have warned about values outside it.
  void number(const char* name, float v, float low,
              float high = std::numeric_limits<float>::max()) {
    number(name, std::clamp(v, low, high));
  }
  void vector(const char* name, Vec3f v) { set(name, {&v.x, 3}); }
  void color(const char* name, Color c) { set(name, {&c.r, 3}); }
  void floats(const char* name, std::span<const float> v) { set(name, v); }
  // Sets a list, which may be empty.
  void list(const char* name, std::span<const float> v) {
    rtParameterfv(handle(name), v.size(), v.data());
  }
  void texture(const char* name, RTid texture) { rtParameterTexture(handle(name), texture); }
  void matrix(const char* name, const Matrix& m) {
    float f[16];
    for (int i = 0; i < 16; ++i) f[i] = float(data(m)[i]);
    set(name, f);
  }

 private:
  int handle(const char* name) {
    if (sets_) ++*sets_;
    return rtParameterHandle(name);
  }
  void set(const char* name, std::span<const float> values);

  RTid class_, shader_;
  uint64_t* sets_ = nullptr;
  bool leavesOutDefaults_ = false;
};

} // namespace xvrml::mapper
