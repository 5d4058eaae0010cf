// geometry_parameters.cpp: Sets shader parameters per triangle and per vertex, between rtBegin and
// rtEnd or from arrays. Runs on the application's thread.
#include "api/parameters.h"

#include "api/guard.h"
#include "shading/parameters.h"

namespace openrt {
namespace {

VaryingParameter varyingParameter(const RtsClass& table, uint32_t index) {
  return {index, parameterFloats(table.params[index].type),
          frequencyOf(table, index) == RT_PER_VERTEX};
}

void setPointer(Context& c, int handle, size_t stride, const float* pointer) {
  constexpr size_t maxStride = size_t(1) << 31;
  require(c.boundShader != 0, RT_INVALID_OPERATION, "no shader is bound");
  c.requireOutsideList();
  const RTid shaderClass = c.scene.shader(c.boundShader).shaderClass;
  const RtsClass& table = *c.scene.shaderClass(shaderClass).table;
  const RtsParam& param = declaredParameter(
      table, handle, {RTS_FLOAT, RTS_VEC2, RTS_VEC3, RTS_VEC4, RTS_COLOR, RTS_MATRIX});
  const auto index = static_cast<uint32_t>(handle);
  if (frequencyOf(table, index) == RT_PER_SHADER)
    fail(RT_INVALID_OPERATION, std::string("parameter ") + param.name + " of the class " +
                                   table.name + " has one value for the whole shader");
  const VaryingParameter own = varyingParameter(table, index);
  const size_t packed = own.floats * sizeof(float);
  require(stride == 0 || (stride >= packed && stride <= maxStride), RT_INVALID_VALUE,
          "the stride is smaller than an element");
  c.parameterArrays.reserve(c.parameterArrays.size() + 1);
  std::erase_if(c.parameterArrays, [&](const ParameterArray& a) {
    return a.shaderClass == shaderClass && a.from.parameter.index == index;
  });
  if (!pointer) return;
  const AttributeSource source{reinterpret_cast<const std::byte*>(pointer),
                               stride ? stride : packed, static_cast<int>(own.floats), RT_FLOAT};
  c.parameterArrays.push_back({shaderClass, {own, &param, source}});
}

} // namespace

const RtsParam& declaredParameter(const RtsClass& table, int handle,
                                  std::initializer_list<RtsType> types) {
  if (handle < 0 || static_cast<uint32_t>(handle) >= table.paramCount)
    fail(RT_INVALID_PARAMETER, "the class " + std::string(table.name) +
                                   " has no parameter with handle " + std::to_string(handle));
  const RtsParam& param = table.params[handle];
  for (RtsType type : types)
    if (param.type == type) return param;
  fail(RT_INVALID_PARAMETER, std::string("parameter ") + param.name + " of the class " +
                                 table.name + " has another type");
}

bool setVaryingValue(Context& c, int handle, std::initializer_list<RtsType> types,
                     std::span<const float> values) {
  if (!inList(c)) return false;
  const RTid shader = c.definition->builder.listShader();
  require(shader != 0, RT_INVALID_OPERATION, "no shader was bound at rtBegin");
  ShaderState& state = c.scene.shader(shader);
  const RtsClass& table = c.scene.classOf(state);
  const RtsParam& param = declaredParameter(table, handle, types);
  const auto index = static_cast<uint32_t>(handle);
  const VaryingParameter own = varyingParameter(table, index);
  if (frequencyOf(table, index) == RT_PER_SHADER || own.floats == 0) return false;
  if (const std::string problem = valueProblem(param, values); !problem.empty())
    fail(RT_INVALID_VALUE, problem);
  const auto set = state.values.find(index);
  const float* before = set ? set->floats.data() : param.defaultValue;
  c.definition->builder.parameter(own, values, {before, own.floats});
  return true;
}

} // namespace openrt

using namespace openrt;

void rtParameterPointer(int handle, size_t stride, const float* pointer) {
  guarded("rtParameterPointer", [&](Context& c) { setPointer(c, handle, stride, pointer); });
}
