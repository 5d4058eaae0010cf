// local.cpp: see local.h. What a change costs: parameters, textures, lights and the camera make a new snapshot over the same
// acceleration structure; geometry and instances build it anew.
#include "backend/local/local.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace openrt {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void merge(SceneChanges& all, const SceneChanges& more) {
  all.geometry |= more.geometry, all.instances |= more.instances, all.shaders |= more.shaders, all.textures |= more.textures;
  all.lights |= more.lights, all.camera |= more.camera, all.frame |= more.frame;
}

bool different(const PixelFootprint& a, const PixelFootprint& b) {
  if (a.constant != b.constant || a.slope != b.slope) return true;
  for (int k = 0; k < 3; k++)
    if (a.eye[k] != b.eye[k] || a.axis[k] != b.axis[k]) return true;
  return false;
}

} // namespace

LocalBackend::LocalBackend(const BackendOptions& options)
    : options_(options), threads_(options.threads ? options.threads : availableThreads()),
      device_(std::make_shared<EmbreeDevice>(threads_)) {
  changes_.geometry = true;
}

LocalBackend::~LocalBackend() = default;

void LocalBackend::apply(std::shared_ptr<const Commit> commit) {
  const double begin = now();
  merge(changes_, scene_.apply(*commit));
  commitSeconds_ = now() - begin;
}

// The camera's place, unless it is still near the old origin in terms of the scene's size: then nothing need be rounded anew.
Vec3d LocalBackend::chooseOrigin() const {
  const Vec3d eye = scene_.camera.shader && scene_.camera.matrix.usable() ? scene_.camera.matrix.translation() : Vec3d{};
  if (!snapshot_ || !accel_ || changes_.geometry || changes_.instances) return eye; // built anew in any case
  const Vec3d old{snapshot_->origin[0], snapshot_->origin[1], snapshot_->origin[2]};
  return length(eye - old) <= accel_->radius ? old : eye;
}

