// shaders.cpp: Implements the API functions for shader classes, shaders and per-shader parameters,
// checked against the parameter tables of the classes. Per-triangle and per-vertex parameters are
// in geometry_parameters.cpp. Runs on the application's thread.
#include <cfloat>
#include <cstring>
#include <initializer_list>
#include <span>

#include "api/guard.h"
#include "api/parameters.h"
#include "shading/parameters.h"
#include "shading/running.h"

using namespace openrt;

static_assert(RT_PER_TRIANGLE == int(RTS_PER_TRIANGLE) && RT_PER_VERTEX == int(RTS_PER_VERTEX) &&
              RT_TRANSPORT_SHADER == int(RTS_TRANSPORT));
static_assert(RT_PARAM_INT == int(RTS_INT) && RT_PARAM_TEXTURE == int(RTS_TEXTURE) &&
              RT_PARAM_FLOATS == int(RTS_FLOATS) && RT_PARAM_COLOR == int(RTS_COLOR) &&
              RT_SURFACE == int(RTS_SURFACE) && RT_ENVIRONMENT == int(RTS_ENVIRONMENT));

namespace {

constexpr size_t maxListLength = size_t(1) << 24, maxStringLength = size_t(1) << 24;

ShaderState& bound(Context& c) {
  require(c.boundShader != 0, RT_INVALID_OPERATION, "no shader is bound");
  return c.scene.shader(c.boundShader);
}

// Returns the bound shader's parameter with this handle, whose type must be in the list. Throws
// between rtBegin and rtEnd.
const RtsParam& parameter(Context& c, int handle, std::initializer_list<RtsType> types) {
  const RtsClass& table = c.scene.classOf(bound(c));
  const RtsParam& param = declaredParameter(table, handle, types);
  if (inList(c))
    fail(RT_INVALID_OPERATION,
         std::string("parameter ") + param.name + " of the class " + table.name +
             " has one value for the whole shader: set it outside rtBegin and rtEnd");
  return param;
}

// Throws RT_INVALID_VALUE if the text from valueProblem() is not empty.
void throwIfInvalid(const std::string& problem) {
  if (!problem.empty()) fail(RT_INVALID_VALUE, problem);
}

void setFloats(Context& c, int handle, std::initializer_list<RtsType> types,
               std::span<const float> values) {
  if (setVaryingValue(c, handle, types, values)) return;
  const RtsParam& param = parameter(c, handle, types);
  throwIfInvalid(valueProblem(param, values));
  c.scene.setParameter(c.boundShader, {.index = uint32_t(handle), .floats = values});
}

int parameterHandle(Context& c, const char* name) {
  const RtsClass& table = c.scene.classOf(bound(c));
  require(name && *name, RT_INVALID_VALUE, "the name is NULL or empty");
  for (uint32_t i = 0; i < table.paramCount; i++)
    if (std::strcmp(table.params[i].name, name) == 0) return static_cast<int>(i);
  fail(RT_INVALID_PARAMETER,
       std::string("the class ") + table.name + " has no parameter \"" + name + "\"");
}

} // namespace

RTid rtNewShaderClass(const char* name, const char* library) {
  return guarded("rtNewShaderClass", RTid(0), [&](Context& c) {
    require(name && *name, RT_INVALID_VALUE, "the name is NULL or empty");
    const char* const from = library ? library : "";
    return c.scene.newShaderClass(c.findClass(name, from), name, from);
  });
}

int rtReloadShaders(void) {
  return guarded("rtReloadShaders", 0, [](Context& c) {
    c.requireOutsideDefinition();
    return c.reloadShaders("rtReloadShaders");
  });
}

const char* rtRunningShader(void) { return runningShader(); }

RTid rtNewShader(RTid shaderClass) {
  return guarded("rtNewShader", RTid(0),
                 [&](Context& c) { return c.scene.newShader(shaderClass); });
}

void rtBindShader(RTid shader) {
  guarded("rtBindShader", [&](Context& c) {
    if (shader != 0) c.scene.shader(shader);
    c.boundShader = shader;
  });
}

void rtDeleteShader(RTid shader) {
  guarded("rtDeleteShader", [&](Context& c) {
    c.scene.deleteShader(shader);
    if (c.boundShader == shader) c.boundShader = 0;
  });
}

