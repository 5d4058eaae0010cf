// embree_parts.cpp: attaches geometries and instances to Embree scenes. Called between frames.
#include "backend/local/accel/blas.h"
#include "render/rays.h"

#include <algorithm>
#include <cmath>
#include <new>

namespace openrt {
namespace {

void attach(PartScene& to, RTCGeometry geometry, PartSlot content, uint32_t mask,
            uint32_t slot = nextSlot) {
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  if (slot == nextSlot) {
    slot = uint32_t(to.parts.size());
    to.parts.emplace_back();
  }
  detach(to, slot);
  rtcAttachGeometryByID(to.scene, geometry, slot);
  rtcReleaseGeometry(geometry);
  to.parts[slot] = std::move(content);
}

void transform(RTCGeometry geometry, const Matrix4d& matrix) {
  float m[12];
  for (int column = 0; column < 4; column++)
    for (int row = 0; row < 3; row++) m[3 * column + row] = float(matrix.m[4 * column + row]);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
}

// Returns the largest sum of the magnitudes of a row of the inverse.
double inverseNorm(const Matrix4d& matrix) {
  const Matrix4d toLocal = inverse(matrix);
  double most = 0;
  for (int i = 0; i < 3; i++) most = std::max(most, dot(abs(toLocal.row(i)), Vec3d{1, 1, 1}));
  return most;
}

} // namespace

int8_t enlargementOf(const Matrix4d& matrix) {
  const double norm = inverseNorm(matrix);
  if (!(norm < 0x1p127)) return 127;
  return norm > 1 ? int8_t(std::ceil(std::log2(norm))) : int8_t(0);
}

// Embree inverts the matrix in single precision, so the determinant must be a normal number and
// larger than its rounding error. Without that the inverse is not finite.
bool isTraceable(const Matrix4d& matrix, double reach) {
  if (!matrix.usable()) return false;
  const double volume = std::fabs(matrix.determinant()),
               box = length(matrix.column(0)) * length(matrix.column(1)) * length(matrix.column(2));
  return volume >= 1e-6 * box && volume >= 1e-37 && volume <= 1e37 &&
         inverseNorm(matrix) * std::max(reach, largest(abs(matrix.translation()))) <= 1e16;
}

RTCScene newScene(const EmbreeDevice& device) {
  RTCScene scene = rtcNewScene(device.device);
  if (!scene) throw std::bad_alloc();
  rtcSetSceneFlags(scene, sceneFlags);
  return scene;
}

void setCompact(RTCScene scene) {
  rtcSetSceneFlags(scene, RTCSceneFlags(rtcGetSceneFlags(scene) | RTC_SCENE_FLAG_COMPACT));
}

// The low quality is that of the tree over the trees of the geometries, of which there is one.
void setDeforming(RTCScene scene) {
  rtcSetSceneFlags(scene, RTCSceneFlags(rtcGetSceneFlags(scene) | RTC_SCENE_FLAG_DYNAMIC));
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
}

void attachTriangles(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                     uint32_t mask, bool slivers, bool refitted) {
  if (slivers) {
    RTCGeometry geometry = newSlivers(device, *part);
    attach(to, geometry, {std::move(part)}, mask);
    return;
  }
  RTCGeometry geometry = rtcNewGeometry(device.device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const size_t points = part->vertices.size() / 3;
  part->vertices.resize(part->vertices.size() + 4); // padding: the kernels read past the end
  part->indices.reserve(part->indices.size() + 4);
  // Merged parts have grown by doubling.
  if (part->vertices.capacity() > part->vertices.size() + part->vertices.size() / 8)
    part->vertices.shrink_to_fit();
  const size_t corners =
      part->sharedIndices ? part->sharedIndices->count<uint32_t>() : part->indices.size();
  const uint32_t* indices =
      part->sharedIndices ? part->sharedIndices->as<uint32_t>() : part->indices.data();
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             part->vertices.data(), 0, 12, points);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices, 0, 12,
                             corners / 3);
  if (refitted) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
  attach(to, geometry, {std::move(part)}, mask);
}

void setVertices(PartScene& in, uint32_t slot, std::vector<float> vertices) {
  const size_t points = vertices.size() / 3;
  vertices.resize(vertices.size() + 4); // padding: the kernels read past the end
  RTCGeometry geometry = rtcGetGeometry(in.scene, slot);
  in.parts[slot].part->vertices = std::move(vertices);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             in.parts[slot].part->vertices.data(), 0, 12, points);
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry);
}

void attachHugeSpheres(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                       uint32_t mask) {
  RTCGeometry geometry = newHugeSpheres(device, *part);
  attach(to, geometry, {std::move(part)}, mask);
}

void attachAnalytic(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                    uint32_t mask) {
  RTCGeometry geometry = newAnalytic(device, *part);
  attach(to, geometry, {std::move(part)}, mask);
}

void attachRound(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                 uint32_t mask, RTCGeometryType type, uint32_t slot) {
  RTCGeometry geometry = rtcNewGeometry(device.device, type);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                             part->vertices.data(), 0, 16, part->vertices.size() / 4);
  if (type == RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE)
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                               part->indices.data(), 0, 4, part->indices.size());
  if (!part->joints.empty())
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_FLAGS, 0, RTC_FORMAT_UCHAR,
                               part->joints.data(), 0, 1, part->joints.size());
  attach(to, geometry, {std::move(part)}, mask, slot);
}

void attachInstance(PartScene& to, const EmbreeDevice& device, std::shared_ptr<const Blas> object,
                    uint32_t record, const Matrix4d& matrix, uint32_t slot) {
  RTCGeometry geometry = rtcNewGeometry(device.device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, object->scene);
  transform(geometry, matrix);
  attach(to, geometry, {nullptr, std::move(object), record, true, enlargementOf(matrix)}, maskAll,
         slot);
}

void detach(PartScene& from, uint32_t slot) {
  if (!from.parts[slot].used()) return;
  rtcDetachGeometry(from.scene, slot);
  from.parts[slot] = {};
}

void setTransform(PartScene& in, uint32_t slot, const Matrix4d& matrix) {
  RTCGeometry geometry = rtcGetGeometry(in.scene, slot);
  transform(geometry, matrix);
  rtcCommitGeometry(geometry);
  in.parts[slot].enlargement = enlargementOf(matrix);
}

Matrix4d transformOf(const PartScene& in, uint32_t slot) {
  float m[12];
  rtcGetGeometryTransform(rtcGetGeometry(in.scene, slot), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
  Matrix4d matrix;
  for (size_t column = 0; column < 4; column++)
    for (size_t row = 0; row < 3; row++) matrix.m[4 * column + row] = double(m[3 * column + row]);
  return matrix;
}

void setEnabled(PartScene& in, uint32_t slot, bool enabled) {
  RTCGeometry geometry = rtcGetGeometry(in.scene, slot);
  in.parts[slot].enabled = enabled;
  if (enabled)
    rtcEnableGeometry(geometry);
  else
    rtcDisableGeometry(geometry);
}

} // namespace openrt