void LocalBackend::prepare() {
  const SceneChanges& c = changes_;
  if (snapshot_ && !(c.geometry || c.instances || c.shaders || c.textures || c.lights || c.camera || c.frame)) return;
  const double begin = now();
  auto next = std::make_shared<RenderScene>();
  next->frame = scene_.frame;
  makeShaders(*next);
  const Vec3d origin = chooseOrigin();
  next->origin[0] = origin.x, next->origin[1] = origin.y, next->origin[2] = origin.z;
  makeCamera(*next, origin);
  const PixelFootprint pixel = footprint(*next);

  bool scoped = false;
  for (const auto& [id, light] : scene_.lights) scoped |= light.scope != 0;
  const bool moved = snapshot_ && std::memcmp(snapshot_->origin, next->origin, sizeof next->origin) != 0;
  const bool rebuild = !accel_ || c.geometry || c.instances || moved || (c.lights && (scoped || scopedLights_)) ||
                       (c.shaders && !next->shaders->sameLayout(*snapshot_->shaders)) ||
                       (accel_->hasThin && different(pixel, footprint_));
  if (rebuild) {
    flat_ = flatten(scene_);
    if (flat_.truncated && options_.log)
      options_.log(3, ("too many placed objects: only the first " + std::to_string(maxPlacements) + " are drawn").c_str(),
                   options_.logUser);
    accel_ = std::make_shared<Accel>(device_, scene_, flat_, *next->shaders, origin, pixel);
    if (const RTCError error = rtcGetDeviceError(device_->device); error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    flat_.placements = {}; // only the light sets are needed again
    footprint_ = pixel;
    scopedLights_ = scoped;
    buildSeconds_ = now() - begin;
    objectBuilds_ += accel_->builds();
    topLevelBuilds_++;
  } else if (c.lights) {
    flat_.lightSets = {unscopedLights(scene_)}; // no light is scoped, nor was: there is but this set
  }
  next->kernel = accel_;
  next->records = accel_->records;
  next->buckets = accel_->buckets;
  next->transparentShadows = accel_->hasTransparent;
  makeLights(*next, flat_, origin);
  snapshot_ = std::move(next);
  changes_ = {};
}

void LocalBackend::makeShaders(RenderScene& next) {
  fillHost(next.host);
  next.host.textures = &next.textures;
  next.host.logCallback = options_.log;
  next.host.logUser = options_.logUser;
  std::map<uint32_t, uint32_t> index;
  next.textures.emplace_back(edit::TextureT(), nullptr); // number 0: none, white
  for (const auto& [id, image] : scene_.textures) {
    index[id] = uint32_t(next.textures.size());
    next.textures.emplace_back(image.description, image.texels);
  }
  next.shaders = std::make_unique<ShaderTable>(scene_, *options_.shaders, index, next.host);
}

void LocalBackend::makeCamera(RenderScene& next, const Vec3d& origin) const {
  const auto place = [&](const Role& role, RtsKind kind, RoleSlot& slot) {
    if (!role.shader || !role.matrix.usable()) return;
    slot.shader = next.shaders->role(role.shader, kind);
    Matrix4d m = role.matrix;
    m.translate(origin * -1.0);
    slot.fromLocal = Affine::from(m);
    slot.toLocal = Affine::from(inverse(m));
  };
  place(scene_.camera, RTS_CAMERA, next.camera);
  place(scene_.environment, RTS_ENVIRONMENT, next.environment);
  if (!next.camera.shader.shaderClass) return;
  const Vec3d axis = scene_.camera.matrix.column(2) * (-1 / length(scene_.camera.matrix.column(2)));
  const double a[3] = {axis.x, axis.y, axis.z};
  for (int k = 0; k < 3; k++) next.eye[k] = next.camera.fromLocal.r[k][3], next.viewAxis[k] = float(a[k]);
}

// How far apart two neighbouring pixels' rays are in the middle of the picture: lines and points are pixels wide.
PixelFootprint LocalBackend::footprint(const RenderScene& next) const {
  PixelFootprint result;
  for (int k = 0; k < 3; k++) result.eye[k] = next.eye[k], result.axis[k] = next.viewAxis[k];
  const ShaderSlot& camera = next.camera.shader;
  if (!camera.shaderClass) return result;
  Arena arena;
  float *xy[2], *org[3], *dir[3];
  for (auto* group : {org, dir})
    for (int k = 0; k < 3; k++) group[k] = arena.takeZero<float>(lanes);
  for (auto& a : xy) a = arena.takeZero<float>(lanes);
  const float size[2] = {float(next.frame.width), float(next.frame.height)};
  for (uint32_t i = 0; i < lanes; i++) xy[0][i] = size[0] / 2, xy[1][i] = size[1] / 2 + (i == 1 ? 1.0f : 0.0f);
  const float* points[2] = {xy[0], xy[1]};
  RtsRays rays;
  for (int k = 0; k < 3; k++) rays.origin[k] = org[k], rays.direction[k] = dir[k];
  RtsBatch batch;
  RayCounters counters;
  batch.scene = &next, batch.arena = &arena, batch.counters = &counters;
  camera.shaderClass->generate(&next.host, &batch, camera.params, 2, points, size, &rays);
  // In local space the view axis is -z: compare where the rays are at depth 0 and at depth 1.
  const auto at = [&](int i, int k, float depth) { return org[k][i] + dir[k][i] * (depth + org[2][i]) / -dir[2][i]; };
  result.constant = std::hypot(at(1, 0, 0) - at(0, 0, 0), at(1, 1, 0) - at(0, 1, 0));
  result.slope = std::hypot(at(1, 0, 1) - at(0, 0, 1), at(1, 1, 1) - at(0, 1, 1)) - result.constant;
  if (!std::isfinite(result.constant) || !std::isfinite(result.slope)) result.constant = result.slope = 0;
  return result;
}

void LocalBackend::makeLights(RenderScene& next, const Flattened& flat, const Vec3d& origin) const {
  std::map<uint32_t, uint32_t> index;
  for (const auto& [id, light] : scene_.lights) {
    const ShaderSlot shader = next.shaders->role(light.shader, RTS_LIGHT);
    if (!shader.shaderClass || !light.matrix.usable()) continue;
    Matrix4d m = light.matrix;
    m.translate(origin * -1.0);
    index[id] = uint32_t(next.lights.size());
    next.lights.push_back({shader, Affine::from(inverse(m)), Affine::from(m)});
  }
  for (const auto& ids : flat.lightSets) {
    auto& set = next.lightSets.emplace_back();
    for (uint32_t id : ids)
      if (const auto found = index.find(id); found != index.end()) set.push_back(found->second);
  }
}

void LocalBackend::start() {
  prepare();
  auto frame = std::make_shared<Frame>(snapshot_, threads_);
  std::lock_guard lock(mutex_);
  frame_ = std::move(frame);
}

void LocalBackend::wait() {
  std::shared_ptr<Frame> frame;
  {
    std::lock_guard lock(mutex_);
    frame = frame_;
  }
  if (!frame) return;
  frame->wait();
  {
    std::lock_guard lock(mutex_);
    frame_ = nullptr;
  }
  finished_ = std::move(frame);
  if (!finished_->failure().empty()) throw std::runtime_error("rendering failed: " + finished_->failure());
}

void LocalBackend::cancel() {
  std::lock_guard lock(mutex_);
  if (frame_) frame_->cancel();
}

float LocalBackend::progress() const {
  std::lock_guard lock(mutex_);
  return frame_ ? frame_->progress() : 1.0f;
}

bool LocalBackend::snapshot(RTenum channel, std::span<float> out) const {
  std::shared_ptr<const Frame> frame;
  {
    std::lock_guard lock(mutex_);
    frame = frame_;
  }
  return frame && frame->snapshot(channel, out);
}

bool LocalBackend::read(RTenum channel, std::span<float> out) const { return finished_ && finished_->film().read(channel, out); }

void LocalBackend::stats(RTstats& s) const {
  if (accel_) {
    s.triangles = accel_->triangles, s.uniqueTriangles = accel_->uniqueTriangles;
    s.degenerate += accel_->degenerate;
    s.rejectedRays = accel_->rejectedRays;
    s.rejectedInstances = flat_.rejected;
  }
  if (finished_) {
    s.cameraRays = finished_->counters().camera, s.shadowRays = finished_->counters().shadow;
    s.secondaryRays = finished_->counters().secondary;
    s.renderSeconds = finished_->seconds();
  }
  s.objectBuilds = objectBuilds_, s.topLevelBuilds = topLevelBuilds_;
  s.commitSeconds = commitSeconds_;
  s.buildSeconds = buildSeconds_;
  s.bvhBytes = uint64_t(std::max<int64_t>(device_->bytes, 0));
  s.threads = threads_;
  std::snprintf(s.isa, sizeof s.isa, "%s", device_->wide ? "avx512" : __builtin_cpu_supports("avx2") ? "avx2" : "sse");
  std::snprintf(s.kernel, sizeof s.kernel, "Embree %s", RTC_VERSION_STRING);
}

std::unique_ptr<Backend> makeLocalBackend(const BackendOptions& options) { return std::make_unique<LocalBackend>(options); }

} // namespace openrt
