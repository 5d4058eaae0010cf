// local.cpp: light, frames and statistics of LocalBackend.
#include "backend/local/local.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "backend/local/near_lamps.h"
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

namespace openrt {
namespace {

std::string kernelText() { return std::string("Embree ") + RTC_VERSION_STRING; }

} // namespace

LocalBackend::LocalBackend(const BackendOptions& options)
    : options_(options), threads_(options.threads ? options.threads : availableThreads()),
      device_(std::make_shared<EmbreeDevice>(threads_, options.isa)),
      queries_(device_, threads_,
               [this] {
                 snapshots_.prepare();
                 return snapshots_.geometry();
               }),
      snapshots_(options, device_, queries_) {}

LocalBackend::~LocalBackend() = default;

void LocalBackend::apply(std::shared_ptr<const Commit> commit) {
  snapshots_.apply(std::move(commit));
}

void LocalBackend::setPatience(double seconds) { snapshots_.setPatience(seconds); }

void LocalBackend::prepareLight() {
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
    snapshots_.noteRecords();
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
  next.emitters->build(next, before, snapshots_.recordsRest());
  if (!warnedOfNearLamp_ && options_.log &&
      next.emitters->shapes() != (before ? before->emitters->shapes() : nullptr)) {
    const std::string warning = warnOfNearLamps(next);
    if (!warning.empty()) options_.log(2, warning.c_str(), options_.logUser);
    warnedOfNearLamp_ = !warning.empty();
  }
  if (!warnedOfAnalyticLamp_ && options_.log && !(before && snapshots_.recordsRest())) {
    const std::string warning = warnOfAnalyticLamps(next);
    if (!warning.empty()) options_.log(2, warning.c_str(), options_.logUser);
    warnedOfAnalyticLamp_ = !warning.empty();
  }
  next.lightSamplers = makeLightSamplers(next, before);
  // Sensors that light paths do not reach do not have such a transport (transport.cpp).
  if (tracesLamps(next.frame.transport) && next.camera.shader.shaderClass &&
      (next.camera.shader.shaderClass->project || next.frame.measure)) {
    auto sources =
        std::make_shared<const LightSources>(next, snapshots_.recordsRest() ? before : nullptr);
    if (!sources->empty()) next.lightSources = std::move(sources);
  }
}

void LocalBackend::prepareFrame() {
  snapshot_ = snapshots_.current();
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
  stop_ = false;
  snapshots_.prepare();
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
  stop_ = false;
  if (keep_.keep)
    snapshots_.prepare();
  else
    snapshots_.prepareInTime();
  prepareFrame();
  snapshots_.noteFrame();
  isOutdated_ = snapshots_.isBehind();
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
  wasOutdated_ = isOutdated_;
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
  snapshots_.describe(s);
  s.rejected.hits = device_->wrongHits;
  s.time.render = finished_ ? finished_->seconds() : 0;
  if (finished_) finished_->work().describe(s);
  s.outdated = wasOutdated_;
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
