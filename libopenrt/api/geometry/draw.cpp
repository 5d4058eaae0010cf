// draw.cpp: builds the geometry of rtDrawArrays and rtDrawElements. Attributes are copied directly
// into the arrays that are sent to the backend; everything is checked before anything is stored.
// Runs on the application's thread.
#include <atomic>
#include <cstring>

#include "api/geometry/object_builder.h"
#include "api/geometry/transform.h"
#include "parallel_for.h"
#include "shading/parameters.h"

namespace openrt {
namespace {

constexpr size_t maxVertices = size_t(1) << 31;

bool allFinite(const float* values, size_t count) {
  // x - x is 0 for finite x and NaN otherwise. Eight independent sums hide the latency of the
  // additions.
  float sums[8] = {};
  size_t i = 0;
  for (; i + 8 <= count; i += 8)
    for (size_t k = 0; k < 8; k++) sums[k] += values[i + k] - values[i + k];
  for (; i < count; i++) sums[0] += values[i] - values[i];
  float total = 0;
  for (float s : sums) total += s;
  return total == 0;
}

void checkIndices(const DrawCall& call) {
  if (!call.indices) return;
  std::atomic<uint32_t> largest{0};
  forRanges(call.count, [&](size_t begin, size_t end) {
    uint32_t most = 0;
    for (size_t i = begin; i < end; i++) most = std::max(most, call.indices[i]);
    for (uint32_t known = largest; known < most && !largest.compare_exchange_weak(known, most);) {}
  });
  if (call.count > 0 && largest >= call.vertexCount)
    fail(RT_INVALID_VALUE, "index " + std::to_string(largest) + " is beyond the " +
                               std::to_string(call.vertexCount) + " vertices");
}

// The set of vertices that a draw call uses; only these must be finite.
class UsedVertices {
 public:
  explicit UsedVertices(const DrawCall& call) : all_(!call.indices) {
    if (all_) return;
    used_.resize(call.vertexCount);
    for (size_t i = 0; i < call.count; i++) used_[call.indices[i]] = true;
  }
  bool operator[](size_t i) const { return all_ || used_[i]; }

