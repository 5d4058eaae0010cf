// candidates.cpp: boxes as an Embree user geometry, and their traversal (candidates.h).
#include "backend/local/accel/candidates.h"

#include <cmath>
#include <limits>
#include <new>

#include "backend/local/user_geometry.h"

namespace openrt {
namespace {

// Boxes are padded by this much. The ray enters the frame's ball of radius 2 at a point rounded to
// float, with a direction rounded to float, and is at most 4 long in it: it errs by less than
// 2^-21. Embree's robust traversal allows for its own rounding.
constexpr double padding = 0x1p-19;

struct Traversal {
  CandidateVisitor* visitor;
  double enter, perLength; // t of the float ray's origin, and t for each unit of its length
};

void boundsOf(const RTCBoundsFunctionArguments* a) {
  const auto& boxOf = **static_cast<const CandidateScene::BoxOf* const*>(a->geometryUserPtr);
  const Span box = boxOf(a->primID);
  const Vec3d pad{padding, padding, padding};
  storeBounds(Vec3f(box.low - pad), Vec3f(box.high + pad), *a->bounds_o);
}

// Shortens the float ray to what still interests the visitor.
void intersect(const RTCIntersectFunctionNArguments* a) {
  const Traversal& self =
      *static_cast<const Traversal*>(static_cast<const QueryContext*>(a->context)->user);
  RTCRayN* ray = RTCRayHitN_RayN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; i++) {
    if (a->valid[i] != -1) continue;
    const double far = (self.visitor->visit(a->primID) - self.enter) / self.perLength;
    float& end = RTCRayN_tfar(ray, a->N, i);
    end = std::min(end, float(far + 2 * padding));
  }
}

} // namespace

bool clipToBall(const FrameRay& ray, double& enter, double& leave) {
  const double square = dot(ray.direction, ray.direction),
               middle = -dot(ray.origin, ray.direction) / square;
  const Vec3d closest = ray.origin + ray.direction * middle;
  const double half = 2 / std::sqrt(square);
  enter = std::max(ray.near, middle - half);
  leave = std::min(ray.far, middle + half);
  return dot(closest, closest) <= 4 && enter <= leave;
}

CandidateScene::CandidateScene(const EmbreeDevice& device, uint32_t count, const BoxOf& boxOf) {
  scene_ = rtcNewScene(device.device);
  RTCGeometry geometry = scene_ ? rtcNewGeometry(device.device, RTC_GEOMETRY_TYPE_USER) : nullptr;
  if (!geometry) {
    if (scene_) rtcReleaseScene(scene_);
    throw std::bad_alloc();
  }
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  const BoxOf* source = &boxOf;
  rtcSetGeometryUserPrimitiveCount(geometry, count);
  rtcSetGeometryUserData(geometry, &source);
  rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  try {
    device.commit(scene_);
  } catch (...) {
    rtcReleaseScene(scene_);
    throw;
  }
}

void CandidateScene::visit(const FrameRay& ray, CandidateVisitor& visitor) const {
  double enter, leave;
  if (!clipToBall(ray, enter, leave)) return;
  const double size = length(ray.direction);
  const Vec3f from(ray.origin + ray.direction * enter), d(ray.direction / size);
  Traversal self{&visitor, enter, 1 / size};
  Query query({.user = &self});
  RTCRayHit hit{};
  hit.ray.org_x = from.x;
  hit.ray.org_y = from.y;
  hit.ray.org_z = from.z;
  hit.ray.dir_x = d.x;
  hit.ray.dir_y = d.y;
  hit.ray.dir_z = d.z;
  hit.ray.tfar = float((leave - enter) * size + 2 * padding);
  hit.ray.mask = ~0u;
  hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect1(scene_, hit, query);
}

namespace {

struct NearSearch {
  CandidateVisitor* visitor;
  float slack; // what the point and the distance round by
};

float radiusOf(double distance, float slack) {
  return float(std::min(distance * (1 + 0x1p-20), 1e30)) + slack;
}

bool visitPrimitive(RTCPointQueryFunctionArguments* a) {
  const NearSearch& search = *static_cast<const NearSearch*>(a->userPtr);
  const float radius = radiusOf(search.visitor->visit(a->primID), search.slack);
  if (!(radius < a->query->radius)) return false;
  a->query->radius = radius;
  return true;
}

} // namespace

void CandidateScene::visitNear(const Vec3d& point, double distance,
                               CandidateVisitor& visitor) const {
  const Vec3f p(point);
  NearSearch search{&visitor, 0x1p-20f * (1 + largest(abs(p)))};
  RTCPointQuery query{p.x, p.y, p.z, 0, radiusOf(distance, search.slack)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_, &query, &context, visitPrimitive, &search);
}

double unitOf(double length) {
  return length > 0 && std::isfinite(length) ? std::exp2(-std::ilogb(length) - 1) : 1;
}

} // namespace openrt
