#include "mapper/rt.h"
#include "srgb.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace xvrml::mapper {

bool report(Diagnostics& diagnostics, const SourcePosition& where, std::string_view what) {
  bool fine = true;
  for (int i = 0; i < 8 && rtGetError() != RT_NO_ERROR; ++i) {
    diagnostics.error(where, std::string(what) + ": " + rtGetErrorMessage());
    fine = false;
  }
  return fine;
}

namespace {
float decode(float v) { return float(decodeSrgb(double(v))); }
} // namespace

Color convert(Color c, bool linear) {
  return linear ? Color{decode(c.r), decode(c.g), decode(c.b)} : c;
}

const ShaderClass& ShaderClasses::find(const std::string& name, const std::string& library) {
  const auto [it, fresh] = classes_.try_emplace(library + '\n' + name);
  ShaderClass& found = it->second;
  if (!fresh) return found;
  found.id = rtNewShaderClass(name.c_str(), library.empty() ? nullptr : library.c_str());
  int count = 0;
  if (found.id != 0) rtGetShaderClass(found.id, &found.role, &count);
  for (int i = 0; i < count; ++i) {
    RTparameterInfo info{};
    rtGetParameterInfo(found.id, i, &info);
    if (info.name) found.parameters.emplace(info.name, info.type);
  }
  return found;
}

namespace {
// Returns whether the renderer takes these numbers for the parameter.
bool takes(const RTparameterInfo& parameter, std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [&](float v) {
    return std::isfinite(v) && v >= parameter.minimum && v <= parameter.maximum;
  });
}

void write(const RTparameterInfo& parameter, int handle, std::span<const float> values) {
  const float* v = values.data();
  if (parameter.type == RT_PARAM_FLOATS) return rtParameterfv(handle, values.size(), v);
  switch (values.size()) {
  case 1: return rtParameter1f(handle, v[0]);
  case 3: return rtParameter3f(handle, v[0], v[1], v[2]);
  case 4: return rtParameter4f(handle, v[0], v[1], v[2], v[3]);
  case 16: return rtParameter16f(handle, v);
  }
}
} // namespace

void ShaderSetup::integer(const char* name, int v) {
  const int at = handle(name);
  if (leavesOutDefaults_) {
    RTparameterInfo parameter{};
    rtGetParameterInfo(class_, at, &parameter);
    if (parameter.defaultValue[0] == float(v)) return;
  }
  rtParameter1i(at, v);
}

void ShaderSetup::set(const char* name, std::span<const float> values) {
  const int at = handle(name);
  RTparameterInfo parameter{};
  rtGetParameterInfo(class_, at, &parameter);
  if (leavesOutDefaults_ && parameter.type != RT_PARAM_FLOATS &&
      std::memcmp(values.data(), parameter.defaultValue, values.size_bytes()) == 0)
    return;
  if (!fresh() && !takes(parameter, values)) {
    const size_t count = parameter.type == RT_PARAM_FLOATS ? 0 : values.size();
    write(parameter, at, {parameter.defaultValue, count});
  }
  write(parameter, at, values);
}

} // namespace xvrml::mapper