int rtParameterHandle(const char* name) {
  return guarded("rtParameterHandle", -1, [&](Context& c) { return parameterHandle(c, name); });
}

void rtParameter1i(int handle, int value) {
  guarded("rtParameter1i", [&](Context& c) {
    throwIfInvalid(valueProblem(parameter(c, handle, {RTS_INT}), value));
    c.scene.setParameter(c.boundShader, {.index = uint32_t(handle), .integer = value});
  });
}

void rtParameter1f(int handle, float x) {
  guarded("rtParameter1f", [&](Context& c) { setFloats(c, handle, {RTS_FLOAT}, {{x}}); });
}

void rtParameter2f(int handle, float x, float y) {
  guarded("rtParameter2f", [&](Context& c) { setFloats(c, handle, {RTS_VEC2}, {{x, y}}); });
}

void rtParameter3f(int handle, float x, float y, float z) {
  guarded("rtParameter3f", [&](Context& c) {
    setFloats(c, handle, {RTS_VEC3, RTS_COLOR}, {{x, y, z}});
  });
}

void rtParameter4f(int handle, float x, float y, float z, float w) {
  guarded("rtParameter4f", [&](Context& c) { setFloats(c, handle, {RTS_VEC4}, {{x, y, z, w}}); });
}

void rtParameter16f(int handle, const float m[16]) {
  guarded("rtParameter16f", [&](Context& c) {
    require(m != nullptr, RT_INVALID_VALUE, "the matrix is NULL");
    setFloats(c, handle, {RTS_MATRIX}, {m, 16});
  });
}

void rtParameterfv(int handle, size_t count, const float* values) {
  guarded("rtParameterfv", [&](Context& c) {
    parameter(c, handle, {RTS_FLOATS});
    require(values || count == 0, RT_INVALID_VALUE, "the values are NULL");
    require(count <= maxListLength, RT_INVALID_VALUE, "more than 2^24 values");
    setFloats(c, handle, {RTS_FLOATS}, {values, count});
  });
}

void rtParameterString(int handle, const char* utf8) {
  guarded("rtParameterString", [&](Context& c) {
    parameter(c, handle, {RTS_STRING});
    require(utf8 != nullptr, RT_INVALID_VALUE, "the text is NULL");
    const std::string_view text = utf8;
    require(text.size() <= maxStringLength, RT_INVALID_VALUE, "the text has more than 2^24 bytes");
    c.scene.setParameter(c.boundShader, {.index = uint32_t(handle), .text = text});
  });
}

void rtParameterTexture(int handle, RTid texture) {
  guarded("rtParameterTexture", [&](Context& c) {
    parameter(c, handle, {RTS_TEXTURE});
    if (texture != 0) c.scene.texture(texture);
    c.scene.setParameter(c.boundShader, {.index = uint32_t(handle), .texture = texture});
  });
}

void rtGetShaderClass(RTid shaderClass, RTenum* kind, int* parameters) {
  guarded("rtGetShaderClass", [&](Context& c) {
    const RtsClass& table = *c.scene.shaderClass(shaderClass).table;
    if (kind) *kind = table.kind;
    if (parameters) *parameters = static_cast<int>(table.paramCount);
  });
}

void rtGetParameterInfo(RTid shaderClass, int handle, RTparameterInfo* info) {
  guarded("rtGetParameterInfo", [&](Context& c) {
    const RtsClass& table = *c.scene.shaderClass(shaderClass).table;
    require(info != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
    require(handle >= 0 && static_cast<uint32_t>(handle) < table.paramCount, RT_INVALID_PARAMETER,
            "no parameter with this handle");
    const RtsParam& param = table.params[handle];
    const bool unlimited = param.minimum == 0 && param.maximum == 0;
    RTparameterInfo result{};
    result.name = param.name;
    result.type = param.type;
    std::copy(std::begin(param.defaultValue), std::end(param.defaultValue), result.defaultValue);
    result.minimum = unlimited ? -FLT_MAX : param.minimum;
    result.maximum = unlimited ? FLT_MAX : param.maximum;
    result.text = param.text ? param.text : "";
    result.frequency = frequencyOf(table, static_cast<uint32_t>(handle));
    *info = result;
  });
}