 private:
  bool all_;
  std::vector<bool> used_;
};

// Throws if a used value is not finite. Sets unused values that are not finite to 0.
void clearUnused(const DrawCall& call, float* values, size_t components, const char* complaint) {
  const UsedVertices used(call);
  for (size_t i = 0; i < call.vertexCount; i++) {
    if (allFinite(values + components * i, components)) continue;
    if (used[i]) fail(RT_INVALID_VALUE, complaint);
    std::fill_n(values + components * i, components, 0.0f);
  }
}

// Copies elements into elements of `to` floats; missing components become 1 (alpha). Returns
// whether all numbers are finite.
bool copyElements(const AttributeSource& source, size_t count, size_t to, float* out) {
  const size_t from = static_cast<size_t>(source.components);
  std::atomic<bool> finite{true};
  forRanges(count, [&](size_t begin, size_t end) {
    float* const first = out + begin * to;
    if (from == to && source.stride == to * sizeof(float)) {
      std::memcpy(first, source.data + begin * source.stride, (end - begin) * source.stride);
    } else {
      float* at = first;
      for (size_t i = begin; i < end; i++, at += to) {
        std::memcpy(at, source.data + i * source.stride, from * sizeof(float));
        for (size_t k = from; k < to; k++) at[k] = 1;
      }
    }
    if (!allFinite(first, (end - begin) * to)) finite = false;
  });
  return finite;
}

ArrayPtr attribute(const DrawCall& call, const AttributeSource& source, size_t components, bool set,
                   const float* current, const char* complaint) {
  if (!source.data && !set) return nullptr;
  auto array = std::make_shared<Array>(call.vertexCount * components * sizeof(float));
  float* out = reinterpret_cast<float*>(array->data());
  if (source.data) {
    if (!copyElements(source, call.vertexCount, components, out))
      clearUnused(call, out, components, complaint);
  } else {
    for (size_t i = 0; i < call.vertexCount; i++)
      std::copy_n(current, components, out + components * i);
  }
  return array;
}

Vec3d loadPoint(const AttributeSource& source, size_t i) {
  Vec3d p;
  std::memcpy(&p, source.data + i * source.stride, sizeof(p));
  return p;
}

// Converts points given in double to float, relative to a local origin (which goes into `matrix`)
// unless float represents them exactly.
ArrayPtr widePoints(const DrawCall& call, Matrix4d& matrix) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  const UsedVertices used(call);
  WideBounds bounds;
  for (size_t i = 0; i < call.vertexCount; i++) {
    if (!used[i]) continue;
    const Vec3d p = loadPoint(call.points, i);
    if (!isFinite(p) || largest(abs(p)) > maxCoordinate)
      fail(RT_INVALID_VALUE, "a coordinate is not finite or beyond 1e38");
    bounds.add(p);
  }
  const Vec3d origin = bounds.exact ? Vec3d() : bounds.origin();
  auto array = std::make_shared<Array>(call.vertexCount * 3 * sizeof(float));
  float* out = reinterpret_cast<float*>(array->data());
  for (size_t i = 0; i < call.vertexCount; i++, out += 3) {
    const Vec3d p = used[i] ? loadPoint(call.points, i) - origin : Vec3d();
    store(Vec3f(p), out);
  }
  if (!bounds.exact) matrix = matrix * translation(origin.x, origin.y, origin.z);
  return array;
}

// Returns whether the vertices are triangles as they stand, none of which is degenerate.
bool areTriangles(const DrawCall& call, const float* points) {
  if (call.mode != RT_TRIANGLES || !call.indices || call.count % 3 != 0) return false;
  std::atomic<bool> good{true};
  forRanges(call.count / 3, [&](size_t begin, size_t end) {
    const auto point = [&](size_t corner) { return points + 3 * size_t(call.indices[corner]); };
    for (size_t t = begin; t < end; t++)
      if (degenerateTriangle(point(3 * t), point(3 * t + 1), point(3 * t + 2))) {
        good = false;
        return;
      }
  });
  return good;
}

// Returns whether the indices are those of the former array.
bool isFormer(const DrawCall& call) {
  if (!call.formerIndices || call.formerIndices->count<uint32_t>() != call.count) return false;
  std::atomic<bool> same{true};
  forRanges(call.count, [&](size_t begin, size_t end) {
    if (std::memcmp(call.indices + begin, call.formerIndices->as<uint32_t>() + begin,
                    (end - begin) * sizeof(uint32_t)) != 0)
      same = false;
  });
  return same;
}

// Returns the indices of the primitives that are not degenerate. ordinals: receives, if not null,
// the number of each of them among all primitives of the call.
ArrayPtr collectIndices(const DrawCall& call, const float* points, uint64_t& degenerate,
                        std::vector<uint32_t>* ordinals) {
  const bool unchanged = !ordinals && areTriangles(call, points);
  if (unchanged && isFormer(call)) return call.formerIndices;
  const size_t room = indexCount(call.mode, call.count);
  auto array = std::make_shared<Array>(room * sizeof(uint32_t));
  uint32_t* out = reinterpret_cast<uint32_t*>(array->data());
  if (unchanged) {
    forRanges(room, [&](size_t begin, size_t end) {
      std::copy(call.indices + begin, call.indices + end, out + begin);
    });
    return array;
  }
  const uint32_t* end = nullptr;
  const auto kept = [ordinals](size_t ordinal) {
    if (ordinals) ordinals->push_back(static_cast<uint32_t>(ordinal));
  };
  if (call.indices)
    end = writeIndices(
        call.mode, call.count, points, [&](size_t i) { return call.indices[i]; }, out, degenerate,
        kept);
  else
    end = writeIndices(
        call.mode, call.count, points, [](size_t i) { return static_cast<uint32_t>(i); }, out,
        degenerate, kept);
  const size_t written = static_cast<size_t>(end - out);
  if (written == room) return array;
  auto fitting = std::make_shared<Array>(written * sizeof(uint32_t));
  std::memcpy(fitting->data(), out, fitting->size());
  return fitting;
}

// Returns the values of a shader parameter. Used values must be valid for the parameter; unused
// ones are set to its default.
BuiltParameter varyingValues(const DrawCall& call, const ParameterSource& from,
                             const std::vector<uint32_t>& ordinals) {
  const UsedVertices used(call);
  const bool perVertex = from.parameter.perVertex;
  const size_t count = perVertex ? call.vertexCount : ordinals.size(), n = from.parameter.floats;
  auto array = std::make_shared<Array>(count * n * sizeof(float));
  float* out = reinterpret_cast<float*>(array->data());
  for (size_t i = 0; i < count; i++, out += n) {
    std::memcpy(out, from.source.data + (perVertex ? i : ordinals[i]) * from.source.stride,
                n * sizeof(float));
    const std::string problem = valueProblem(*from.declared, std::span<const float>(out, n));
    if (problem.empty()) continue;
    if (!perVertex || used[i]) fail(RT_INVALID_VALUE, problem);
    std::copy_n(from.declared->defaultValue, n, out);
  }
  return {from.parameter.index, perVertex, std::move(array)};
}

} // namespace

std::optional<BuiltGeometry> buildDraw(const DrawCall& call, const GeometryState& state,
                                       const VertexState& current, uint64_t& degenerate) {
  BuiltGeometry built{.state = state, .primitive = primitiveOf(call.mode)};
  require(call.points.data != nullptr, RT_INVALID_OPERATION,
          "no vertex array: call rtVertexPointer first");
  require(call.vertexCount <= maxVertices && call.count <= maxVertices, RT_INVALID_VALUE,
          "more than 2^31 vertices");
  checkIndices(call);
  if (call.points.type == RT_DOUBLE)
    built.points = widePoints(call, built.state.matrix);
  else
    built.points = attribute(call, call.points, 3, true, nullptr, "a coordinate is not finite");
  built.normals = attribute(call, call.normals, 3, current.present & HasNormal, current.normal,
                            "a normal is not finite");
  built.texCoords = attribute(call, call.texCoords, 2, current.present & HasTexCoord,
                              current.texCoord, "a texture coordinate is not finite");
  built.colors = attribute(call, call.colors, 4, current.present & HasColor, current.color,
                           "a colour is not finite");
  built.fogCoords = attribute(call, call.fogCoords, 1, current.present & HasFogCoord,
                              &current.fogCoord, "a fog coordinate is not finite");
  std::vector<uint32_t> ordinals;
  built.indices = collectIndices(call, built.points->as<float>(), degenerate,
                                 call.parameters.empty() ? nullptr : &ordinals);
  for (const ParameterSource& parameter : call.parameters)
    built.parameters.push_back(varyingValues(call, parameter, ordinals));
  if (built.indices->size() == 0) return std::nullopt;
  return built;
}

} // namespace openrt
