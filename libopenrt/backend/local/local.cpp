// local.cpp: snapshots, frames and statistics of LocalBackend. The cost of a change:
//   parameters, textures, lights, camera    a new snapshot with the same acceleration structure
//   moved dynamic instances, redefined      the acceleration structure is updated in place
//   dynamic objects
//   anything else                           it is rebuilt, reusing the parts that did not change
#include "backend/local/local.h"
#include "backend/local/motions.h"
#include "backend/local/near_lamps.h"
#include "shading/running.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include "render/lights/emitters.h"
#include "render/lights/light_sampler.h"
#include "render/lights/light_sources.h"
#include "render/lights/shadows.h"
#include "render/medium/containing_media.h"
#include "render/medium/medium_lights.h"
#include "render/path/light_path_trial.h"
#include "render/path/photon_pass.h"
#include "render/path/transport.h"
#include "render/wave/nearest_hits.h"
#include "scene/quality.h"
#include "scene/transports.h"
#include "steady_clock.h"
#include "system/memory.h"

namespace openrt {
namespace {

// The edits of so many things, which are freed when they have been applied, take more memory than
// the structures that are made next.
constexpr size_t manyThings = 100'000;

// Returns the number of edits and geometries of a commit.
size_t countThings(const Commit& commit) {
  size_t things = commit.edits.edits.size();
  for (const auto& edit : commit.edits.edits)
    if (const edit::ObjectT* object = edit ? edit->any.AsObject() : nullptr)
      things += object->geometries.size();
  return things;
}

std::string kernelText() { return std::string("Embree ") + RTC_VERSION_STRING; }

} // namespace

LocalBackend::LocalBackend(const BackendOptions& options)
    : options_(options), threads_(options.threads ? options.threads : availableThreads()),
      device_(std::make_shared<EmbreeDevice>(threads_, options.isa)), builder_(device_),
      queries_(device_, threads_, [this] {
        prepareGeometry();
        return PreparedGeometry{scene_, flat_, builder_.survey, *accel_, *snapshot_};
      }) {}

LocalBackend::~LocalBackend() = default;

void LocalBackend::apply(std::shared_ptr<const Commit> commit) {
  const double begin = steadySeconds();
  changes_.add(scene_.apply(*commit, &history_));
  freedMuch_ |= countThings(*commit) > manyThings;
  commitSeconds_ = steadySeconds() - begin;
}

Vec3d LocalBackend::eye() const {
  return scene_.camera.shader && scene_.camera.matrix.usable() ? scene_.camera.matrix.translation()
                                                               : Vec3d{};
}

void LocalBackend::prepareGeometry() {
  // A thing that moved in the last snapshot may rest in this one, and in another view other things
  // moved.
  const bool motionsDiffer =
      snapshot_ && snapshotFrame_ != history_.number() && (snapshot_->motions || history_.any());
  if (snapshot_ && accel_ && !changes_.any() && !motionsDiffer) return;
  if (std::exchange(freedMuch_, false)) os::giveBackMemory();
  auto next = std::make_shared<RenderScene>();
  next->frame = scene_.frame;
  makeShaders(*next);
  try {
    updateAccel(*next);
  } catch (...) { // incomplete: the next call rebuilds it
    queries_.clear();
    accel_ = nullptr;
    throw;
  }
  next->kernel = accel_;
  next->records = accel_->records;
  next->buckets = accel_->buckets;
  next->transparentShadows = accel_->hasTransparent;
  snapshot_ = std::move(next);
  snapshotFrame_ = history_.number();
  changes_ = {};
}

void LocalBackend::prepareLight() {
  prepareGeometry();
  if (ready_ == snapshot_) return;
  RenderScene& next = *snapshot_;
  const RenderScene* const before = lit_.get();
  next.emitters = std::make_shared<Emitters>();
  TransportChoice choice = chooseTransport(next, before);
  next.frame.transport = uint8_t(choice.transport);
  unreachedLights_ = choice.unreached;
  transportLeavesOut_ = choice.leavesOut;
  transportReason_ = std::move(choice.reason);
  next.mediumLights = findMediumLights(next);
  next.absorbingShadows =
      !next.mediumLights.empty() || (next.transparentShadows && hasAbsorption(next));
  next.samplesPass = samplesPass(next);
  if (!showsNoLight(next.frame)) {
    sampleLight(next, before);
    lit_ = snapshot_;
    recordsUnmoved_ = true;
  }
  ready_ = snapshot_;
  guided_ = false;
}

// Makes the tables by which the paths of a frame sample light. before: lit_.
void LocalBackend::sampleLight(RenderScene& next, const RenderScene* before) {
  if (!options_.lightSamples) {
    next.lightSamplers = makeLightSamplers(next, before);
    return;
  }
  next.emitters->build(next, before, recordsUnmoved_);
  if (!warnedOfNearLamp_ && options_.log &&
      next.emitters->shapes() != (before ? before->emitters->shapes() : nullptr)) {
    const std::string warning = warnOfNearLamps(next);
    if (!warning.empty()) options_.log(2, warning.c_str(), options_.logUser);
    warnedOfNearLamp_ = !warning.empty();
  }
  if (!warnedOfAnalyticLamp_ && options_.log && !(before && recordsUnmoved_)) {
    const std::string warning = warnOfAnalyticLamps(next);
    if (!warning.empty()) options_.log(2, warning.c_str(), options_.logUser);
    warnedOfAnalyticLamp_ = !warning.empty();
  }
  next.lightSamplers = makeLightSamplers(next, before);
  // Sensors that light paths do not reach do not have such a transport (transport.cpp).
  if (tracesLamps(next.frame.transport) && next.camera.shader.shaderClass &&
      (next.camera.shader.shaderClass->project || next.frame.measure)) {
    auto sources = std::make_shared<const LightSources>(next, recordsUnmoved_ ? before : nullptr);
    if (!sources->empty()) next.lightSources = std::move(sources);
  }
}

// Brings the acceleration structure up to date with the committed scene, and makes the camera and
// the lights, which depend on its origin.
void LocalBackend::updateAccel(RenderScene& next) {
  const double begin = steadySeconds();
  const SceneChanges& c = changes_;
  bool scoped = false;
  for (const auto& [id, light] : scene_.lights) scoped |= light.scope != 0;
  bool layOut = !accel_ || c.structure || (c.lights && (scoped || scopedLights_)) ||
                (next.shaders != snapshot_->shaders && !next.shaders->extends(*snapshot_->shaders));
  layOut = layOut || !builder_.survey.resurvey(scene_, flat_, c.redefined);
  std::vector<uint32_t> moved;
  if (layOut) {
    flat_ = flatten(scene_, history_.watches());
    builder_.survey.take(scene_, flat_);
    if (flat_.truncated && options_.log)
      options_.log(3,
                   ("too many placed objects: only the first " + std::to_string(maxPlacements) +
                    " are drawn, or " + std::to_string(maxClusters) + " that move")
                       .c_str(),
                   options_.logUser);
  } else {
    if (c.lights) { // no light is or was scoped, so there is a single light set
      flat_.lightSets.clear();
      flat_.setNumbers.clear();
      flat_.lightSet(unscopedLights(scene_));
    }
    moved = updateClusters(scene_, flat_, c.moved);
    builder_.survey.place(flat_, moved);
  }
  scopedLights_ = scoped;

  const Vec3d origin = builder_.survey.origin(eye());
  store(origin, next.origin);
  makeCamera(next, origin);
  const PixelFootprint pixel = footprint(next);
  const double scale = builder_.survey.scale(origin);
  const BuildInput input{
      scene_, flat_, *next.shaders, origin, scale, builder_.survey.reach(origin) * scale, pixel};
  queries_.outdate();
  const bool builds = layOut || !AccelBuilder::hasFrame(*accel_, input);
  recordsUnmoved_ = recordsUnmoved_ && !builds && moved.empty() && c.redefined.empty();
  if (builds)
    accel_ = builder_.build(input);
  else
    builder_.update(*accel_, input, moved, c.redefined, pixel != footprint_);
  if (rtcGetDeviceError(device_->device) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  footprint_ = pixel;
  updateMotions(next, std::move(moved), layOut);
  buildSeconds_ = steadySeconds() - begin;
  makeLights(next, flat_, origin);
}

// Finds out what has moved since the frame before in the same view, for RT_MOTION.
//   moved  clusters that moved since the last prepareGeometry()
//   all    anything may have moved
void LocalBackend::updateMotions(RenderScene& next, std::vector<uint32_t> moved, bool all) {
  if (!history_.watches()) return dropPaths(flat_);
  if (!history_.any()) return;
  if (flat_.paths.empty() && !history_.view().beginning()) addPaths(scene_, flat_);
  // A prepareGeometry() after the frame before, also of another view, has already taken note of
  // changes.
  all |= snapshot_ && snapshotFrame_ > history_.numberBefore();
  for (const uint32_t object : changes_.redefined) {
    const uint32_t part = builder_.survey.partOf(object);
    if (part == ~0u) continue;
    const std::vector<uint32_t>& its = builder_.survey.parts()[part].clusters;
    moved.insert(moved.end(), its.begin(), its.end());
  }
  std::sort(moved.begin(), moved.end());
  moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
  next.motions = makeMotions({scene_, history_.view(), flat_, builder_.survey, *accel_},
                             all ? nullptr : &moved);
}

// Reuses the shaders and textures of the last snapshot if they did not change.
void LocalBackend::makeShaders(RenderScene& next) const {
  fillHost(next.host);
  next.host.logCallback = options_.log;
  next.host.logUser = options_.logUser;
  next.host.diagnose = options_.diagnose;
  const bool kept = snapshot_ && !changes_.shaders && !changes_.textures;
  if (kept && changes_.parameters.empty()) {
    next.textures = snapshot_->textures;
    next.shaders = snapshot_->shaders;
    next.host.textures = next.textures.get();
    return;
  }
  std::map<uint32_t, uint32_t> index;
  std::vector<Texture> textures;
  textures.emplace_back(edit::TextureT(), nullptr); // number 0: no texture, samples as white
  for (const auto& [id, image] : scene_.textures) {
    const auto number = uint32_t(index.size() + 1);
    index[id] = number;
    if (!kept) textures.emplace_back(image.description, image.texels);
  }
  next.textures = kept ? snapshot_->textures
                       : std::make_shared<const std::vector<Texture>>(std::move(textures));
  next.host.textures = next.textures.get();
  next.shaders =
      kept ? std::make_shared<const ShaderTable>(*snapshot_->shaders, changes_.parameters, scene_,
                                                 index, next.host)
           : std::make_shared<const ShaderTable>(scene_, *options_.shaders, index, next.host);
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
  if (scene_.transport) next.transport = next.shaders->role(scene_.transport, RTS_TRANSPORT);
  place(scene_.camera, RTS_CAMERA, next.camera);
  place(scene_.environment, RTS_ENVIRONMENT, next.environment);
  if (!next.camera.shader.shaderClass) return;
  const Vec3d axis = scene_.camera.matrix.column(2) * (-1 / length(scene_.camera.matrix.column(2)));
  next.eye = next.camera.fromLocal.translation();
  next.viewAxis = Vec3f(axis);
  next.depthAxis = next.viewAxis;
  const Vec3d normal = cross(scene_.camera.matrix.column(0), scene_.camera.matrix.column(1));
  const double along = dot(normal, axis) / length(normal);
  constexpr double rounding = 1e-12;
  if (std::abs(along) < 1 - rounding)
    next.depthAxis = Vec3f(normal * ((along < 0 ? -1 : 1) / length(normal)));
}

// Returns the distance between the rays of two neighbouring pixels in the middle of the picture.
// The width of lines and points is given in pixels.
PixelFootprint LocalBackend::footprint(const RenderScene& next) const {
  PixelFootprint result;
  result.eye = next.eye;
  result.axis = next.viewAxis;
  const ShaderSlot& camera = next.camera.shader;
  if (!camera.shaderClass) return result;
  Arena arena;
  float *xy[2], *org[3], *dir[3];
  for (auto* group : {org, dir})
    for (int k = 0; k < 3; k++) group[k] = arena.takeZero<float>(lanes);
  for (auto& a : xy) a = arena.takeZero<float>(lanes);
  const float size[2] = {float(next.frame.width), float(next.frame.height)};
  for (uint32_t i = 0; i < lanes; i++) {
    xy[0][i] = size[0] / 2;
    xy[1][i] = size[1] / 2 + (i == 1 ? 1.0f : 0.0f);
  }
  const float* points[2] = {xy[0], xy[1]};
  RtsRays rays;
  for (int k = 0; k < 3; k++) {
    rays.origin[k] = org[k];
    rays.direction[k] = dir[k];
  }
  RayCounters counters;
  RtsBatch batch({next, arena, counters});
  batch.lanes = {.count = lanes, .cameraRays = true};
  {
    const RunningShader running(*camera.shaderClass);
    camera.shaderClass->generate(&next.host, &batch, camera.params, 2, points, size, &rays);
  }
  // In local space the view axis is -z. Compare the positions of the rays at depths 0 and 1.
  const auto at = [&](int i, int k, float depth) {
    return org[k][i] + dir[k][i] * (depth + org[2][i]) / -dir[2][i];
  };
  result.constant = std::hypot(at(1, 0, 0) - at(0, 0, 0), at(1, 1, 0) - at(0, 1, 0));
  result.slope = std::hypot(at(1, 0, 1) - at(0, 0, 1), at(1, 1, 1) - at(0, 1, 1)) - result.constant;
  if (!std::isfinite(result.constant) || !std::isfinite(result.slope))
    result.constant = result.slope = 0;
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

void LocalBackend::prepareFrame() {
  stop_ = false;
  prepareLight();
  if (guided_) return;
  snapshot_->enclosed = isEnclosed(*snapshot_);
  snapshot_->aroundEye = mediaAroundEye(*snapshot_);
  guided_ = guideByPhotons(*snapshot_, stop_) && tryLightPaths(*snapshot_, stop_);
  if (snapshot_->photonGuide) transportReason_ += ", guided";
  if (const uint32_t paths = snapshot_->lightPathsOfCameraPath; paths > 1)
    transportReason_ += ", x" + std::to_string(paths) + " light";
  if (snapshot_->sharesMirrors) transportReason_ += ", shared";
  if (snapshot_->showsGlossy) transportReason_ += ", glossy";
  if (snapshot_->connectsGlossy) transportReason_ += ", connected";
}

std::shared_ptr<const RenderScene> LocalBackend::prepared() {
  prepareFrame();
  return snapshot_;
}

bool LocalBackend::keepSums(const SumsRequest& request) {
  keep_ = request;
  return true;
}

std::shared_ptr<FrameSums> LocalBackend::sums() const {
  std::shared_ptr<const Frame> frame;
  {
    std::lock_guard lock(mutex_);
    frame = frame_ ? frame_ : finished_;
  }
  return frame ? frame->work().sums() : nullptr;
}

void LocalBackend::start() {
  prepareFrame();
  KeepSums kept;
  kept.keep = keep_.keep && !stop_; // a frame without its photons is not begun
  kept.from = std::exchange(keep_.from, nullptr);
  kept.identity = {keep_.scene.world, keep_.scene.view, versionText(), device_->isa, kernelText()};
  auto frame = std::make_shared<Frame>(snapshot_, threads_, kept);
  std::lock_guard lock(mutex_);
  frame_ = std::move(frame);
  if (stop_) frame_->cancel();
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
    finished_ = std::move(frame);
  }
  finished_->throwFailure();
}

void LocalBackend::cancel() {
  std::lock_guard lock(mutex_);
  stop_ = true;
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

bool LocalBackend::read(RTenum channel, std::span<float> out) const {
  return finished_ && finished_->work().film().read(channel, out);
}

void LocalBackend::stats(RTstats& s) const {
  if (accel_) {
    const AccelBuilder::Counts counts = builder_.count(*accel_, flat_);
    s.scene.triangles = counts.triangles;
    s.scene.uniqueTriangles = counts.uniqueTriangles;
    s.rejected.primitives = counts.degenerate;
    s.rejected.rays = accel_->rejectedRays;
    s.rejected.instances = flat_.rejected + counts.rejectedInstances;
  }
  s.rejected.hits = device_->wrongHits;
  s.time = {commitSeconds_, buildSeconds_, finished_ ? finished_->seconds() : 0};
  if (finished_) finished_->work().describe(s);
  s.bvh = {uint64_t(std::max<int64_t>(device_->bytes, 0)), builder_.objectBuilds,
           builder_.topLevelBuilds};
  s.machine.threads = threads_;
  std::snprintf(s.machine.isa, sizeof s.machine.isa, "%s", device_->isa.c_str());
  std::snprintf(s.machine.kernel, sizeof s.machine.kernel, "%s", kernelText().c_str());
  if (ready_) s.transport.chosen = ready_->frame.transport;
  s.transport.unreachedLights = unreachedLights_;
  s.transport.leavesOut = transportLeavesOut_;
  std::snprintf(s.transport.reason, sizeof s.transport.reason, "%s", transportReason_.c_str());
}

std::unique_ptr<Backend> makeLocalBackend(const BackendOptions& options) {
  return std::make_unique<LocalBackend>(options);
}

} // namespace openrt
