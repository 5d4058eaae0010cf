// arrays.cpp: Implements rtVertexPointer and the other array pointers, rtDrawArrays and
// rtDrawElements. Runs on the application's thread.
#include <limits>

#include "api/guard.h"

using namespace openrt;

namespace {

constexpr size_t maxStride = size_t(1) << 31;

AttributeSource checkedSource(int size, int least, int most, RTenum type, bool doubles,
                              size_t stride, const void* pointer) {
  require(size >= least && size <= most, RT_INVALID_VALUE,
          "this attribute cannot have so many components");
  require(type == RT_FLOAT || (doubles && type == RT_DOUBLE), RT_INVALID_ENUM,
          doubles ? "the type must be RT_FLOAT or RT_DOUBLE" : "the type must be RT_FLOAT");
  const size_t packed =
      static_cast<size_t>(size) * (type == RT_DOUBLE ? sizeof(double) : sizeof(float));
  require(stride == 0 || (stride >= packed && stride <= maxStride), RT_INVALID_VALUE,
          "the stride is smaller than an element");
  return {static_cast<const std::byte*>(pointer), stride ? stride : packed, size, type};
}

AttributeSource advanced(AttributeSource source, size_t first) {
  if (source.data) source.data += first * source.stride;
  return source;
}

void draw(Context& c, RTenum mode, size_t first, size_t count, const uint32_t* indices,
          size_t vertexCount) {
  Definition& definition = c.openDefinition();
  DrawCall call{mode,
                count,
                vertexCount,
                indices,
                advanced(c.vertexArray, first),
                advanced(c.normalArray, first),
                advanced(c.texCoordArray, first),
                advanced(c.colorArray, first),
                advanced(c.fogCoordArray, first),
                {},
                definition.formerIndices};
  if (c.boundShader != 0 && !c.parameterArrays.empty()) {
    const RTid shaderClass = c.scene.shader(c.boundShader).shaderClass;
    for (const ParameterArray& array : c.parameterArrays) {
      if (array.shaderClass != shaderClass) continue;
      call.parameters.push_back(array.from);
      if (array.from.parameter.perVertex)
        call.parameters.back().source = advanced(array.from.source, first);
    }
  }
  definition.builder.draw(call, c.latch(primitiveOf(mode)));
}

} // namespace

void rtVertexPointer(int size, RTenum type, size_t stride, const void* pointer) {
  guarded("rtVertexPointer", [&](Context& c) {
    c.vertexArray = checkedSource(size, 3, 3, type, true, stride, pointer);
  });
}

void rtNormalPointer(RTenum type, size_t stride, const void* pointer) {
  guarded("rtNormalPointer", [&](Context& c) {
    c.normalArray = checkedSource(3, 3, 3, type, false, stride, pointer);
  });
}

void rtTexCoordPointer(int size, RTenum type, size_t stride, const void* pointer) {
  guarded("rtTexCoordPointer", [&](Context& c) {
    c.texCoordArray = checkedSource(size, 2, 2, type, false, stride, pointer);
  });
}

void rtColorPointer(int size, RTenum type, size_t stride, const void* pointer) {
  guarded("rtColorPointer", [&](Context& c) {
    c.colorArray = checkedSource(size, 3, 4, type, false, stride, pointer);
  });
}

void rtFogCoordPointer(RTenum type, size_t stride, const void* pointer) {
  guarded("rtFogCoordPointer", [&](Context& c) {
    c.fogCoordArray = checkedSource(1, 1, 1, type, false, stride, pointer);
  });
}

void rtDrawArrays(RTenum mode, size_t first, size_t count) {
  guarded("rtDrawArrays", [&](Context& c) {
    require(first <= maxStride && count <= maxStride, RT_INVALID_VALUE, "more than 2^31 vertices");
    draw(c, mode, first, count, nullptr, count);
  });
}

void rtDrawElements(RTenum mode, size_t count, const uint32_t* indices, size_t vertexCount) {
  guarded("rtDrawElements", [&](Context& c) {
    require(indices || count == 0, RT_INVALID_VALUE, "the indices are NULL");
    static const uint32_t none = 0;
    draw(c, mode, 0, count, indices ? indices : &none, vertexCount);
  });
}
